"""Blender's camera → one projection × view matrix, computed in doubles; lens, panorama, stereo.

The projection is Blender's own (sensor fit, lens shift, pixel aspect), from the camera's
parameters rather than from `calc_matrix_camera`, which rounds to single precision.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import RenderError
from ..scene_data import CameraData, DoubleArray
from .lens import lens_numbers
from .names import name_of
from .panorama import panorama_numbers, stereo_numbers

KINDS = {"PERSP": "PERSPECTIVE", "ORTHO": "ORTHOGRAPHIC", "PANO": "PANORAMA"}


@dataclass(slots=True)
class Lens:
    """What shapes a camera's picture. Lengths of sensor and lens in mm, clip distances in m."""

    kind: str  # PERSP, ORTHO, PANO
    focal_length: float
    ortho_scale: float  # m across the fitted side
    sensor_fit: str  # AUTO, HORIZONTAL, VERTICAL
    sensor_width: float
    sensor_height: float
    shift_x: float  # in units of the fitted side
    shift_y: float
    clip_start: float
    clip_end: float

    @property
    def sensor(self) -> float:
        """The side of the sensor that is fitted to a side of the picture, in mm."""
        # With the fit on AUTO Blender takes the sensor's width for both sides.
        return self.sensor_height if self.sensor_fit == "VERTICAL" else self.sensor_width


def projection(
    lens: Lens, width: int, height: int, aspect_x: float, aspect_y: float
) -> DoubleArray:
    """clip_from_camera [4, 4] as OpenGL's: the camera looks along −Z, Y up."""
    horizontal = lens.sensor_fit == "HORIZONTAL" or (
        lens.sensor_fit == "AUTO" and width * aspect_x >= height * aspect_y
    )
    y_per_x = aspect_y / aspect_x  # height of a pixel in its widths
    side = width if horizontal else y_per_x * height  # the fitted side, in pixel widths
    if lens.kind == "ORTHO":
        pixel = lens.ortho_scale / side
    else:
        pixel = lens.sensor * lens.clip_start / lens.focal_length / side
    center_x, center_y = lens.shift_x * side * pixel, lens.shift_y * side * pixel
    half_x, half_y = 0.5 * width * pixel, 0.5 * height * y_per_x * pixel
    near, far = lens.clip_start, lens.clip_end

    result = np.zeros((4, 4))
    if lens.kind == "ORTHO":
        result[0, 0], result[0, 3] = 1.0 / half_x, -center_x / half_x
        result[1, 1], result[1, 3] = 1.0 / half_y, -center_y / half_y
        result[2, 2], result[2, 3] = -2.0 / (far - near), -(far + near) / (far - near)
        result[3, 3] = 1.0
    else:
        result[0, 0], result[0, 2] = near / half_x, center_x / half_x
        result[1, 1], result[1, 2] = near / half_y, center_y / half_y
        result[2, 2] = -(far + near) / (far - near)
        result[2, 3] = -2.0 * far * near / (far - near)
        result[3, 2] = -1.0
    return result


def camera_from_world(world_from_object: DoubleArray) -> DoubleArray:
    """The view matrix [4, 4]; the camera object's scale is taken out, as Blender does."""
    world_from_camera = np.array(world_from_object, np.float64)
    lengths = np.linalg.norm(world_from_camera[:3, :3], axis=0)
    if not np.isfinite(world_from_camera).all() or not (lengths > 0).all():
        raise RenderError("The camera's scale is zero or its matrix not finite")
    world_from_camera[:3, :3] /= lengths
    try:
        return np.linalg.inv(world_from_camera)
    except np.linalg.LinAlgError:
        raise RenderError("The camera's matrix cannot be inverted") from None


def export_camera(engine: Any, depsgraph: Any, view: str) -> CameraData:
    """The camera that renders this frame (scene's, marker's, strip's or the view's), for `view`."""
    if view:
        engine.active_view_set(view)  # from here on `camera_override` is the view's camera
    camera = camera_object(engine, depsgraph)
    lens = read_lens(camera)
    stereo = None
    world_from_camera = camera_pose(engine, camera, view)
    if view:
        spherical = engine.use_spherical_stereo(camera)
        lens.shift_x = engine.camera_shift_x(camera, use_spherical_stereo=spherical)
        stereo = stereo_numbers(camera, view) if spherical else None
    view_matrix = camera_from_world(world_from_camera)
    render = depsgraph.scene.render
    width, height = engine.resolution_x, engine.resolution_y
    aspect = (render.pixel_aspect_x, render.pixel_aspect_y)
    data = CameraData(
        name=name_of(camera), kind=KINDS[lens.kind], matrix=view_matrix, width=width, height=height,
        clip_start=lens.clip_start, clip_end=lens.clip_end,
        lens=lens_numbers(camera, depsgraph, world_from_camera), stereo=stereo,
    )  # fmt: skip
    if lens.kind == "PANO":
        data.matrix = world_from_camera
        shift = (lens.shift_x, lens.shift_y)
        data.panorama = panorama_numbers(camera, width, height, aspect, shift)
    else:
        data.matrix = projection(lens, width, height, *aspect) @ view_matrix
    return data


def camera_pose(engine: Any, camera: Any, view: str) -> DoubleArray:
    """World from camera of an evaluated camera object, or of the active view `view` that it has."""
    matrix = camera.matrix_world
    if view:
        spherical = engine.use_spherical_stereo(camera)
        matrix = engine.camera_model_matrix(camera, use_spherical_stereo=spherical)
    return np.array(matrix, np.float64, order="C").reshape(4, 4)


def camera_object(engine: Any, depsgraph: Any) -> Any:
    """The evaluated camera object, or RenderError."""
    camera = engine.camera_override or depsgraph.scene.camera
    if camera is None:
        raise RenderError(f'Scene "{name_of(depsgraph.scene)}" has no camera')
    return camera.evaluated_get(depsgraph)


def read_lens(camera: Any) -> Lens:
    """The parameters of a camera object; RenderError when its kind is not supported."""
    data = camera.data
    if camera.type != "CAMERA":
        raise RenderError(f'Object "{name_of(camera)}" is used as a camera but is none')
    if data.type not in KINDS:
        raise RenderError(
            f'Camera "{name_of(camera)}" is of type {data.type}: cameras written in Open Shading '
            "Language are not supported, make it perspective, orthographic or panoramic"
        )
    return Lens(
        kind=data.type, focal_length=data.lens, ortho_scale=data.ortho_scale,
        sensor_fit=data.sensor_fit, sensor_width=data.sensor_width,
        sensor_height=data.sensor_height, shift_x=data.shift_x, shift_y=data.shift_y,
        clip_start=data.clip_start, clip_end=data.clip_end,
    )  # fmt: skip
