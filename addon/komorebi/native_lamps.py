"""LampData with nodes → lamps of a colour and a falloff, as the core has them. No bpy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from .native_programs import Programs
from .scene_data import DoubleArray, FloatArray, LampData

# Inputs of a program that differ over a lamp, and how wide they are.
PLACES = {
    "position": 3, "normal": 3, "true_normal": 3, "incoming": 3, "object_point": 3,
    "object_normal": 3, "parametric": 3, "tangent": 3,
}  # fmt: skip
TRIES = 64
FAR = 1e6  # metres: from there on a smooth falloff is as one without
CHECKED = np.array([0.1, 0.5, 1.0, 2.0, 10.0, 100.0])  # metres
DISTANT = {"SUN", "TANGENT_SUN", "DIRECTION"}


def load(lamps: list[LampData], programs: Programs, warnings: list[str]) -> list[LampData]:
    """The lamps that shine; `warnings` gets sentences on what is rendered as something simpler."""
    resolved = [_resolve(lamp, programs, warnings) for lamp in lamps]
    return [lamp for lamp in resolved if lamp.radiance.any()]


def _resolve(lamp: LampData, programs: Programs, warnings: list[str]) -> LampData:
    if lamp.program is None:
        return lamp
    program = programs.program(lamp.program)
    constants = program.constants
    if None not in constants:
        return replace(lamp, radiance=lamp.radiance * np.array(constants), program=None)
    if _varies(program):
        warnings.append(lamp.uneven)
    places = {name: np.zeros((1, width)) for name, width in PLACES.items()}
    places["position"][0] = lamp.matrix[:3, 3]
    for name in ("normal", "true_normal", "incoming", "object_normal"):
        places[name][0] = -lamp.matrix[:3, 2]

    def light_at(distances: DoubleArray) -> DoubleArray:
        return _evaluate(program, distances, places)

    factor, power, smooth = _falloff(light_at, lamp, warnings)
    sizes = dict(lamp.sizes)
    if lamp.kind not in DISTANT:  # as in Cycles, to which these are too far away for it
        sizes |= {"falloff_power": power, "falloff_smooth": smooth}
    return replace(lamp, radiance=lamp.radiance * factor, sizes=sizes, program=None)


def _evaluate(
    program: Any,
    distances: DoubleArray,
    places: dict[str, DoubleArray],
    attributes: dict[str, FloatArray] | None = None,
) -> DoubleArray:
    """The program's light [count, 3] for rays that are so long."""
    count = len(distances)
    inputs = {
        name: np.ascontiguousarray(np.broadcast_to(v, (count, v.shape[1])), np.float32)
        for name, v in {**places, "ray_length": distances[:, None]}.items()
    }
    light: DoubleArray = program.evaluate(count, inputs, attributes or {}).astype(np.float64)
    return light


def _varies(program: Any) -> bool:
    """Whether places differ, by trial."""
    random = np.random.default_rng(1)
    places = {name: random.uniform(-1.0, 1.0, (TRIES, width)) for name, width in PLACES.items()}
    attributes = {
        name: random.uniform(-1.0, 1.0, (TRIES, 4)).astype(np.float32)
        for name in program.attributes
    }
    light = _evaluate(program, np.ones(TRIES), places, attributes)
    return not np.array_equal(light, np.broadcast_to(light[0], light.shape))


def _falloff(
    light_at: Callable[[DoubleArray], DoubleArray], lamp: LampData, warnings: list[str]
) -> tuple[DoubleArray, float, float]:
    """The light as color · d^power · d² / (d² + smooth), which Light Falloff makes of it."""
    far, further, near = light_at(np.array([FAR, 2.0 * FAR, 1.0]))
    c = int(np.argmax(np.abs(far)))
    if far[c] == 0.0:
        return near, 0.0, 0.0
    power = float(np.clip(np.round(np.log2(max(further[c] / far[c], 1.0))), 0.0, 2.0))
    color = far / FAR**power
    smooth = 0.0
    for d in (1.0, 0.0):  # roughly, then where it tells most
        d = d or max(smooth, 1e-12) ** 0.5
        seen = light_at(np.array([d]))[0][c]
        smooth = d * d * max(color[c] * d**power / seen - 1.0, 0.0) if seen != 0.0 else 0.0
    if smooth < 1e-5:
        smooth = 0.0
    checked = CHECKED[:, None]
    expected = color * checked**power * checked**2 / (checked**2 + smooth)
    if not np.allclose(light_at(CHECKED), expected, rtol=1e-3, atol=1e-5 * np.abs(near).max()):
        assert lamp.program is not None
        warnings.append(
            f"{lamp.program.name}: its nodes let the light fall off in a way that is not supported "
            "yet, it is rendered as quadratic"
        )
        return near, 0.0, 0.0
    return color, power, smooth
