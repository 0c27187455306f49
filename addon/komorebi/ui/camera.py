# mypy: disable-error-code="misc"
"""Camera properties that Blender's own panels show for Cycles alone."""

from __future__ import annotations

from typing import Any

import bpy

from .base import KomorebiPanel, cycles, owner_of

# What shapes each kind of panorama. The names are the same on Blender's cameras and, in 3.4,
# in Cycles' group.
PANORAMAS = {
    "EQUIRECTANGULAR": ("latitude_min", "latitude_max", "longitude_min", "longitude_max"),
    "EQUIANGULAR_CUBEMAP_FACE": (),
    "MIRRORBALL": (),
    "FISHEYE_EQUIDISTANT": ("fisheye_fov",),
    "FISHEYE_EQUISOLID": ("fisheye_lens", "fisheye_fov"),
    "FISHEYE_LENS_POLYNOMIAL": (
        "fisheye_fov",
        *(f"fisheye_polynomial_k{power}" for power in range(5)),
    ),
    "CENTRAL_CYLINDRICAL": (
        "central_cylindrical_range_v_min",
        "central_cylindrical_range_v_max",
        "central_cylindrical_range_u_min",
        "central_cylindrical_range_u_max",
        "central_cylindrical_radius",
    ),
}


class KOMOREBI_CAMERA_PT_panorama(KomorebiPanel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"
    bl_parent_id = "DATA_PT_lens"
    bl_options = {"HIDE_HEADER"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        camera = context.camera
        return super().poll(context) and camera is not None and camera.type == "PANO"

    def draw(self, context: Any) -> None:
        camera = context.camera
        self.layout.use_property_split = True  # and with dots, as in the panel that it is part of
        column = self.layout.column()
        settings = owner_of("panorama_type", camera, cycles(camera))
        if settings is None:
            column.label(text="Panoramas are set by Cycles' add-on, which is off", icon="INFO")
            return
        column.prop(settings, "panorama_type")
        column = column.column(align=True)
        for name in PANORAMAS.get(settings.panorama_type, ()):
            column.prop(settings, name)


CLASSES = (KOMOREBI_CAMERA_PT_panorama,)
