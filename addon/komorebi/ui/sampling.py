# mypy: disable-error-code="misc"
"""Render properties: samples, noise, and what is computed."""

from __future__ import annotations

import textwrap
from typing import Any

import bpy

from ..denoise import library
from .base import ENGINE_ID, KomorebiPanel, cycles


class KOMOREBI_RENDER_PT_sampling(KomorebiPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context: Any) -> None:
        pass  # all of it is in the panels below


def draw_noise_threshold(column: Any, settings: Any, prefix: str, is_used: bool) -> None:
    """Of the final render, or of the viewport (`prefix` "preview_")."""
    heading = column.column(align=True, heading="Noise Threshold")
    heading.enabled = is_used
    row = heading.row(align=True)
    switch = f"use_{prefix}adaptive_sampling"
    row.prop(settings, switch, text="")
    sub = row.row()
    sub.active = getattr(settings, switch)
    sub.prop(settings, f"{prefix}adaptive_threshold", text="")


def draw_library(column: Any) -> None:
    """Where the library to denoise with is, or why there is none."""
    found = library.find()
    text = found.missing or f"Open Image Denoise: {found.path}"
    for line in textwrap.wrap(text, 60, break_on_hyphens=False):
        column.label(text=line)


class KOMOREBI_RENDER_PT_sampling_render(KomorebiPanel, bpy.types.Panel):
    bl_label = "Render"
    bl_parent_id = "KOMOREBI_RENDER_PT_sampling"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        in_parts = settings.sample_offset > 0  # where the parts would stop at different samples
        draw_noise_threshold(column, settings, "", is_used=not in_parts)
        column = column.column(align=True)
        if settings.use_adaptive_sampling and not in_parts:
            column.prop(settings, "samples", text="Max Samples")
            column.prop(settings, "adaptive_min_samples")
        else:
            column.prop(settings, "samples")
        column.prop(settings, "time_limit")
        self.layout.prop(settings, "light_samples")


class KOMOREBI_RENDER_PT_sampling_render_denoise(KomorebiPanel, bpy.types.Panel):
    bl_label = "Denoise"
    bl_parent_id = "KOMOREBI_RENDER_PT_sampling_render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: Any) -> None:
        # What is switched on can be switched off, with a library or without.
        settings = context.scene.komorebi
        self.layout.enabled = settings.use_denoising or not library.find().missing
        self.layout.prop(settings, "use_denoising", text="")

    def draw(self, context: Any) -> None:
        column = self.column()
        column.active = context.scene.komorebi.use_denoising
        draw_library(column)


class KOMOREBI_RENDER_PT_sampling_advanced(KomorebiPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "KOMOREBI_RENDER_PT_sampling"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        row = column.row(align=True)
        row.prop(settings, "seed")
        row.prop(settings, "use_animated_seed", text="", icon="TIME")
        column.prop(settings, "sample_offset")
        sub = column.column()
        sub.active = settings.method == "WORLD_LIGHT"
        sub.prop(settings, "environment_sampling")
        sub.prop(settings, "world_resolution")
        column.prop(settings, "use_progressive")
        of_cycles = cycles(context.scene)
        if of_cycles is not None and any(layer.samples for layer in context.scene.view_layers):
            column.prop(of_cycles, "use_layer_samples", text="Layer Samples")


class KOMOREBI_RENDER_PT_ambient_occlusion(KomorebiPanel, bpy.types.Panel):
    bl_label = "Ambient Occlusion"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.scene.komorebi.method == "AMBIENT_OCCLUSION"

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.scene.komorebi, "ao_distance")
        column.prop(context.scene.komorebi, "ao_indirect_bounces")
        column.prop(context.scene.komorebi, "ao_sampling")


class KOMOREBI_RENDER_PT_surface(KomorebiPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        self.column().row().prop(settings, "surface", expand=True)
        column = self.column()
        column.active = settings.surface == "CLAY"
        sub = column.column()
        sub.active = settings.method == "WORLD_LIGHT"
        sub.prop(settings, "clay_color", text="Clay")
        column.prop(settings, "clay_glass", text="Glass")
        column.prop(settings, "clay_bump")


class KOMOREBI_RENDER_PT_sky(KomorebiPanel, bpy.types.Panel):
    bl_label = "Sky"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.scene.komorebi.method == "WORLD_LIGHT"

    def draw(self, context: Any) -> None:
        settings = context.scene.komorebi
        column = self.column()
        column.prop(settings, "sky", text="Light From")
        sub = column.column()
        sub.active = settings.sky == "STUDIO"
        sub.prop(settings, "sky_studio_light")
        sub.prop(settings, "sky_rotation")
        sub = column.column()
        sub.active = settings.sky != "SCENE"
        sub.prop(settings, "sky_strength")


def draw_method(self: Any, context: Any) -> None:
    """Below the list of render engines, as Cycles draws its device."""
    if context.engine == ENGINE_ID:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(context.scene.komorebi, "method")


CLASSES = (
    KOMOREBI_RENDER_PT_sampling,
    KOMOREBI_RENDER_PT_sampling_render,
    KOMOREBI_RENDER_PT_sampling_render_denoise,
    KOMOREBI_RENDER_PT_sampling_advanced,
    KOMOREBI_RENDER_PT_ambient_occlusion,
    KOMOREBI_RENDER_PT_surface,
    KOMOREBI_RENDER_PT_sky,
)
