"""Numbers and colours that stand in the tree, and shaders that shine or mix others."""

from __future__ import annotations

from typing import Any

from .closures import Closure, scaled
from .compiler import Compiler, Outputs, node


@node("RGB", "VALUE")
def constant(_compiler: Compiler, node: Any) -> Outputs:
    socket = node.outputs[0]
    value = socket.default_value
    return {
        socket.identifier: tuple(map(float, value[:3])) if node.type == "RGB" else (float(value),)
    }


@node("BACKGROUND", "EMISSION")
def emission(compiler: Compiler, node: Any) -> Outputs:
    color, strength = compiler.inputs(node, "Color", "Strength")
    weight = compiler.builder.multiply(strength, color)
    return {node.outputs[0].identifier: (Closure("EMISSION", weight),)}


@node("MIX_SHADER")
def mix_shader(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    factor = compiler.value(node.inputs[0])
    if factor[0] in (0.0, 1.0):  # for this kind of ray there is but one
        return {node.outputs[0].identifier: compiler.closures(node.inputs[1 + int(factor[0])])}
    factor = b.clamp01(factor)
    first, second = (compiler.closures(node.inputs[i]) for i in (1, 2))
    mixed = scaled(b, first, b.subtract((1.0,), factor)) + scaled(b, second, factor)
    return {node.outputs[0].identifier: mixed}


@node("ADD_SHADER")
def add_shader(compiler: Compiler, node: Any) -> Outputs:
    return {
        node.outputs[0].identifier: compiler.closures(node.inputs[0])
        + compiler.closures(node.inputs[1])
    }


@node("LIGHT_PATH")
def light_path(compiler: Compiler, _node: Any) -> Outputs:
    kind = "DIFFUSE" if compiler.ray.kind == "SUN" else compiler.ray.kind
    return {
        "Is Camera Ray": (float(kind == "CAMERA"),),
        "Is Shadow Ray": (float(kind == "SHADOW"),),
        "Is Diffuse Ray": (float(kind == "DIFFUSE"),),
        "Is Reflection Ray": (float(kind == "DIFFUSE"),),
        **dict.fromkeys(
            ("Is Glossy Ray", "Is Singular Ray", "Is Transmission Ray", "Transparent Depth"), (0.0,)
        ),
        "Ray Length": compiler.builder.input("ray_length", 1),
        "Ray Depth": (float(kind != "CAMERA"),),
        "Diffuse Depth": (float(kind == "DIFFUSE"),),
        "Glossy Depth": (0.0,),
        "Transmission Depth": (0.0,),
    }
