# mypy: disable-error-code="misc"
"""Render properties: hair, simplification, motion, film and what the machine may do."""

from __future__ import annotations

from typing import Any

import bpy
from bl_ui.properties_grease_pencil_common import GreasePencilSimplifyPanel

from .base import KomorebiPanel, cycles, draw_moved, owner_of

# The buttons under the shutter's curve: its shapes by Blender's operator, and their icons.
SHUTTER_SHAPES = (
    ("SMOOTH", "SMOOTHCURVE"),
    ("ROUND", "SPHERECURVE"),
    ("ROOT", "ROOTCURVE"),
    ("SHARP", "SHARPCURVE"),
    ("LINE", "LINCURVE"),
    ("MAX", "NOCURVE"),
)


class KOMOREBI_RENDER_PT_curves(KomorebiPanel, bpy.types.Panel):
    """The shape of hair strands; the settings are Cycles', as the artist made them there."""

    bl_label = "Curves"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and cycles(context.scene, "cycles_curves") is not None

    def draw(self, context: Any) -> None:
        curves = context.scene.cycles_curves
        column = self.column()
        column.prop(curves, "shape")
        if curves.shape == "RIBBONS":
            column.prop(curves, "subdivisions")


class KOMOREBI_RENDER_PT_simplify(KomorebiPanel, bpy.types.Panel):
    """Blender's own settings; its own panel would stand above Sampling."""

    bl_label = "Simplify"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.render, "use_simplify", text="")

    def draw(self, context: Any) -> None:
        pass  # all of it is in the panels below


class KOMOREBI_RENDER_PT_simplify_viewport(KomorebiPanel, bpy.types.Panel):
    bl_label = "Viewport"
    bl_parent_id = "KOMOREBI_RENDER_PT_simplify"

    def draw(self, context: Any) -> None:
        render = context.scene.render
        column = self.column()
        column.active = render.use_simplify
        column.prop(render, "simplify_subdivision", text="Max Subdivision")
        column.prop(render, "simplify_child_particles", text="Child Particles")
        column.prop(render, "simplify_volumes", text="Volume Resolution")
        draw_moved(column, "use_simplify_normals", render, text="Normals")


class KOMOREBI_RENDER_PT_simplify_render(KomorebiPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "KOMOREBI_RENDER_PT_simplify"

    def draw(self, context: Any) -> None:
        render = context.scene.render
        column = self.column()
        column.active = render.use_simplify
        column.prop(render, "simplify_subdivision_render", text="Max Subdivision")
        column.prop(render, "simplify_child_particles_render", text="Child Particles")


class KOMOREBI_RENDER_PT_simplify_greasepencil(
    KomorebiPanel, GreasePencilSimplifyPanel, bpy.types.Panel
):
    """Drawn by Blender's own function."""

    bl_label = "Grease Pencil"
    bl_parent_id = "KOMOREBI_RENDER_PT_simplify"
    bl_options = {"DEFAULT_CLOSED"}


class KOMOREBI_RENDER_PT_motion_blur(KomorebiPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: Any) -> None:
        scene, render = context.scene, context.scene.render
        column = self.column()
        column.active = render.use_motion_blur
        draw_moved(column, "motion_blur_position", render, cycles(scene), text="Position")
        column.prop(render, "motion_blur_shutter")
        settings = cycles(scene)
        if settings is not None:
            column.prop(settings, "rolling_shutter_type")
            row = column.row()
            row.active = settings.rolling_shutter_type != "NONE"
            row.prop(settings, "rolling_shutter_duration", text="Duration")


class KOMOREBI_RENDER_PT_motion_blur_curve(KomorebiPanel, bpy.types.Panel):
    bl_label = "Shutter Curve"
    bl_parent_id = "KOMOREBI_RENDER_PT_motion_blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        render = context.scene.render
        column = self.column()
        column.active = render.use_motion_blur
        column.template_curve_mapping(render, "motion_blur_shutter_curve")
        row = column.row(align=True)
        for shape, icon in SHUTTER_SHAPES:
            row.operator("render.shutter_curve_preset", icon=icon, text="").shape = shape


class KOMOREBI_RENDER_PT_film(KomorebiPanel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        column = self.column()
        sub = column.column()
        sub.active = context.scene.komorebi.method == "WORLD_LIGHT"
        sub.prop(context.scene.komorebi, "film_exposure")
        column.prop(context.scene.render, "film_transparent", text="Transparent")


class KOMOREBI_RENDER_PT_film_pixel_filter(KomorebiPanel, bpy.types.Panel):
    bl_label = "Pixel Filter"
    bl_parent_id = "KOMOREBI_RENDER_PT_film"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        column.prop(settings, "pixel_filter", text="Type")
        if settings.pixel_filter != "BOX":
            column.prop(settings, "filter_width")


class KOMOREBI_RENDER_PT_performance(KomorebiPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        render = context.scene.render
        column = self.column()
        column.prop(render, "threads_mode")
        sub = column.column()
        sub.enabled = render.threads_mode == "FIXED"
        sub.prop(render, "threads")
        column.prop(render, "use_persistent_data", text="Persistent Data")
        column.prop(context.scene.komorebi, "texture_limit")


class KOMOREBI_RENDER_PT_performance_compositor(KomorebiPanel, bpy.types.Panel):
    """Blender's own settings, in releases that have them."""

    bl_label = "Compositor"
    bl_parent_id = "KOMOREBI_RENDER_PT_performance"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        render = context.scene.render
        return super().poll(context) and owner_of("compositor_device", render) is not None

    def draw(self, context: Any) -> None:
        render = context.scene.render
        column = self.column()
        column.prop(render, "compositor_device", text="Device")
        draw_moved(column, "compositor_precision", render, text="Precision")
        draw_moved(column, "compositor_denoise_device", render, text="Denoising Device")
        draw_moved(column, "compositor_denoise_preview_quality", render, text="Preview Quality")
        draw_moved(column, "compositor_denoise_final_quality", render, text="Final Quality")


CLASSES = (
    KOMOREBI_RENDER_PT_curves,
    KOMOREBI_RENDER_PT_simplify,
    KOMOREBI_RENDER_PT_simplify_viewport,
    KOMOREBI_RENDER_PT_simplify_render,
    KOMOREBI_RENDER_PT_simplify_greasepencil,
    KOMOREBI_RENDER_PT_motion_blur,
    KOMOREBI_RENDER_PT_motion_blur_curve,
    KOMOREBI_RENDER_PT_film,
    KOMOREBI_RENDER_PT_film_pixel_filter,
    KOMOREBI_RENDER_PT_performance,
    KOMOREBI_RENDER_PT_performance_compositor,
)
