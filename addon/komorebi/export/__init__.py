"""Blender's scene → plain arrays (`scene_data.py`). The only part that reads bpy data."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ..passes import value_columns
from ..scene_data import SceneData
from ..unchanged import Unchanged
from .aovs import warn_world
from .camera import export_camera
from .instance import export_instances
from .unsupported import warn_unsupported
from .wanted import Wanted
from .world import export_world


def export_scene(
    engine: Any, depsgraph: Any, view: str, sources: Collection[str] = (),
    unchanged: Unchanged | None = None,
) -> SceneData:  # fmt: skip
    """Everything that the view layer of `depsgraph` shows at its frame, seen by stereo `view`.

    `sources` are the core's passes that are kept, which decide what they need to know; `unchanged`
    knows what an earlier frame has exported.
    """
    scene = depsgraph.scene
    warn_unsupported(engine, depsgraph)
    # A view layer without its sky has no world at all, neither seen nor as a light.
    world = scene.world if depsgraph.view_layer.use_sky else None
    warn_world(engine, world, value_columns(depsgraph.view_layer))
    data = SceneData(
        camera=export_camera(engine, depsgraph, view), world=export_world(engine, world)
    )
    export_instances(engine, depsgraph, data, Wanted.by(sources), unchanged or Unchanged())
    return data
