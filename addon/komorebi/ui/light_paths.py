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


CLASSES = (
    KOMOREBI_RENDER_PT_light_paths,
    KOMOREBI_RENDER_PT_light_paths_max_bounces,
    KOMOREBI_RENDER_PT_light_paths_clamping,
)
