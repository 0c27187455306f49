"""What shader trees see of their scene: its frame and its camera."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..scene_data import DoubleArray


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Of one frame; without a scene that of a picture without camera."""

    frame: int = 1
    # [3, 4] into the camera's space: right, up, depth; of a panorama depth, left, up
    camera_from_world: DoubleArray | None = None


def surroundings_of(scene: Any) -> Surroundings:
    camera = scene.camera
    if camera is None:
        return Surroundings(scene.frame_current)
    right, up, back = np.linalg.inv(_unit_axes(np.array(camera.matrix_world, np.float64)))[:3]
    is_panorama = getattr(camera.data, "type", "") == "PANO"
    rows = (-back, -right, up) if is_panorama else (right, up, -back)
    return Surroundings(scene.frame_current, np.stack(rows))


def _unit_axes(matrix: DoubleArray) -> DoubleArray:
    """A camera's matrix without its scale, which no camera heeds."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    matrix[:3, :3] /= np.where(lengths > 0.0, lengths, 1.0)
    return matrix if abs(np.linalg.det(matrix)) > 0.0 else np.eye(4)
