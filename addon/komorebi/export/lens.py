"""Depth of field: a camera's settings → the numbers of a thin lens, as Cycles reads them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import RenderError
from ..scene_data import DoubleArray
from .names import name_of

LEAST_FSTOP = 1e-5


def lens_numbers(
    camera: Any, depsgraph: Any, world_from_camera: DoubleArray
) -> dict[str, float] | None:
    """The lens of the camera object `camera` at that pose; None when all is sharp."""
    data = camera.data
    dof = data.dof
    if not dof.use_dof:
        return None
    # An orthographic camera has no focal length: Cycles takes one metre.
    focal_length = 1.0 if data.type == "ORTHO" else 1e-3 * data.lens
    distance = focus_distance(dof, depsgraph, world_from_camera)
    if not distance > 0.0:
        raise RenderError(
            f'Camera "{name_of(camera)}" focuses at distance {distance:g}: it must be more than 0'
        )
    return {
        "radius": focal_length / (2.0 * max(dof.aperture_fstop, LEAST_FSTOP)),
        "blades": dof.aperture_blades if dof.aperture_blades >= 3 else 0,
        "rotation": dof.aperture_rotation,
        "ratio": dof.aperture_ratio,
        "focus_distance": distance,
    }


def focus_distance(dof: Any, depsgraph: Any, world_from_camera: DoubleArray) -> float:
    """The distance along the camera's axis of the focus object (or its bone), or the number."""
    if dof.focus_object is None:
        return float(dof.focus_distance)
    target = dof.focus_object.evaluated_get(depsgraph)
    matrix = np.array(target.matrix_world, np.float64)
    if target.pose is not None and dof.focus_subtarget:
        bone = target.pose.bones.get(dof.focus_subtarget)
        if bone is not None:
            matrix = matrix @ np.array(bone.matrix, np.float64)
    axis = world_from_camera[:3, 2] / np.linalg.norm(world_from_camera[:3, 2])
    return float(abs(axis @ (world_from_camera[:3, 3] - matrix[:3, 3])))
