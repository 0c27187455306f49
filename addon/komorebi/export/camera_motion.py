"""How a camera moves while the shutter is open: its pose, and the zoom of a perspective lens."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene_data import CameraData, DoubleArray
from .camera import camera_object, camera_pose, export_camera, read_lens
from .shutter import Shutter, times


class CameraMotion:
    """Follows the camera of one view. All but pose and zoom stays as at rest, as in Cycles."""

    def __init__(self, engine: Any, depsgraph: Any, view: str, shutter: Shutter | None) -> None:
        self._engine, self._depsgraph, self._view = engine, depsgraph, view
        self.data: CameraData = export_camera(engine, depsgraph, view)
        self.times: tuple[float, ...] = ()
        if shutter is None:
            return
        # A marker within the shutter's time may bind another camera: the one at rest stays.
        self._camera = camera_object(engine, depsgraph).original
        self._poses: dict[float, DoubleArray] = {}
        self._wideness: dict[float, float] = {}
        self.data.shutter = shutter.numbers
        steps = shutter.steps(self._camera)
        if steps:
            self.times = times(steps)
            self.record(0.0)

    def record(self, time: float) -> None:
        """Takes pose and lens as they are now, at a relative time."""
        if time not in self.times:
            return
        if self._view:
            self._engine.active_view_set(self._view)
        camera = self._camera.evaluated_get(self._depsgraph)
        self._poses[time] = camera_pose(self._engine, camera, self._view)
        lens = read_lens(camera)
        if lens.kind == "PERSP":
            self._wideness[time] = lens.sensor / lens.focal_length

    def finish(self) -> CameraData:
        if not self.times:
            return self.data
        matrices = np.array([self._poses[time] for time in self.times])
        rest = self._wideness.get(0.0, 1.0)
        zooms = [self._wideness.get(time, rest) / rest for time in (-1.0, 1.0)]
        if (matrices != matrices[0]).any() or zooms != [1.0, 1.0]:
            self.data.motion = {
                "matrices": matrices, "zoom_open": zooms[0], "zoom_close": zooms[1],
            }  # fmt: skip
        return self.data
