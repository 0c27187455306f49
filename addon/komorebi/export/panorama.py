"""Panoramic cameras and spherical stereo → numbers by the core's names, as Cycles reads them."""

from __future__ import annotations

from typing import Any

from .. import compat
from ..errors import RenderError
from .names import name_of

SENSOR_KINDS = {"FISHEYE_EQUISOLID", "FISHEYE_LENS_POLYNOMIAL"}


def panorama_numbers(
    camera: Any, width: int, height: int, aspect: tuple[float, float], shift: tuple[float, float]
) -> dict[str, Any]:
    """The projection of a camera object of type PANO for a picture of width × height pixels of
    `aspect`; RenderError when nothing is known about it."""
    settings = compat.panorama_settings(camera.data)
    if settings is None:
        raise RenderError(
            f'Camera "{name_of(camera)}" is panoramic: in this release of Blender the Cycles '
            "add-on keeps its settings, so that must be switched on"
        )
    kind = settings.panorama_type
    numbers = {"kind": kind, "shift_x": shift[0], "shift_y": shift[1]}
    if kind == "EQUIRECTANGULAR":
        for name in ("longitude_min", "longitude_max", "latitude_min", "latitude_max"):
            numbers[name] = getattr(settings, name)
    elif kind == "CENTRAL_CYLINDRICAL":
        numbers["longitude_min"] = settings.central_cylindrical_range_u_min
        numbers["longitude_max"] = settings.central_cylindrical_range_u_max
        radius = settings.central_cylindrical_radius
        numbers["height_min"] = settings.central_cylindrical_range_v_min / radius
        numbers["height_max"] = settings.central_cylindrical_range_v_max / radius
    elif kind.startswith("FISHEYE"):
        numbers["fov"] = settings.fisheye_fov
    if kind == "FISHEYE_EQUISOLID":
        numbers["focal_length"] = settings.fisheye_lens
    if kind == "FISHEYE_LENS_POLYNOMIAL":
        for power in range(5):
            numbers[f"k{power}"] = getattr(settings, f"fisheye_polynomial_k{power}")
    if kind in SENSOR_KINDS:
        numbers["sensor_width"], numbers["sensor_height"] = sensor_size(
            camera.data, width * aspect[0], height * aspect[1]
        )
    return numbers


def sensor_size(data: Any, width: float, height: float) -> tuple[float, float]:
    """The part of the sensor that a picture of that shape covers, in mm."""
    fit = data.sensor_fit
    if fit == "HORIZONTAL" or (fit == "AUTO" and width > height):
        return data.sensor_width, data.sensor_width * height / width
    side = data.sensor_height if fit == "VERTICAL" else data.sensor_width
    return side * width / height, side


def stereo_numbers(camera: Any, view: str) -> dict[str, float] | None:
    """One eye of spherical stereo; None for a view that is no eye."""
    stereo = camera.data.stereo
    side = {"left": -0.5, "right": 0.5}.get(view, 0.0)
    if side * stereo.interocular_distance == 0.0:
        return None
    numbers = {"eye": side * stereo.interocular_distance}
    if stereo.convergence_mode != "PARALLEL":
        numbers["convergence_distance"] = stereo.convergence_distance
    if stereo.use_pole_merge:
        numbers["pole_merge_angle_from"] = stereo.pole_merge_angle_from
        numbers["pole_merge_angle_to"] = stereo.pole_merge_angle_to
    return numbers
