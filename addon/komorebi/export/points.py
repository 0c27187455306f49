"""Point clouds (objects of type POINTCLOUD, or what geometry nodes make) → PointData."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import compat
from ..scene_data import PointData

DEFAULT_RADIUS = 0.01  # of points without the attribute, as in Cycles


def export_points(cloud: Any, name: str) -> PointData | None:
    """The points of evaluated PointCloud data; None when it has none."""
    positions = compat.point_attribute(cloud, "position", "FLOAT_VECTOR", 3)
    if positions is None or not len(positions):
        return None
    radii = compat.point_attribute(cloud, "radius", "FLOAT", 1)
    if radii is None:
        radii = np.full((len(positions), 1), DEFAULT_RADIUS, np.float32)
    return PointData(name=name, positions=positions, radii=radii.reshape(-1))
