"""The Mapping node as a matrix. Plain mathematics, no bpy."""

from __future__ import annotations

from collections.abc import Sequence

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


def nearest_rotation(matrix: DoubleArray) -> tuple[DoubleArray, bool]:
    """The rotation (or reflection) nearest to `matrix`, and whether it is the whole of it.

    Lengths do not matter to a direction, so an even scale is no loss. Polar decomposition.
    """
    left, sizes, right = np.linalg.svd(matrix)
    if sizes[0] <= 0.0:
        return np.eye(3), False
    exact = bool(sizes[2] >= sizes[0] * (1.0 - ORTHOGONAL_TOLERANCE))
    return left @ right, exact
