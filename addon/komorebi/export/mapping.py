"""The Mapping node as a matrix. Plain mathematics, no bpy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..scene_data import DoubleArray

ORTHOGONAL_TOLERANCE = 1e-4


def euler_matrix(euler: Sequence[float]) -> DoubleArray:
    """Rotation about X, then Y, then Z (Blender's Euler XYZ), radians."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(np.asarray(euler)), np.sin(np.asarray(euler))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    result: DoubleArray = about_z @ about_y @ about_x
    return result


def mapping_matrix(kind: str, rotation: Sequence[float], scale: Sequence[float]) -> DoubleArray:
    """What a Mapping node of type `kind` does to a direction [3, 3], its location left aside."""
    turn = euler_matrix(rotation)
    factor = np.asarray(scale, np.float64)
    with np.errstate(divide="ignore"):
        inverse = np.where(factor != 0.0, 1.0 / np.where(factor != 0.0, factor, 1.0), 0.0)
    if kind == "TEXTURE":
        return np.diag(inverse) @ turn.T
    if kind == "NORMAL":
        return turn @ np.diag(inverse)
    return turn @ np.diag(factor)  # POINT, VECTOR


def own_mapping(node: Any) -> DoubleArray | None:
    """What a texture node does to coordinates before it looks them up, which no panel shows but
    scripts and files of 2.7x set (`texture_mapping`) [3, 4], as Cycles has it; None: nothing.

    The type NORMAL also makes them unit.
    """
    own = getattr(node, "texture_mapping", None)  # White Noise has none
    if own is None:
        return None
    axes = (own.mapping_x, own.mapping_y, own.mapping_z)
    location, rotation, scale = (
        np.array(v, np.float64) for v in (own.translation, own.rotation, own.scale)
    )
    if axes == ("X", "Y", "Z") and not (location.any() or rotation.any() or (scale != 1.0).any()):
        return None
    kind, turn = own.vector_type, euler_matrix(rotation)  # type: ignore[arg-type]
    if kind in {"TEXTURE", "NORMAL"}:
        scale = np.where(abs(scale) < 1e-5, np.where(scale < 0.0, -1e-5, 1e-5), scale)
    if kind == "TEXTURE":
        linear = np.diag(1.0 / scale) @ turn.T
        location = linear @ -location
    elif kind == "NORMAL":
        linear, location = turn @ np.diag(1.0 / scale), np.zeros(3)
    else:
        linear = turn @ np.diag(scale)
        location = location if kind == "POINT" else np.zeros(3)
    chosen = np.array([[float(axis == name) for name in "XYZ"] for axis in axes])
    return np.column_stack([linear @ chosen, location])


def nearest_rotation(matrix: DoubleArray) -> tuple[DoubleArray, bool]:
    """The rotation (or reflection) nearest to `matrix`, and whether it is the whole of it.

    Lengths do not matter to a direction, so an even scale is no loss. Polar decomposition.
    """
    left, sizes, right = np.linalg.svd(matrix)
    if sizes[0] <= 0.0:
        return np.eye(3), False
    exact = bool(sizes[2] >= sizes[0] * (1.0 - ORTHOGONAL_TOLERANCE))
    return left @ right, exact
