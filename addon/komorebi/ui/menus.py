"""Entries of Blender's menus and headers that it shows for its own engines alone."""

from __future__ import annotations

from typing import Any

import bpy

from . import node_menu
from .base import ENGINE_ID
from .sampling import draw_method
from .viewport import draw_pause


def draw_indirect_only(self: Any, context: Any) -> None:
    """The outliner's menu of a collection, where Blender asks for Cycles."""
    if context.engine == ENGINE_ID:
        self.layout.operator("outliner.collection_indirect_only_set")
        self.layout.operator("outliner.collection_indirect_only_clear")


ADDITIONS = (
    ("RENDER_PT_context", draw_method),
    ("VIEW3D_HT_header", draw_pause),
    ("OUTLINER_MT_collection_view_layer", draw_indirect_only),
)


def register() -> None:
    for name, draw in ADDITIONS:
        getattr(bpy.types, name).append(draw)
    node_menu.register()


def unregister() -> None:
    node_menu.unregister()
    for name, draw in ADDITIONS:
        getattr(bpy.types, name).remove(draw)
