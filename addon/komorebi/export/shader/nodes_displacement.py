"""Displacement as relief: surfaces stay where they are, and are lit as if they had moved."""

from __future__ import annotations

from typing import Any

from .compiler import Compiler, Outputs, node
from .nodes_coordinates import normal_input
from .values import Value

ONE: Value = (1.0,)


@node("DISPLACEMENT")
def displacement(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    height, middle, scale = compiler.inputs(node, "Height", "Midlevel", "Scale")
    raised = b.multiply(scale, b.subtract(height, middle))
    return {node.outputs[0].identifier: b.multiply(raised, normal_input(compiler, node))}


@node("VECTOR_DISPLACEMENT")
def vector_displacement(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    if node.space != "WORLD":
        compiler.warn(node, f"space {node.space} is taken as World")
    vector, middle, scale = compiler.inputs(node, "Vector", "Midlevel", "Scale")
    return {node.outputs[0].identifier: b.multiply(scale, b.subtract(vector[:3], middle))}


def relief(compiler: Compiler, socket: Any) -> Value | None:
    """The normal of a surface of which `socket` is the displacement; None where there is none.

    Cycles bumps by how far the displacement goes along the normal, here and a pixel aside.
    """
    if not compiler.is_linked(socket):
        return None
    b = compiler.builder
    normal = b.input("normal")
    with compiler.finest():
        heights = b.dot(compiler.value(socket), normal)
        for way in ("dx", "dy"):
            with compiler.shifted(way, ONE):
                heights += b.dot(compiler.value(socket), normal)
    place = normal + b.input("dx") + b.input("dy")
    return b.op("bump", place + heights + ONE + ONE + ONE, 3)
