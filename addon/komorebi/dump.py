"""Writes a frame as a file that the command line `komorebi` renders without Blender."""

from __future__ import annotations

import os
from typing import Any

VARIABLE = "KOMOREBI_DUMP"

_path: str | None = None  # set by the operator, for the next render alone


def request(path: str) -> None:
    """The next frame is written to `path` and not rendered."""
    global _path
    _path = path


def is_wanted() -> bool:
    """Whether the next frame is to be written, for which the core keeps what it was given."""
    return _path is not None or bool(os.environ.get(VARIABLE))


def write(scene: Any, settings: Any) -> bool:
    """Dumps if that was asked for; True when the operator did, which wants no picture.

    The environment variable KOMOREBI_DUMP=PATH asks for it too, and the render goes on.
    """
    global _path
    path, _path = _path, None
    if path is not None:
        scene.dump(path, settings)
        return True
    path = os.environ.get(VARIABLE)
    if path:
        scene.dump(path, settings)
        print(f"Komorebi: the scene is in {path}", flush=True)
    return False


def withdraw() -> bool:
    """Forgets a request; True when it had not been met."""
    global _path
    waiting, _path = _path is not None, None
    return waiting
