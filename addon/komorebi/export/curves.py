"""Hair curves (objects of type CURVES, or what geometry nodes make) → CurveData.

As in Cycles, a curve of any type is drawn through its control points, poly curves straight from one
to the next (from 5.0).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import compat
from ..scene_data import CurveData

DEFAULT_RADIUS = 0.005  # of points without the attribute, as in Cycles


def export_curves(curves: Any, name: str, scene: Any, uvs: bool) -> CurveData | None:
    """The keys of evaluated Curves data, with `uvs` also those; None when it has none."""
    positions = compat.point_attribute(curves, "position", "FLOAT_VECTOR", 3)
    if positions is None or not len(positions):
        return None
    radii = compat.point_attribute(curves, "radius", "FLOAT", 1)
    if radii is None:
        radii = np.full((len(positions), 1), DEFAULT_RADIUS, np.float32)
    shape, subdivisions = compat.curve_shape(scene)
    if compat.are_linear(curves):
        shape = "THICK_LINEAR"
    return CurveData(
        name=name,
        positions=positions,
        radii=radii.reshape(-1),
        curve_offsets=compat.curve_offsets(curves),
        shape=shape,
        subdivisions=subdivisions,
        curve_uvs=compat.curve_uvs(curves) if uvs else None,
    )
