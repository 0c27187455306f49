"""What all shapes have in common that change while the shutter is open."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene_data import FloatArray


class MovingShape:
    """`data` holds vertices, keys or points; those of other times become its motion."""

    data: Any  # MeshData, CurveData or PointData

    def take_velocity(self, reach: FloatArray, is_open: bool) -> None:
        """They have moved by `reach` [vertices, keys or points, 3] when the shutter closes, and by
        its opposite when it opens."""
        rest = self.data.positions
        self._set_positions(np.stack([rest - reach, rest + reach]), is_open)

    def _set_positions(self, positions: FloatArray, is_open: bool) -> None:
        if is_open:
            self.data.motion_positions = positions
        else:
            self.data.step_positions = positions
