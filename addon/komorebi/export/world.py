"""Blender's world → one colour or one equirectangular map.

Understood: a Background (or Emission) whose colour is a colour or an Environment Texture, turned
by Mapping nodes. Everything else is named in a warning and rendered as the closest of these.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import compat, reporting
from ..scene_data import DoubleArray, WorldData
from . import nodes
from .image import export_image
from .mapping import mapping_matrix, nearest_rotation
from .names import name_of
from .sky import sky_color

Color = tuple[float, float, float]
BLACK: Color = (0.0, 0.0, 0.0)
EMITTERS = {"BACKGROUND", "EMISSION"}
COLOR_SOURCES = {"TEX_ENVIRONMENT", "TEX_SKY", "RGB"}


def export_world(engine: Any, world: Any | None) -> WorldData:
    """What a ray that hits nothing sees; no world at all is black."""
    if world is None:
        return WorldData()
    tree = compat.shader_nodes(world)
    if tree is None:
        return WorldData(color=_rgb(world.color))
    return _WorldReader(engine, world).read(tree)


def _rgb(value: Any) -> Color:
    return (float(value[0]), float(value[1]), float(value[2]))


def _times(color: Color, factor: float) -> Color:
    return (color[0] * factor, color[1] * factor, color[2] * factor)


class _WorldReader:
    """One walk through a world's nodes."""

    def __init__(self, engine: Any, world: Any) -> None:
        self._engine = engine
        self._world = name_of(world)

    def _warn(self, node: Any, what: str) -> None:
        sentence = f'world "{self._world}", node "{name_of(node)}" ({node.bl_label}): {what}'
        reporting.warn(self._engine, sentence)

    def read(self, tree: Any) -> WorldData:
        output = nodes.world_output(tree)
        if output is None:
            return WorldData()
        volume = nodes.source(output.inputs["Volume"])
        if volume is not None:
            self._warn(volume.node, "volumes are not rendered yet, the air is clear")
        surface = nodes.source(output.inputs["Surface"])
        if surface is None:
            return WorldData()
        emitter = self._emitter(surface.node)
        if emitter is None:
            return WorldData(color=(0.5, 0.5, 0.5))
        strength = self._number(emitter.inputs["Strength"])
        return self._color(emitter.inputs["Color"], strength)

    def _emitter(self, node: Any) -> Any | None:
        """The Background that `node` is, or is closest to."""
        if node.type in EMITTERS:
            return node
        # The first shader of a mix is what lights the scene when the second is for the camera.
        found = nodes.find_upstream(node, EMITTERS)
        if found is None:
            self._warn(node, "not supported yet and has no Background, rendered as grey 0.5")
        else:
            self._warn(node, f'not supported yet, rendered as its node "{name_of(found)}" alone')
        return found

    def _number(self, socket: Any) -> float:
        feeding = nodes.source(socket)
        if feeding is None:
            return float(socket.default_value)
        if feeding.node.type == "VALUE":
            return float(feeding.default_value)
        found = nodes.find_upstream(feeding.node, {"VALUE"})
        value = float(found.outputs[0].default_value if found else socket.default_value)
        self._warn(feeding.node, f"not supported yet as {socket.name}, rendered as {value:g}")
        return value

    def _color(self, socket: Any, strength: float) -> WorldData:
        feeding = nodes.source(socket)
        if feeding is None:
            return WorldData(color=_times(_rgb(socket.default_value), strength))
        node = feeding.node
        if node.type not in COLOR_SOURCES | {"VALUE"}:
            found = nodes.find_upstream(node, COLOR_SOURCES)
            if found is None:
                color = _default_color(node)
                shown = ", ".join(f"{c:.3g}" for c in color)
                self._warn(node, f"not supported yet, rendered as the even colour {shown}")
                return WorldData(color=_times(color, strength))
            self._warn(node, f'not supported yet, rendered as its input "{name_of(found)}" alone')
            node = found
        if node.type == "TEX_ENVIRONMENT":
            return self._environment(node, strength)
        if node.type == "TEX_SKY":
            color = sky_color(node)
            shown = ", ".join(f"{c:.3g}" for c in color)
            self._warn(
                node, f"not supported yet, rendered as the mean colour of such skies, {shown}"
            )
            return WorldData(color=_times(color, strength))
        value = node.outputs[0].default_value
        color = (value, value, value) if node.type == "VALUE" else _rgb(value)
        return WorldData(color=_times(color, strength))

    def _environment(self, node: Any, strength: float) -> WorldData:
        if node.projection != "EQUIRECTANGULAR":
            self._warn(node, "mirror balls are not supported yet, rendered as equirectangular")
        if node.interpolation != "Linear":
            self._warn(node, f"{node.interpolation} interpolation is rendered as Linear")
        old = node.texture_mapping
        matrix = mapping_matrix(old.vector_type, old.rotation, old.scale)
        matrix = matrix @ self._direction(node.inputs["Vector"])
        turn, exact = nearest_rotation(matrix)
        if not exact:
            self._warn(node, "an uneven scale is not supported yet, only its rotation is rendered")
        image = export_image(node, lambda what: self._warn(node, what))
        if image is None:
            return WorldData(color=_times((1.0, 0.0, 1.0), strength))
        return WorldData(image=image, strength=strength, texture_from_world=turn)

    def _direction(self, socket: Any) -> DoubleArray:
        """The matrix [3, 3] from a ray's world direction to what arrives at a vector socket."""
        feeding = nodes.source(socket)
        if feeding is None:
            return np.eye(3)
        node = feeding.node
        if node.type == "MAPPING":
            return self._mapping(node)
        if node.type == "TEX_COORD" and feeding.identifier == "Generated":
            return np.eye(3)
        if node.type == "TEX_COORD" and feeding.identifier == "Object" and node.object is None:
            return np.eye(3)
        if node.type == "NEW_GEOMETRY" and feeding.identifier == "Position":
            return np.eye(3)
        found = nodes.find_upstream(node, {"MAPPING"})
        if found is None:
            self._warn(node, f"{feeding.name} is not supported yet, rendered as Generated")
            return np.eye(3)
        self._warn(node, f'not supported yet, rendered as its input "{name_of(found)}" alone')
        return self._mapping(found)

    def _mapping(self, node: Any) -> DoubleArray:
        rotation, scale = node.inputs["Rotation"], node.inputs["Scale"]
        location = node.inputs.get("Location")
        for socket in (rotation, scale, location):
            if socket is not None and nodes.source(socket) is not None:
                self._warn(node, f"a linked {socket.name} is not supported yet, its value is used")
        shifts = location is not None and node.vector_type in {"POINT", "TEXTURE"}
        if shifts and any(location.default_value):
            self._warn(node, "its location is not supported yet, only its rotation is rendered")
        matrix = mapping_matrix(node.vector_type, rotation.default_value, scale.default_value)
        return matrix @ self._direction(node.inputs["Vector"])


def _default_color(node: Any) -> Color:
    """The mean of a node's colour inputs or colour ramp, else (or when that is black) grey 0.5."""
    if node.type == "VALTORGB":
        return _rgb(np.mean([e.color[:] for e in node.color_ramp.elements], axis=0))
    colors = [s.default_value[:] for s in node.inputs if s.type == "RGBA" and s.enabled]
    mean = _rgb(np.mean(colors, axis=0)) if colors else BLACK
    return mean if any(mean) else (0.5, 0.5, 0.5)
