"""Hair, hair curves and points that change their shape while the shutter is open."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import core, mesh_cache
from ..scene_data import CurveData, PointData
from .moving_shape import MovingShape

Keys = CurveData | PointData

# Metres, as in Cycles: on the way to the object's space and back, hair that stands still comes out
# slightly different at each time.
STILL = 1e-5


class MovingKeys(MovingShape):
    """Curves or points as they are at rest and at the other times."""

    changed = "the number of its strands or points changes"

    def __init__(
        self, data: Keys, times: list[float], read: Callable[[Any, bool], Keys | None]
    ) -> None:
        self.data = data
        self.times = times
        self.seen: dict[float, Keys] = {}
        self._read = read

    def record(self, obj: Any, time: float, restless: bool) -> bool:
        """Takes the keys as an evaluated object has them now; False if they are no longer the
        same ones. `restless`: what they grow on has moved."""
        keys = self._read(obj, restless)
        if keys is None or not _same_strands(self.data, keys):
            return False
        self.seen[time] = keys
        return True

    def take_seen(self, is_open: bool) -> None:
        """What was seen becomes motion, if there is any."""
        seen = [self.seen[time] for time in self.times]
        if not any(differ(self.data, keys) for keys in seen):
            return
        self._set_positions(np.stack([keys.positions for keys in seen]), is_open)
        radii = np.stack([keys.radii for keys in seen])
        # They are worked out anew at each time, and round otherwise.
        if is_open and not np.allclose(radii, self.data.radii, rtol=1e-4, atol=0.0):
            self.data.motion_radii = radii

    def set_key(self) -> None:
        self.data.key = mesh_cache.round_key(core.load(), self.data)


def differ(rest: Keys, other: Keys) -> bool:
    """Whether keys are others, or elsewhere by more than STILL, or of another radius."""
    if not _same_strands(rest, other):
        return True
    apart = np.square(other.positions - rest.positions).sum(axis=1)
    apart += np.square(other.radii - rest.radii)
    return bool((apart > STILL * STILL).any())


def _same_strands(rest: Keys, other: Keys) -> bool:
    if rest.positions.shape != other.positions.shape:
        return False
    if isinstance(rest, CurveData) and isinstance(other, CurveData):
        return np.array_equal(rest.curve_offsets, other.curve_offsets)
    return True
