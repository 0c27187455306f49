"""Where Cycles up to 3.x bends shading normals, so that its picture is not the integral it should
be.

Its closures, diffuse ones too, move the shading normal wherever the mirrored view direction would
dip under the surface (`ensure_valid_reflection`): at the far rims of smooth, coarse meshes.
Releases from 4.0 on do so for glossy closures alone. The pixels concerned are found by rendering
the condition.
"""

from __future__ import annotations

from typing import Any

import bpy

from compare.inside.settle import settle
from compare.inside.world import uniform_world

FIRST_RELEASE_WITHOUT = (4, 0, 0)


def needed(engine: str, flat: bool) -> bool:
    """Whether this Blender's Cycles bends normals that the clay uses."""
    return engine == "CYCLES" and not flat and bpy.app.version < FIRST_RELEASE_WITHOUT


def material() -> Any:
    """Emits 1 where the normal N is bent: R·Ng < min(0.9 I·Ng, 0.01), R = 2 (N·I) N − I, else 0."""
    made = bpy.data.materials.new("compare bent")
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    geometry = tree.nodes.new("ShaderNodeNewGeometry").outputs

    def dot(a: str, b: str) -> Any:
        node = tree.nodes.new("ShaderNodeVectorMath")
        node.operation = "DOT_PRODUCT"
        tree.links.new(geometry[a], node.inputs[0])
        tree.links.new(geometry[b], node.inputs[1])
        return node.outputs["Value"]

    def math(operation: str, a: Any, b: Any) -> Any:
        node = tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, (a, b), strict=False):
            if isinstance(value, float):
                socket.default_value = value
            else:
                tree.links.new(value, socket)
        return node.outputs["Value"]

    view = dot("Incoming", "True Normal")
    mirrored = math("MULTIPLY", dot("Normal", "Incoming"), dot("Normal", "True Normal"))
    height = math("SUBTRACT", math("MULTIPLY", mirrored, 2.0), view)
    limit = math("MINIMUM", math("MULTIPLY", view, 0.9), 0.01)
    emission, output = (
        tree.nodes.new("ShaderNodeEmission"),
        tree.nodes.new("ShaderNodeOutputMaterial"),
    )
    tree.links.new(math("LESS_THAN", height, limit), emission.inputs["Strength"])
    tree.links.new(emission.outputs["Emission"], output.inputs["Surface"])
    return made


def show(scene: Any, layer: Any) -> None:
    """Turn the prepared scene into a picture of the condition: positive where a normal is bent."""
    layer.material_override = material()
    uniform_world(scene, (0.0, 0.0, 0.0))
    settle(scene.cycles, "samples", 32)
