# mypy: disable-error-code="misc"
"""Material properties; Blender's own panel above these holds the slots."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel, draw_surface


class MaterialPanel(KomorebiPanel):
    bl_context = "material"

    @classmethod
    def poll(cls, context: Any) -> bool:
        material = context.material
        return super().poll(context) and material is not None and not material.grease_pencil


class KOMOREBI_MATERIAL_PT_preview(MaterialPanel, bpy.types.Panel):
    bl_label = "Preview"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        self.layout.template_preview(context.material)


class KOMOREBI_MATERIAL_PT_surface(MaterialPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context: Any) -> None:
        draw_surface(self.layout, context.material, "diffuse_color")


class KOMOREBI_MATERIAL_PT_settings(MaterialPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.material, "pass_index")
        column.prop(context.material.komorebi, "exclude_from_clay")


CLASSES = (
    KOMOREBI_MATERIAL_PT_preview,
    KOMOREBI_MATERIAL_PT_surface,
    KOMOREBI_MATERIAL_PT_settings,
)
