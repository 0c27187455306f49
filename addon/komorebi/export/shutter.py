"""When the shutter is open: settings of motion blur → the times at which poses are taken."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from .. import compat

CURVE_SAMPLES = 256  # as many as Cycles takes
MAX_STEPS = 129  # Cycles' limit for objects
VECTOR_SHUTTER = 2.0  # frames: the pass Vector looks one frame back and one ahead
VECTOR_STEPS = 3


@dataclass(frozen=True, slots=True)
class Shutter:
    """The time that a frame is exposed for, in frames.

    Times in it are relative, −1 where it opens to 1 where it closes; poses are taken at an odd
    number of even ones (a power of two and one more), so that what has more shares those of what
    has fewer.
    """

    frame: int
    subframe: float
    position: float  # of the middle, from the frame on: 0 when that is centred
    duration: float
    is_open: bool  # else all is seen at the middle, and only the pass Vector asks how it moves
    numbers: dict[str, Any] | None  # as the core's set_camera takes them; None: open all the time

    def steps(self, original: Any, parent: Any | None = None) -> int:
        """How many poses an object has, `parent`'s settings as its instancer included; 0: one."""
        if not self.is_open:
            return VECTOR_STEPS
        steps = compat.motion_steps(original)
        if parent is not None and parent != original:
            of_parent = compat.motion_steps(parent)
            steps = max(steps, of_parent) if steps and of_parent else 0
        return min((2 << (steps - 1)) + 1, MAX_STEPS) if steps else 0

    def go_to(self, engine: Any, relative: float) -> None:
        """Evaluates the depsgraph of `engine` at a relative time."""
        offset = self.position + 0.5 * self.duration * relative
        time = self.frame + self.subframe + offset
        whole = math.floor(time)
        engine.frame_set(whole, time - whole)

    @contextmanager
    def at_middle(self, engine: Any) -> Iterator[None]:
        """Within, the depsgraph is where the shutter's middle is; `go_to` may take it elsewhere."""
        try:
            if self.position != 0.0:
                self.go_to(engine, 0.0)
            yield
        finally:
            engine.frame_set(self.frame, self.subframe)


def export_shutter(scene: Any, view_layer: Any, sources: Any) -> Shutter | None:
    """None where nothing has to be known of motion."""
    render = scene.render
    frame, subframe = scene.frame_current, scene.frame_subframe
    if render.use_motion_blur and view_layer.use_motion_blur:
        duration = render.motion_blur_shutter
        position = {"START": 0.5, "CENTER": 0.0, "END": -0.5}[compat.motion_blur_position(scene)]
        return Shutter(frame, subframe, position * duration, duration, True, _numbers(scene))
    if "Vector" in sources:
        return Shutter(frame, subframe, 0.0, VECTOR_SHUTTER, False, {"still": 1})
    return None


@cache
def times(steps: int) -> tuple[float, ...]:
    """The relative times of so many poses; asked for each instance."""
    return tuple(2.0 * step / (steps - 1) - 1.0 for step in range(steps))


def _numbers(scene: Any) -> dict[str, Any] | None:
    mapping = scene.render.motion_blur_shutter_curve
    mapping.initialize()
    curve = mapping.curves[0]
    at = np.linspace(0.0, 1.0, CURVE_SAMPLES)
    weights = np.array([max(0.0, mapping.evaluate(curve, t)) for t in at], np.float32)
    numbers: dict[str, Any] = {}
    if weights.max() > 0.0 and weights.min() < weights.max():  # a curve of zeros never opens
        numbers["curve"] = weights
    rolling = compat.rolling_shutter(scene)
    if rolling is not None:
        numbers["rolling_duration"] = rolling
    return numbers or None
