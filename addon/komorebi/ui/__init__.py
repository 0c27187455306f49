"""What Blender's editors show while Komorebi is chosen: a file for each tab of the properties.

docs/panels.md tells for each of Cycles' panels what stands in its place.
"""

from __future__ import annotations

import bpy

from . import (
    adopted,
    camera,
    light,
    light_paths,
    material,
    menus,
    object,
    render,
    sampling,
    view_layer,
    viewport,
    world,
)
from .base import ENGINE_ID

CLASSES = tuple(
    cls
    for module in (
        sampling,
        light_paths,
        render,
        viewport,
        view_layer,
        camera,
        light,
        object,
        world,
        material,
    )
    for cls in module.CLASSES
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    menus.register()
    adopted.register(ENGINE_ID)


def unregister() -> None:
    adopted.unregister(ENGINE_ID)
    menus.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
