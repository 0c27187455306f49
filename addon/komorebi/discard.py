"""Deletes the pictures that Blender wrote of a frame that failed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy

from . import compat

_since: float | None = None


def pictures_since(moment: float) -> None:
    """From now on until the frame ends, what was written after `moment` (s) is to be deleted."""
    global _since
    _since = moment if _since is None else min(_since, moment)


def after_write(scene: Any) -> None:
    """Called when Blender has written the frame's pictures."""
    global _since
    if _since is None:
        return
    for path in _candidates(scene):
        try:
            # File times are coarser than the clock: allow them a tick.
            if path.is_file() and path.stat().st_mtime >= _since - 0.1:
                path.unlink()
                print(f"Komorebi: deleted {path}, a picture of a frame that failed", flush=True)
        except OSError as error:
            print(f"Komorebi: {path} is of a failed frame and cannot be deleted: {error}")
    _since = None


def _candidates(scene: Any) -> Iterator[Path]:
    render = scene.render
    yield Path(render.frame_path(frame=scene.frame_current))
    still = bpy.path.abspath(render.filepath)
    yield Path(still)
    yield Path(still + render.file_extension)
    tree = compat.compositor_nodes(scene)
    for node in tree.nodes if tree is not None else ():
        if node.type == "OUTPUT_FILE":
            yield from _file_output(node, scene.frame_current)


def _file_output(node: Any, frame: int) -> Iterator[Path]:
    if hasattr(node, "file_output_items"):  # from 5.0, where a name need not tell the frame
        folder, start = bpy.path.abspath(node.directory), node.file_name.split("#")[0]
        layers = node.format.media_type == "MULTI_LAYER_IMAGE"
        ends = ["*.exr"] if layers else [f"*{item.name}*.*" for item in node.file_output_items]
        for end in ends:
            yield from Path(folder).glob(start + end)
        return
    folder = bpy.path.abspath(node.base_path)
    if node.format.file_format == "OPEN_EXR_MULTILAYER":
        folder, name = os.path.split(folder)
        names = [name]
    else:
        names = [slot.path for slot in node.file_slots]
    for name in names:
        yield from Path(folder).glob(f"{name.rstrip('#')}*{frame}.*")
