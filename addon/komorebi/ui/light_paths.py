# mypy: disable-error-code="misc"
"""Render properties: how often light bounces, and what is done about its noise."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel


class KOMOREBI_RENDER_PT_light_paths(KomorebiPanel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        pass  # all of it is in the panels below


class KOMOREBI_RENDER_PT_light_paths_max_bounces(KomorebiPanel, bpy.types.Panel):
    bl_label = "Max Bounces"
    bl_parent_id = "KOMOREBI_RENDER_PT_light_paths"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        ambient = settings.method == "AMBIENT_OCCLUSION"
        self.column().prop(settings, "ao_indirect_bounces" if ambient else "bounces", text="Total")


class KOMOREBI_RENDER_PT_light_paths_clamping(KomorebiPanel, bpy.types.Panel):
    bl_label = "Clamping"
    bl_parent_id = "KOMOREBI_RENDER_PT_light_paths"

    def draw(self, context: Any) -> None:
        column = self.column(align=True)
        column.prop(context.scene.komorebi, "sample_clamp_direct")
        column.prop(context.scene.komorebi, "sample_clamp_indirect")


class KOMOREBI_RENDER_PT_light_paths_fast_gi(KomorebiPanel, bpy.types.Panel):
    bl_label = "Fast GI Approximation"
    bl_options = {"DEFAULT_CLOSED"}
    bl_parent_id = "KOMOREBI_RENDER_PT_light_paths"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.scene.komorebi.method == "WORLD_LIGHT"

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.komorebi, "use_fast_gi", text="")

    def draw(self, context: Any) -> None:
        settings, world = context.scene.komorebi, context.scene.world
        self.layout.active = settings.use_fast_gi
        self.column().prop(settings, "fast_gi_method")
        if world is not None:
            column = self.column(align=True)
            column.prop(world.light_settings, "ao_factor", text="AO Factor")
            column.prop(world.light_settings, "distance", text="AO Distance")
        if settings.fast_gi_method == "REPLACE":
            column = self.column(align=True)
            column.prop(settings, "ao_bounces")
            column.prop(settings, "ao_bounces_render")


CLASSES = (
    KOMOREBI_RENDER_PT_light_paths,
    KOMOREBI_RENDER_PT_light_paths_max_bounces,
    KOMOREBI_RENDER_PT_light_paths_clamping,
    KOMOREBI_RENDER_PT_light_paths_fast_gi,
)
