"""Komorebi: ambient occlusion and sky light, traced by its own C++ core.

Where to read on: `engine.py` is what Blender calls, `driver.py` renders a frame,
`export/` turns Blender's scene into plain arrays and `native_scene.py` hands them to the core.
"""

from __future__ import annotations

import atexit

import bpy

from . import engine, jobs, keeping, operators, preferences, properties, ui

bl_info = {
    "name": "Komorebi",
    "author": "Komorebi contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render Properties > Render Engine > Komorebi",
    "description": "Ambient occlusion and sky light by a fast, exact ray tracer",
    "category": "Render",
}

_MODULES = (preferences, properties, engine, operators, ui, jobs, keeping)
_registered = False


def register() -> None:
    """Makes the engine available; calling it again changes nothing."""
    global _registered
    if _registered:
        return
    for module in _MODULES:
        module.register()
    _registered = True
    if bpy.app.background:
        # A `bpy` process in which a RenderEngine class stays registered hangs at its end.
        atexit.register(unregister)


def unregister() -> None:
    """Takes everything out of Blender again; calling it again changes nothing."""
    global _registered
    if not _registered:
        return
    _registered = False
    atexit.unregister(unregister)
    for module in reversed(_MODULES):
        module.unregister()
