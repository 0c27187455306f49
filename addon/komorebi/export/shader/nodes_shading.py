"""Nodes of how a surface is looked at and where its normal points, and what stands in for those
that need rays or particles."""

from __future__ import annotations

from typing import Any

from ... import compat
from .closures import BLACK
from .compiler import Compiler, Outputs, node
from .nodes_coordinates import attribute, axes, normal_input
from .values import Builder, Value

ONE: Value = (1.0,)


def _cosine(compiler: Compiler, node: Any) -> Value:
    return compiler.builder.dot(compiler.builder.input("incoming"), normal_input(compiler, node))


def _across(b: Builder, ior: Value, *, inverted: bool) -> Value:
    """The index of refraction as a ray meets it, that comes from inside where it meets the back."""
    outside, inside = ior, b.each("divide", ONE, ior)
    if inverted:
        outside, inside = inside, outside
    return b.mix(b.input("backfacing", 1), outside, inside)


@node("FRESNEL")
def fresnel(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    ior = b.each("maximum", compiler.value(node.inputs["IOR"]), (1e-5,))
    eta = _across(b, ior, inverted=False)
    return {node.outputs[0].identifier: b.each("fresnel", _cosine(compiler, node), eta)}


@node("LAYER_WEIGHT")
def layer_weight(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    blend = compiler.value(node.inputs["Blend"])
    cosine = _cosine(compiler, node)
    eta = b.each("maximum", b.subtract(ONE, blend), (1e-5,))
    return {
        "Fresnel": b.each("fresnel", cosine, _across(b, eta, inverted=True)),
        "Facing": b.each("facing", cosine, blend),
    }


@node("LIGHT_FALLOFF")
def light_falloff(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    strength, smooth = (compiler.value(s) for s in node.inputs)
    distance = b.input("ray_length", 1)
    square = b.multiply(distance, distance)
    softened = b.each("divide", square, b.add(square, smooth))
    strength = b.multiply(strength, b.mix(b.each("greater_than", smooth, (0.0,)), ONE, softened))
    return {
        "Quadratic": strength,
        "Linear": b.multiply(strength, distance),
        "Constant": b.multiply(strength, square),
    }


def _side(b: Builder) -> Value:
    """1 where the ray meets the front, −1 at the back."""
    return b.each("multiply_add", b.input("backfacing", 1), (-2.0,), ONE)


def _leaning(b: Builder, own: Value, mapped: Value, strength: Value) -> Value:
    """A normal between the surface's own and the mapped one, or beyond."""
    turn = b.each("maximum", strength, (0.0,))
    return b.op("normalize", b.mix(turn, own, mapped), 3)


@node("NORMAL_MAP")
def normal_map(compiler: Compiler, node: Any) -> Outputs:
    b, space = compiler.builder, node.space
    strength = compiler.value(node.inputs["Strength"])
    with compiler.finest():  # the mean of normals is no normal
        color = compiler.value(node.inputs["Color"])
    own = b.input("normal")
    parts = b.each("multiply_add", color, (2.0,), (-1.0,))
    x, y, z = parts[:1], parts[1:2], parts[2:]
    if compiler.is_world:
        return {node.outputs[0].identifier: own}
    if space == "TANGENT":
        frame = attribute(compiler, f"tangent:{node.uv_map}")
        # of the front, whichever side is seen
        normal = b.multiply(_side(b), b.input("object_normal"))
        tangent, sign = frame[:3], frame[3:]
        bitangent = b.multiply(sign, b.op("cross_product", normal + tangent, 3))
        if not compat.FLAT_NORMAL_MAPS:
            x, y = b.multiply(x, strength), b.multiply(y, strength)
            z = b.mix(b.clamp01(strength), ONE, z)
        mapped = b.add(
            b.add(b.multiply(x, tangent), b.multiply(y, bitangent)), b.multiply(z, normal)
        )
        # where there is no tangent, there is no map
        known = b.op("length", tangent)
        mapped = b.op("normal_from_axes", mapped + axes(compiler), 3)
        mapped = b.multiply(_side(b), b.op("normalize", mapped, 3))
        mapped = b.multiply(b.each("greater_than", known, (0.0,)), mapped)
        if compat.FLAT_NORMAL_MAPS:
            mapped = _leaning(b, own, mapped, strength)
    else:
        if space.startswith("BLENDER_"):
            y, z = b.multiply(y, (-1.0,)), b.multiply(z, (-1.0,))
        mapped = x + y + z
        if space.endswith("OBJECT"):
            mapped = b.op("normal_from_axes", mapped + axes(compiler), 3)
        mapped = b.multiply(_side(b), b.op("normalize", mapped, 3))
        mapped = _leaning(b, own, mapped, strength)
    return {node.outputs[0].identifier: b.op("or_normal", mapped + own, 3)}


@node("BUMP")
def bump(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    normal, height = normal_input(compiler, node), node.inputs["Height"]
    if not compiler.is_linked(height) or compiler.is_world:
        return {node.outputs[0].identifier: normal}
    strength, distance = compiler.inputs(node, "Strength", "Distance")
    has_width = "Filter Width" in node.inputs
    width = compiler.value(node.inputs["Filter Width"]) if has_width else ONE
    if node.invert:
        distance = b.multiply(distance, (-1.0,))
    with compiler.finest():
        heights = compiler.value(height)
        for way in ("dx", "dy"):
            with compiler.shifted(way, width):
                heights += compiler.value(height)
    place = normal + b.input("dx") + b.input("dy")
    raised = b.op("bump", place + heights + distance + strength + width, 3)
    return {node.outputs[0].identifier: raised}


@node("TANGENT")
def tangent(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    if node.direction_type == "UV_MAP":
        along = attribute(compiler, f"tangent:{node.uv_map}")[:3]
    else:
        x, y, z = ((c,) for c in b.subtract(attribute(compiler, "generated")[:3], (0.5,)))
        less_y, less_z = (b.multiply(v, (-1.0,)) for v in (y, z))
        zero: Value = (0.0,)
        ways = {"X": zero + less_z + y, "Y": less_z + zero + x, "Z": less_y + x + zero}
        along = ways[node.axis]
    normal = b.input("normal")
    along = b.op("normal_from_axes", along + axes(compiler), 3)
    across = b.op("normalize", b.op("cross_product", along + normal, 3), 3)
    return {node.outputs[0].identifier: b.op("cross_product", normal + across, 3)}


# Nodes whose outputs need what this renderer does not know, and what is said of them.
_STAND_INS = {
    "AMBIENT_OCCLUSION": "occlusion is not traced by nodes, nothing is occluded",
    "BEVEL": "bevels are not rendered, edges stay sharp",
    "WIREFRAME": "wires are not rendered, there are none",
    "PARTICLE_INFO": "particles' properties are not known, only Random is",
    "HAIR_INFO": "hairs' properties are not known, only Random is",
    "POINT_INFO": "points' properties are not known, only Random is",
    "VOLUME_INFO": "volumes are not rendered yet, there is none",
    "SCRIPT": "Open Shading Language is not run, its outputs are 0",
}


@node(*_STAND_INS)
def stand_in(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    compiler.warn(node, _STAND_INS[node.type])
    outputs: Outputs = {}
    for socket in node.outputs:
        if socket.type == "SHADER":
            outputs[socket.identifier] = ()
        else:
            outputs[socket.identifier] = BLACK if socket.type in {"RGBA", "VECTOR"} else (0.0,)
    if node.type == "AMBIENT_OCCLUSION":
        outputs |= {"Color": compiler.value(node.inputs["Color"]), "AO": ONE}
    elif node.type == "BEVEL":
        outputs["Normal"] = normal_input(compiler, node)
    elif "Random" in node.outputs:
        outputs["Random"] = b.input("object_random", 1)
    return outputs


@node("SHADERTORGB")
def shader_to_rgb(compiler: Compiler, node: Any) -> Outputs:
    compiler.warn(node, "works in Eevee alone, taken as the sum of the shaders' own colours")
    b = compiler.builder
    color: Value = BLACK
    for closure in compiler.closures(node.inputs[0]):
        if closure.kind not in {"TRANSPARENT", "HOLDOUT"}:
            color = b.add(color, closure.weight)
    return {"Color": color, "Alpha": ONE}
