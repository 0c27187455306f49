"""What all textures have in common."""

from __future__ import annotations

from typing import Any

from .compiler import Compiler
from .nodes_coordinates import default_vector
from .values import Value

# Where a texture's own mapping, which no panel shows, leaves coordinates as they are.
_NO_MAPPING: dict[str, Any] = {
    "translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0),
    "scale": (1.0, 1.0, 1.0), "mapping_x": "X", "mapping_y": "Y", "mapping_z": "Z",
    "use_min": False, "use_max": False,
}  # fmt: skip


def texture_vector(compiler: Compiler, node: Any) -> Value:
    """The coordinates that a texture is looked up at."""
    mapping = getattr(node, "texture_mapping", None)
    for name, usual in _NO_MAPPING.items():
        value = getattr(mapping, name, usual)  # White Noise has no mapping
        value = tuple(value) if isinstance(usual, tuple) else value
        if value != usual:
            compiler.warn(node, "texture_mapping is not supported yet, left out")
            break
    socket = node.inputs["Vector"]
    return compiler.value(socket) if compiler.is_linked(socket) else default_vector(compiler, node)


def parameter(compiler: Compiler, node: Any, identifier: str, otherwise: float = 0.0) -> Value:
    """The value of an input by its identifier; `otherwise` where this Blender's node has none."""
    socket = next((s for s in node.inputs if s.identifier == identifier), None)
    return (otherwise,) if socket is None else compiler.value(socket)


def coordinates(compiler: Compiler, node: Any, dimensions: str) -> Value:
    """Four operands of an operation on "1D" to "4D" coordinates, times the node's scale if it has
    one; those that do not count are 0."""
    b = compiler.builder
    scale = parameter(compiler, node, "Scale", 1.0)
    place: Value = ()
    if dimensions != "1D":
        count = 2 if dimensions == "2D" else 3
        place = b.multiply(scale, texture_vector(compiler, node))[:count]
    if dimensions in {"1D", "4D"}:
        place += b.multiply(scale, parameter(compiler, node, "W"))
    return (*place, *(0.0,) * (4 - len(place)))
