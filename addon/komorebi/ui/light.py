# mypy: disable-error-code="misc"
"""Light properties: what lamps are, and that they give no light yet."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel

SIZES = {"POINT": ("shadow_soft_size", "Radius"), "SPOT": ("shadow_soft_size", "Radius"),
         "SUN": ("angle", "Angle")}  # fmt: skip


class KOMOREBI_LIGHT_PT_light(KomorebiPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: Any) -> None:
        light = context.light
        self.layout.label(text="Light comes from the world alone: lamps give none", icon="INFO")
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        if light.type == "AREA":
            column.prop(light, "shape")
            sub = column.column(align=True)
            sub.prop(light, "size")
            if light.shape in {"RECTANGLE", "ELLIPSE"}:
                sub.prop(light, "size_y")
            return
        name, label = SIZES[light.type]
        column.prop(light, name, text=label)
        if light.type == "SPOT":
            column.prop(light, "spot_size")
            column.prop(light, "spot_blend")


CLASSES = (KOMOREBI_LIGHT_PT_light,)
