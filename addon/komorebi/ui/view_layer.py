# mypy: disable-error-code="misc"
"""View layer properties: passes, what is rendered of the scene, overrides."""

from __future__ import annotations

from typing import Any

import bpy

from .. import passes
from .base import KomorebiPanel, cycles, draw_moved, owner_of


class ViewLayerPanel(KomorebiPanel):
    bl_context = "view_layer"


# Made by Blender itself, in releases that have it.
GREASE_PENCIL = ("use_pass_grease_pencil", "Grease Pencil")


def toggles(group: str, layer: Any) -> list[tuple[Any, str, str]]:
    """The switches of passes of a `group` of the table: what holds it, property, label."""
    if group == "CRYPTOMATTE":
        return [(layer, name, label) for name, label, _ in passes.CRYPTOMATTES]
    found = [(s.place(layer), s.prop, s.label) for s in passes.SWITCHES if s.group == group]
    if group == "DATA" and owner_of(GREASE_PENCIL[0], layer) is not None:
        found.append((layer, *GREASE_PENCIL))
    return found


class PassesPanel(ViewLayerPanel):
    """The passes of one `group` of the table; not shown when it has none."""

    bl_parent_id = "KOMOREBI_VIEWLAYER_PT_passes"
    group: str

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and bool(toggles(cls.group, context.view_layer))

    def draw(self, context: Any) -> None:
        column = self.column()
        for owner, name, label in toggles(self.group, context.view_layer):
            column.prop(owner, name, text=label)


class KOMOREBI_VIEWLAYER_PT_passes(ViewLayerPanel, bpy.types.Panel):
    bl_label = "Passes"

    def draw(self, context: Any) -> None:
        pass  # all of it is in the panels below


class KOMOREBI_VIEWLAYER_PT_passes_data(PassesPanel, bpy.types.Panel):
    bl_label = "Data"
    group = "DATA"


class KOMOREBI_VIEWLAYER_PT_passes_light(PassesPanel, bpy.types.Panel):
    bl_label = "Light"
    group = "LIGHT"


class KOMOREBI_VIEWLAYER_PT_passes_cryptomatte(PassesPanel, bpy.types.Panel):
    bl_label = "Cryptomatte"
    group = "CRYPTOMATTE"

    def draw(self, context: Any) -> None:
        layer = context.view_layer
        shown = toggles(self.group, layer)
        column = self.column()
        for owner, name, label in shown:
            column.prop(owner, name, text=label)
        column = self.column()
        column.active = any(getattr(owner, name) for owner, name, _ in shown)
        column.prop(layer, "pass_cryptomatte_depth", text="Levels")


class KOMOREBI_VIEWLAYER_PT_passes_other(PassesPanel, bpy.types.Panel):
    bl_label = "Other"
    group = "OTHER"


class KOMOREBI_VIEWLAYER_PT_passes_aov(ViewLayerPanel, bpy.types.Panel):
    bl_label = "Shader AOV"
    bl_parent_id = "KOMOREBI_VIEWLAYER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layer = context.view_layer
        row = self.column().row()
        row.template_list(
            "VIEWLAYER_UL_aov", "aovs", layer, "aovs", layer, "active_aov_index", rows=3
        )
        column = row.column(align=True)
        column.operator("scene.view_layer_add_aov", icon="ADD", text="")
        column.operator("scene.view_layer_remove_aov", icon="REMOVE", text="")
        if layer.active_aov is not None and not layer.active_aov.is_valid:
            self.layout.label(text="Another pass has this name", icon="ERROR")


class KOMOREBI_VIEWLAYER_PT_filter(ViewLayerPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        layer = context.view_layer
        column = self.column(heading="Include")
        column.prop(layer, "use_sky", text="Environment")
        column.prop(layer, "use_solid", text="Surfaces")
        column.prop(layer, "use_strand", text="Curves")
        draw_moved(column, "use_grease_pencil", layer, text="Grease Pencil")  # Blender draws it
        column = self.column(heading="Use")
        column.active = context.scene.render.use_motion_blur
        column.prop(layer, "use_motion_blur", text="Motion Blur")
        settings = cycles(layer)
        if settings is not None:
            row = self.column().row()
            row.active = context.scene.komorebi.use_denoising
            row.prop(settings, "use_denoising", text="Denoising")


class KOMOREBI_VIEWLAYER_PT_override(ViewLayerPanel, bpy.types.Panel):
    """For releases in which Blender has no such panel of its own."""

    bl_label = "Override"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and not hasattr(bpy.types, "VIEWLAYER_PT_override")

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.view_layer, "material_override")
        draw_moved(column, "world_override", context.view_layer)
        column.prop(context.view_layer, "samples")


CLASSES = (
    KOMOREBI_VIEWLAYER_PT_passes,
    KOMOREBI_VIEWLAYER_PT_passes_data,
    KOMOREBI_VIEWLAYER_PT_passes_light,
    KOMOREBI_VIEWLAYER_PT_passes_cryptomatte,
    KOMOREBI_VIEWLAYER_PT_passes_other,
    KOMOREBI_VIEWLAYER_PT_passes_aov,
    KOMOREBI_VIEWLAYER_PT_filter,
    KOMOREBI_VIEWLAYER_PT_override,
)
