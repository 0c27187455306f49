"""Short ways to build materials of nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

Tree = bpy.types.NodeTree


def add(tree: Tree, kind: str, inputs: dict[Any, Any] | None = None, **settings: Any) -> Any:
    """A new node `ShaderNode<kind>`; inputs by name or number are values or nodes' outputs."""
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in settings.items():
        setattr(node, name, value)
    for name, value in (inputs or {}).items():
        socket = node.inputs[name]
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        elif socket.type == "RGBA" and len(value) == 3:
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value
    return node


def material(name: str, build: Callable[[Tree], Any]) -> bpy.types.Material:
    """A material whose surface is the output socket that `build` makes in its empty tree."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(build(tree), output.inputs["Surface"])
    return made


def diffuse(tree: Tree, color: Any) -> Any:
    """Matt, of a colour or of what an output gives."""
    return add(tree, "BsdfDiffuse", {"Color": color}).outputs[0]


def mix(tree: Tree, factor: Any, first: Any, second: Any) -> Any:
    """A mix of two shaders."""
    return add(tree, "MixShader", {0: factor, 1: first, 2: second}).outputs[0]


def picture(name: str, size: int, color: Callable[[float, float], Any]) -> bpy.types.Image:
    """A packed square picture of bytes; `color` gives four numbers at column and row, 0 to 1."""
    image = bpy.data.images.new(name, size, size, alpha=True)
    pixels: list[float] = []
    for row in range(size):
        for column in range(size):
            pixels += color((column + 0.5) / size, (row + 0.5) / size)
    image.pixels.foreach_set(pixels)
    image.pack()
    return image
