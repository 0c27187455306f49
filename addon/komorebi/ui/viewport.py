# mypy: disable-error-code="misc"
"""The rendered viewport: its samples and pixels, and what its shading popover offers."""

from __future__ import annotations

from typing import Any

import bpy

from ..denoise import library
from .base import ENGINE_ID, KomorebiPanel
from .sampling import draw_library, draw_noise_threshold


class KOMOREBI_RENDER_PT_sampling_viewport(KomorebiPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "KOMOREBI_RENDER_PT_sampling"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        draw_noise_threshold(column, settings, "preview_", is_used=True)
        column = column.column(align=True)
        if settings.use_preview_adaptive_sampling:
            column.prop(settings, "preview_samples", text="Max Samples")
            column.prop(settings, "preview_adaptive_min_samples", text="Min Samples")
        else:
            column.prop(settings, "preview_samples", text="Samples")


class KOMOREBI_RENDER_PT_sampling_viewport_denoise(KomorebiPanel, bpy.types.Panel):
    bl_label = "Denoise"
    bl_parent_id = "KOMOREBI_RENDER_PT_sampling_viewport"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        # What is switched on can be switched off, with a library or without.
        settings = context.scene.komorebi
        self.layout.enabled = settings.use_preview_denoising or not library.find().missing
        self.layout.prop(settings, "use_preview_denoising", text="")

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        column.active = settings.use_preview_denoising
        column.prop(settings, "preview_denoising_input_passes", text="Passes")
        column.prop(settings, "preview_denoising_prefilter", text="Prefilter")
        column.prop(settings, "preview_denoising_quality", text="Quality")
        column.prop(settings, "preview_denoising_start_sample", text="Start Sample")
        draw_library(column)


class KOMOREBI_RENDER_PT_performance_viewport(KomorebiPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "KOMOREBI_RENDER_PT_performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.scene.render, "preview_pixel_size", text="Pixel Size")
        column.prop(context.scene.komorebi, "preview_start_resolution", text="Start Pixels")


class ShadingPanel:
    """Part of the popover beside a viewport's shading modes."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_label = ""
    bl_parent_id = "VIEW3D_PT_shading"
    COMPAT_ENGINES = {ENGINE_ID}

    layout: Any

    @classmethod
    def poll(cls, context: Any) -> bool:
        shading = context.space_data.shading
        return context.engine in cls.COMPAT_ENGINES and shading.type == "RENDERED"


class KOMOREBI_VIEW3D_PT_shading_lighting(ShadingPanel, bpy.types.Panel):
    bl_label = "Lighting"

    def draw(self, context: Any) -> None:
        shading = context.space_data.shading
        column = self.layout.column()
        column.prop(shading, "use_scene_lights_render")
        column.prop(shading, "use_scene_world_render")
        if shading.use_scene_world_render:
            return
        row = self.layout.row()
        picture = row.column().row()
        picture.scale_y = 0.6
        picture.template_icon_view(shading, "studio_light", scale_popup=3)
        row.operator("preferences.studiolight_show", emboss=False, text="", icon="PREFERENCES")
        column = self.layout.column()
        column.prop(shading, "studiolight_rotate_z", text="Rotation")
        column.prop(shading, "studiolight_intensity")
        column.prop(shading, "studiolight_background_alpha")
        column.prop(shading, "studiolight_background_blur")


class KOMOREBI_VIEW3D_PT_shading_render_pass(ShadingPanel, bpy.types.Panel):
    bl_label = "Render Pass"

    def draw(self, context: Any) -> None:
        self.layout.prop(context.space_data.shading.komorebi, "render_pass", text="")


def draw_pause(self: Any, context: Any) -> None:
    """The button in a viewport's header that holds its picture."""
    if context.engine != ENGINE_ID or context.space_data.shading.type != "RENDERED":
        return
    settings = context.scene.komorebi
    icon = "PLAY" if settings.preview_pause else "PAUSE"
    self.layout.prop(settings, "preview_pause", icon=icon, text="")


CLASSES = (
    KOMOREBI_RENDER_PT_sampling_viewport,
    KOMOREBI_RENDER_PT_sampling_viewport_denoise,
    KOMOREBI_RENDER_PT_performance_viewport,
    KOMOREBI_VIEW3D_PT_shading_lighting,
    KOMOREBI_VIEW3D_PT_shading_render_pass,
)
