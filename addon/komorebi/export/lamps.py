"""Blender's lights → lamps as radiance (`scene_data.LampData`), converted as this release's Cycles
does it (its scene/light.cpp and kernel/light/, 3.4 and 4.2 to 5.x)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .. import compat, reporting
from ..scene_data import DoubleArray, LampData
from . import nodes
from .names import name_of
from .walk import Subject, object_of

Color = tuple[float, float, float]
MOST_ANGLE = math.pi - 1e-7  # of a sun by the tangent of its half
LEAST_SPREAD = math.radians(1.0)  # Cycles 3.x


class LampExporter:
    """Collects the lamps of one depsgraph's instances into `lamps`."""

    def __init__(self, engine: Any, lamps: list[LampData]) -> None:
        self._engine = engine
        self._lamps = lamps
        self._known: dict[int, tuple[Any, Color]] = {}  # data and strength, by Subject.address

    def take(self, instance: Any, subject: Subject) -> None:
        """Adds the lamp that an instance is, unless it gives no light."""
        original = subject.original
        known = self._known.get(subject.address)
        if known is None:
            known = self._known[subject.address] = self._read(object_of(instance).data, original)
        light, strength = known
        if not any(strength):
            return
        matrix = np.array(instance.matrix_world, np.float64)
        lamp = _lamp(light, strength, matrix)
        if lamp is None:
            return
        lamp.name = name_of(original)
        lamp.casts_shadow = compat.casts_shadow(light)
        lamp.lights_catchers = bool(original.is_shadow_catcher)
        self._lamps.append(lamp)

    def _read(self, light: Any, original: Any) -> tuple[Any, Color]:
        if not original.visible_diffuse or _is_portal(light):
            return light, (0.0, 0.0, 0.0)
        self._warn_object(original, light)
        return light, self._strength_of(light)

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

    def _strength_of(self, light: Any) -> Color:
        energy = light.energy * compat.light_factor(light)
        tint = compat.light_tint(light)
        emitted = self._emission(light)
        return tuple(  # type: ignore[return-value]
            float(light.color[c] * tint[c] * energy * emitted[c]) for c in range(3)
        )

    def _emission(self, light: Any) -> Color:
        """What a light's nodes make of its power, a factor."""
        tree = compat.shader_nodes(light)
        if tree is None:
            return (1.0, 1.0, 1.0)
        output = nodes.light_output(tree)
        surface = None if output is None else nodes.source(output.inputs["Surface"])
        if surface is None:
            return (0.0, 0.0, 0.0)
        node = surface.node
        if node.type != "EMISSION":
            found = nodes.find_upstream(node, {"EMISSION"})
            if found is None:
                self._warn(light, node, "not supported yet and has no Emission, rendered without")
                return (1.0, 1.0, 1.0)
            self._warn(light, node, f'not supported yet, rendered as its "{name_of(found)}" alone')
            node = found
        color = self._constant(light, node.inputs["Color"])
        strength = self._constant(light, node.inputs["Strength"])[0]
        return (color[0] * strength, color[1] * strength, color[2] * strength)

    def _constant(self, light: Any, socket: Any) -> Color:
        feeding = nodes.source(socket)
        if feeding is None:
            return _color(socket.default_value)
        node = feeding.node
        if node.type in {"VALUE", "RGB"}:
            return _color(feeding.default_value)
        if node.type == "LIGHT_FALLOFF":
            return self._falloff(light, feeding)
        value = _color(socket.default_value)
        self._warn(light, node, f"not supported yet as {socket.name}, its own value is rendered")
        return value

    def _falloff(self, light: Any, output: Any) -> Color:
        """Quadratic is what light does anyway; the others would need the distance."""
        node = output.node
        strength, smooth = node.inputs["Strength"], node.inputs["Smooth"]
        if output.name != "Quadratic":
            self._warn(light, node, f"{output.name} falloff is not supported yet, but Quadratic")
        if nodes.source(smooth) is not None or smooth.default_value > 0.0:
            self._warn(light, node, "Smooth is not supported yet")
        return self._constant(light, strength)

    def _warn(self, light: Any, node: Any, what: str) -> None:
        sentence = f'light "{name_of(light)}", node "{name_of(node)}" ({node.bl_label}): {what}'
        reporting.warn(self._engine, sentence)


def _color(value: Any) -> Color:
    if isinstance(value, float | int):
        return (float(value), float(value), float(value))
    return (float(value[0]), float(value[1]), float(value[2]))


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
