# mypy: disable-error-code="misc"
"""World properties."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel, cycles, draw_surface


class WorldPanel(KomorebiPanel):
    bl_context = "world"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.world is not None


class KOMOREBI_WORLD_PT_preview(WorldPanel, bpy.types.Panel):
    bl_label = "Preview"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        self.layout.template_preview(context.world)


class KOMOREBI_WORLD_PT_surface(WorldPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context: Any) -> None:
        draw_surface(self.layout, context.world, "color")


class KOMOREBI_WORLD_PT_ambient_occlusion(WorldPanel, bpy.types.Panel):
    bl_label = "Ambient Occlusion"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        self.column().prop(context.world.light_settings, "distance")


class KOMOREBI_WORLD_PT_settings(WorldPanel, bpy.types.Panel):
    """What counts of Cycles' settings of a world."""

    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and cycles(context.world) is not None

    def draw(self, context: Any) -> None:
        self.column().prop(context.world.cycles, "max_bounces")


class KOMOREBI_WORLD_PT_mist(WorldPanel, bpy.types.Panel):
    bl_label = "Mist Pass"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and any(
            layer.use_pass_mist for layer in context.scene.view_layers
        )

    def draw(self, context: Any) -> None:
        mist = context.world.mist_settings
        column = self.column(align=True)
        column.prop(mist, "start")
        column.prop(mist, "depth")
        self.column().prop(mist, "falloff")


class KOMOREBI_WORLD_PT_ray_visibility(WorldPanel, bpy.types.Panel):
    """The rays that there are; the settings are Cycles'."""

    bl_label = "Ray Visibility"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and cycles(context.world, "cycles_visibility") is not None

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.world.cycles_visibility, "camera")
        column.prop(context.world.cycles_visibility, "diffuse")


CLASSES = (
    KOMOREBI_WORLD_PT_preview,
    KOMOREBI_WORLD_PT_surface,
    KOMOREBI_WORLD_PT_ambient_occlusion,
    KOMOREBI_WORLD_PT_mist,
    KOMOREBI_WORLD_PT_ray_visibility,
    KOMOREBI_WORLD_PT_settings,
)
