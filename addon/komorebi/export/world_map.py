"""A world that is one equirectangular picture, turned: what the core samples exactly as it is."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene_data import DoubleArray, WorldData
from . import nodes
from .image import can_be_map, export_image
from .mapping import mapping_matrix, nearest_rotation, own_mapping
from .shader import Compiler

EMITTERS = {"BACKGROUND", "EMISSION"}


def read_map(compiler: Compiler, surface: Any) -> WorldData | None:
    """The map that the socket `surface` of a World Output shows to the compiler's kind of ray, or
    None when it is anything else. RenderError when its file is missing."""
    emitter = _emitter(compiler, surface)
    if emitter is None:
        return None
    strength = _number(emitter.inputs["Strength"])
    feeding = nodes.source(emitter.inputs["Color"])
    if strength is None or strength < 0.0 or feeding is None:
        return None
    node = feeding.node
    if node.type != "TEX_ENVIRONMENT" or node.image is None or not can_be_map(node.image):
        return None
    if node.projection != "EQUIRECTANGULAR" or node.interpolation != "Linear":
        return None
    direction = _direction(node.inputs["Vector"])
    if direction is None:
        return None
    own = own_mapping(node)
    if own is not None and own[:, 3].any():
        return None
    turn, exact = nearest_rotation(direction if own is None else own[:, :3] @ direction)
    if not exact:
        return None
    image = export_image(node, lambda what: compiler.warn(node, what))
    if image is None:
        return None
    return WorldData(image=image, strength=strength, texture_from_world=turn)


def _emitter(compiler: Compiler, socket: Any) -> Any | None:
    """The Background that alone reaches the socket: mixes may leave one out for this ray."""
    for _ in range(nodes.MAX_STEPS):
        feeding = nodes.source(socket)
        if feeding is None:
            return None
        node = feeding.node
        if node.type in EMITTERS:
            return node
        if node.type != "MIX_SHADER":
            return None
        (factor,) = compiler.value(node.inputs[0])
        if isinstance(factor, tuple) or 0.0 < factor < 1.0:
            return None
        socket = node.inputs[2 if factor >= 1.0 else 1]
    return None


def _number(socket: Any) -> float | None:
    feeding = nodes.source(socket)
    if feeding is None:
        return float(socket.default_value)
    return float(feeding.default_value) if feeding.node.type == "VALUE" else None


def _direction(socket: Any) -> DoubleArray | None:
    """The matrix [3, 3] from a ray's world direction to what arrives at a vector socket."""
    feeding = nodes.source(socket)
    if feeding is None:
        return np.eye(3)
    node = feeding.node
    if node.type == "MAPPING":
        return _mapping(node)
    if node.type == "TEX_COORD" and feeding.identifier == "Generated":
        return np.eye(3)
    if node.type == "TEX_COORD" and feeding.identifier == "Object" and node.object is None:
        return np.eye(3)
    if node.type == "NEW_GEOMETRY" and feeding.identifier == "Position":
        return np.eye(3)
    return None


def _mapping(node: Any) -> DoubleArray | None:
    rotation, scale = node.inputs["Rotation"], node.inputs["Scale"]
    location = node.inputs.get("Location")
    if any(s is not None and nodes.source(s) is not None for s in (rotation, scale, location)):
        return None
    shifts = location is not None and node.vector_type in {"POINT", "TEXTURE"}
    if shifts and any(location.default_value):
        return None
    direction = _direction(node.inputs["Vector"])
    if direction is None:
        return None
    return mapping_matrix(node.vector_type, rotation.default_value, scale.default_value) @ direction
