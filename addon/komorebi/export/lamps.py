"""Blender's lights → lamps as radiance (`scene_data.LampData`), converted as this release's Cycles
does it (its scene/light.cpp and kernel/light/, 3.4 and 4.2 to 5.x)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import compat, reporting
from ..scene_data import DoubleArray, LampData, ProgramData
from . import nodes
from .names import name_of
from .shader import Compiler, Ray
from .shader.closures import total
from .walk import Subject, object_of

Color = tuple[float, float, float]
MOST_ANGLE = math.pi - 1e-7  # of a sun by the tangent of its half
LEAST_SPREAD = math.radians(1.0)  # Cycles 3.x

BLACK: Color = (0.0, 0.0, 0.0)
# Nodes that differ from place to place.
VARYING = {
    "TEX_IMAGE", "TEX_ENVIRONMENT", "TEX_CHECKER", "TEX_BRICK", "TEX_GRADIENT", "TEX_MAGIC",
    "TEX_MUSGRAVE", "TEX_NOISE", "TEX_VORONOI", "TEX_WAVE", "TEX_WHITE_NOISE", "TEX_SKY",
    "TEX_COORD", "UVMAP", "ATTRIBUTE", "VERTEX_COLOR", "NEW_GEOMETRY", "LAYER_WEIGHT", "FRESNEL",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Emission:
    """The light of a lamp's data: power times colour, times what a program gives."""

    strength: Color
    program: ProgramData | None = None
    uneven: str = ""  # LampData.uneven


class LampExporter:
    """Collects the lamps of one depsgraph's instances into `lamps`."""

    def __init__(self, engine: Any, lamps: list[LampData]) -> None:
        self._engine = engine
        self._lamps = lamps
        self._known: dict[int, tuple[Any, Emission]] = {}  # with the data, by Subject.address

    def take(self, instance: Any, subject: Subject) -> None:
        """Adds the lamp that an instance is, unless it gives no light."""
        original = subject.original
        known = self._known.get(subject.address)
        if known is None:
            known = self._known[subject.address] = self._read(object_of(instance).data, original)
        light, emission = known
        if not any(emission.strength):
            return
        matrix = np.array(instance.matrix_world, np.float64, order="C")
        lamp = _lamp(light, emission.strength, matrix)
        if lamp is None:
            return
        lamp.program, lamp.uneven = emission.program, emission.uneven
        lamp.sizes["max_bounces"] = float(compat.max_bounces(light))
        lamp.name = name_of(original)
        lamp.casts_shadow = compat.casts_shadow(light)
        lamp.lights_catchers = bool(original.is_shadow_catcher)
        self._lamps.append(lamp)

    def _read(self, light: Any, original: Any) -> tuple[Any, Emission]:
        if not original.visible_diffuse or _is_portal(light):
            return light, Emission(BLACK)
        self._warn_object(original, light)
        return light, self._nodes(light, self._strength_of(light))

    def _warn_object(self, original: Any, light: Any) -> None:
        name = name_of(original)
        has_size = light.type in {"AREA", "SUN"} or light.shadow_soft_size > 0.0
        if original.visible_camera and has_size:
            reporting.warn(
                self._engine, f'light "{name}": the camera sees no lamps yet, its light is rendered'
            )
        for what in compat.light_links(original):
            reporting.warn(
                self._engine, f'light "{name}": {what} is not supported yet, all objects count'
            )

    @staticmethod
    def _strength_of(light: Any) -> Color:
        energy = light.energy * compat.light_factor(light)
        tint = compat.light_tint(light)
        return tuple(  # type: ignore[return-value]
            float(light.color[c] * tint[c] * energy) for c in range(3)
        )

    def _nodes(self, light: Any, strength: Color) -> Emission:
        """What a light's nodes make of its power."""
        tree = compat.shader_nodes(light)
        if tree is None:
            return Emission(strength)
        output = nodes.light_output(tree)
        if output is None:
            return Emission(BLACK)
        compiler = Compiler(self._engine, f'light "{name_of(light)}"', Ray("LIGHT"))
        surface = output.inputs["Surface"]
        shines = total(compiler.builder, compiler.closures(surface), "EMISSION")
        constant = [value for value in shines if isinstance(value, float)]
        if len(constant) == 3:
            return Emission(tuple(s * c for s, c in zip(strength, constant, strict=True)))  # type: ignore[arg-type]
        program = ProgramData(compiler.owner, compiler.builder.ops, shines)
        return Emission(strength, program, self._uneven(compiler.owner, surface))

    @staticmethod
    def _uneven(owner: str, surface: Any) -> str:
        """What is said where the nodes' light turns out to vary over the lamp."""
        feeding = nodes.source(surface)
        found = feeding and nodes.find_upstream(feeding.node, VARYING)
        where = f', node "{name_of(found)}" ({found.bl_label})' if found else ""
        return f"{owner}{where}: what varies over a light is not supported yet, its middle counts"


def _is_portal(light: Any) -> bool:
    """An area that only shows Cycles where the sky is."""
    settings = compat.cycles_or(light, None)
    return light.type == "AREA" and settings is not None and bool(settings.is_portal)


def _lamp(light: Any, strength: Color, matrix: DoubleArray) -> LampData | None:
    if light.type != "POINT" and not abs(np.linalg.det(matrix[:3, :3])) > 0.0:
        return None  # scaled away: it points nowhere
    make = {"SUN": _sun, "AREA": _area}.get(light.type, _ball)
    return make(light, strength, matrix)


def _data(
    kind: str, strength: Color, factor: float, matrix: DoubleArray, **sizes: float
) -> LampData:
    return LampData("", kind, np.array(strength, np.float64) * factor, matrix, dict(sizes))


def _sun(light: Any, strength: Color, matrix: DoubleArray) -> LampData:
    angle = float(light.angle)
    if not angle > 0.0:
        return _data("DIRECTION", strength, 1.0, matrix)
    if compat.OLD_LAMPS:
        angle = min(angle, MOST_ANGLE)
        factor = 1.0 / (math.pi * math.tan(0.5 * angle) ** 2)
        return _data("TANGENT_SUN", strength, factor, matrix, angle=angle)
    angle = min(angle, math.pi)
    factor = 1.0 / (math.pi * math.sin(0.5 * angle) ** 2) if compat.normalizes(light) else 1.0
    return _data("SUN", strength, factor, matrix, angle=angle)


def _ball(light: Any, strength: Color, matrix: DoubleArray) -> LampData:
    """A point or spot."""
    radius = float(light.shadow_soft_size)
    kind, factor, sizes = "POINT", 1.0 / (4.0 * math.pi), {}
    if radius > 0.0:
        kind = "DISK" if compat.is_soft(light) else "SPHERE"
        spread_over = 4.0 * math.pi * radius**2 if compat.normalizes(light) else 1.0
        factor = 1.0 / (math.pi * spread_over)
        sizes["radius"] = radius
    if light.type == "SPOT":
        sizes["spot_angle"] = min(float(light.spot_size), math.pi)
        sizes["spot_blend"] = float(light.spot_blend)
        if compat.OLD_LAMPS:
            matrix = _unstretched(matrix)
    data = _data(kind, strength, factor, matrix, **sizes)
    data.spot_scales_by_cosine = light.type == "SPOT" and compat.OLD_LAMPS
    return data


def _area(light: Any, strength: Color, matrix: DoubleArray) -> LampData | None:
    u = float(light.size)
    v = float(light.size_y) if light.shape in {"RECTANGLE", "ELLIPSE"} else u
    is_round = light.shape in {"DISK", "ELLIPSE"}
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    area = u * v * lengths[0] * lengths[1] * (0.25 * math.pi if is_round else 1.0)
    if not area > 0.0:
        return None
    spread = min(float(light.spread), math.pi)
    if compat.OLD_LAMPS:
        factor, spread = 0.25 / area, max(spread, LEAST_SPREAD)
    else:
        factor = 1.0 / (math.pi * area) if compat.normalizes(light) else 1.0 / math.pi
    kind = "ELLIPSE" if is_round else "RECTANGLE"
    return _data(kind, strength, factor, matrix, size_u=u, size_v=v, spread=max(spread, 0.0))


def _unstretched(matrix: DoubleArray) -> DoubleArray:
    """The same place and −z, without scale and shear: Cycles 3.x has round cones only."""
    result = np.eye(4)
    result[:3, 3] = matrix[:3, 3]
    z = matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    result[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    return result
