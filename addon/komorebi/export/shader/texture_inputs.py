"""What all textures have in common."""

from __future__ import annotations

from typing import Any

from ..mapping import own_mapping
from .compiler import Compiler
from .nodes_coordinates import default_vector
from .values import Value


def texture_vector(compiler: Compiler, node: Any) -> Value:
    """The coordinates that a texture is looked up at."""
    b = compiler.builder
    socket = node.inputs.get("Vector")  # of skies, some models have none
    linked = socket is not None and compiler.is_linked(socket)
    place = compiler.value(socket) if linked else default_vector(compiler, node)
    mapping = own_mapping(node)
    if mapping is not None:
        place = b.op("transform", place, 3, numbers=tuple(map(float, mapping.ravel())))
        if node.texture_mapping.vector_type == "NORMAL":
            place = b.op("normalize", place, 3)
    return place


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
