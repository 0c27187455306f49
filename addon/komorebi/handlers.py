"""Functions that Blender calls at an event (`bpy.app.handlers`), by the event's name."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import bpy

Handlers = Iterable[tuple[str, Callable[..., Any]]]


def add(pairs: Handlers) -> None:
    for name, function in pairs:
        getattr(bpy.app.handlers, name).append(function)


def remove(pairs: Handlers) -> None:
    """Takes them out again, where a file that was loaded has not done so."""
    for name, function in pairs:
        waiting = getattr(bpy.app.handlers, name)
        if function in waiting:
            waiting.remove(function)
