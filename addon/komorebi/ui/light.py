# mypy: disable-error-code="misc"
"""Light properties: what of a lamp counts under World Light."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel, cycles, draw_moved, owner_of

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
        if context.scene.komorebi.method == "AMBIENT_OCCLUSION":
            self.layout.label(text="Ambient occlusion has no lamps, World Light has", icon="INFO")
        self.layout.row().prop(light, "type", expand=True)
        column = self.column()
        self._draw_temperature(column, light)
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        draw_moved(column, "exposure", light)
        draw_moved(column, "normalize", light)
        if light.type == "AREA":
            self._draw_area(column, light)
        else:
            name, label = SIZES[light.type]
            draw_moved(column, "use_soft_falloff", light)
            column.prop(light, name, text=label)
        if light.type == "SPOT":
            column.prop(light, "spot_size")
            column.prop(light, "spot_blend")
        if owner_of("cast_shadow", cycles(light)):
            column.prop(cycles(light), "cast_shadow")
        else:
            column.prop(light, "use_shadow", text="Cast Shadow")
        draw_moved(column, "max_bounces", cycles(light))

    def _draw_temperature(self, column: Any, light: Any) -> None:
        if owner_of("use_temperature", light):
            column.prop(light, "use_temperature")
            if light.use_temperature:
                column.prop(light, "temperature")

    def _draw_area(self, column: Any, light: Any) -> None:
        column.prop(light, "shape")
        sub = column.column(align=True)
        sub.prop(light, "size")
        if light.shape in {"RECTANGLE", "ELLIPSE"}:
            sub.prop(light, "size_y")
        column.prop(light, "spread")


CLASSES = (KOMOREBI_LIGHT_PT_light,)
