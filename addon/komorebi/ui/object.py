# mypy: disable-error-code="misc"
"""Object properties: who sees an object, its shading, its motion."""

from __future__ import annotations

from typing import Any

import bpy

from .base import GEOMETRY, KomorebiPanel, cycles, draw_moved, owner_of


def instances_collection(obj: Any) -> bool:
    """Whether the object is an empty that stands for a collection."""
    return obj.instance_type == "COLLECTION" and obj.instance_collection is not None


def is_seen(obj: Any) -> bool:
    """Whether rays meet the object, or what it instances."""
    return obj.type in GEOMETRY or instances_collection(obj)


class ObjectPanel(KomorebiPanel):
    bl_context = "object"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and context.object is not None


class GeometryPanel(ObjectPanel):
    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and is_seen(context.object)


class KOMOREBI_OBJECT_PT_motion_blur(ObjectPanel, bpy.types.Panel):
    """The settings are Cycles', as the artist made them there."""

    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        obj = context.object
        return (
            super().poll(context)
            and (is_seen(obj) or obj.type == "CAMERA")
            and cycles(obj) is not None
        )

    def draw_header(self, context: Any) -> None:
        self.layout.active = context.scene.render.use_motion_blur
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context: Any) -> None:
        obj, settings = context.object, context.object.cycles
        column = self.column()
        column.active = context.scene.render.use_motion_blur and settings.use_motion_blur
        column.prop(settings, "motion_steps", text="Steps")
        if obj.type != "CAMERA":
            column.prop(settings, "use_deform_motion", text="Deformation")


class KOMOREBI_OBJECT_PT_shading(GeometryPanel, bpy.types.Panel):
    bl_label = "Shading"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return super().poll(context) and bool(terminator_owners(context.object))

    def draw(self, context: Any) -> None:
        pass  # all of it is in the panel below


class KOMOREBI_OBJECT_PT_shading_shadow_terminator(GeometryPanel, bpy.types.Panel):
    bl_label = "Shadow Terminator"
    bl_parent_id = "KOMOREBI_OBJECT_PT_shading"

    def draw(self, context: Any) -> None:
        owners = terminator_owners(context.object)
        column = self.column(align=True)
        geometry, shading = "shadow_terminator_geometry_offset", "shadow_terminator_offset"
        draw_moved(column, geometry, *owners, text="Geometry Offset")
        draw_moved(column, shading, *owners, text="Shading Offset")
        draw_moved(column, "shadow_terminator_shading_offset", *owners, text="Shading Offset")


def terminator_owners(obj: Any) -> list[Any]:
    """What has the offsets of the shadow terminator: the object, or Cycles' group before 4.4."""
    name = "shadow_terminator_geometry_offset"
    owner = owner_of(name, obj, cycles(obj))
    return [] if owner is None else [owner]


class KOMOREBI_OBJECT_PT_visibility(ObjectPanel, bpy.types.Panel):
    bl_label = "Visibility"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Any) -> None:
        obj = context.object
        inverted = {"invert_checkbox": True, "toggle": False}
        self.column().prop(obj, "hide_select", text="Selectable", **inverted)
        column = self.column(heading="Show In")
        column.prop(obj, "hide_viewport", text="Viewports", **inverted)
        column.prop(obj, "hide_render", text="Renders", **inverted)
        if obj.type in {"GPENCIL", "GREASEPENCIL"}:
            self.column(heading="Grease Pencil").prop(obj, "use_grease_pencil_lights")
        if is_seen(obj):
            column = self.column(heading="Mask")
            column.prop(obj, "is_shadow_catcher")
            column.prop(obj, "is_holdout")


class KOMOREBI_OBJECT_PT_visibility_ray_visibility(GeometryPanel, bpy.types.Panel):
    """The rays that there are."""

    bl_label = "Ray Visibility"
    bl_parent_id = "KOMOREBI_OBJECT_PT_visibility"

    def draw(self, context: Any) -> None:
        column = self.column()
        column.prop(context.object, "visible_camera", text="Camera")
        column.prop(context.object, "visible_diffuse", text="Diffuse")
        column.prop(context.object, "visible_shadow", text="Shadow")


CLASSES = (
    KOMOREBI_OBJECT_PT_motion_blur,
    KOMOREBI_OBJECT_PT_shading,
    KOMOREBI_OBJECT_PT_shading_shadow_terminator,
    KOMOREBI_OBJECT_PT_visibility,
    KOMOREBI_OBJECT_PT_visibility_ray_visibility,
)
