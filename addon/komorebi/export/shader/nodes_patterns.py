"""Magic, Gradient, Checker, Brick and Gabor textures, and those that are not rendered."""

from __future__ import annotations

from typing import Any

from .compiler import GREY, Compiler, Outputs, node
from .texture_inputs import parameter, texture_vector

# native/shader/patterns.h
_GRADIENTS = (
    "LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "QUADRATIC_SPHERE", "SPHERICAL",
)  # fmt: skip


@node("TEX_MAGIC")
def magic(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    operands = texture_vector(compiler, node) + parameter(compiler, node, "Scale")
    operands += parameter(compiler, node, "Distortion")
    color = b.op("magic", operands, 3, numbers=(float(node.turbulence_depth),))
    mean = b.multiply(b.dot(color, (1.0, 1.0, 1.0)), (1.0 / 3.0,))
    return {"Color": color, "Fac": mean, node.outputs[1].identifier: mean}


@node("TEX_GRADIENT")
def gradient(compiler: Compiler, node: Any) -> Outputs:
    kind = float(_GRADIENTS.index(node.gradient_type))
    value = compiler.builder.op("gradient", texture_vector(compiler, node), numbers=(kind,))
    return {"Color": value * 3, "Fac": value, node.outputs[1].identifier: value}


@node("TEX_CHECKER")
def checker(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    place = b.multiply(parameter(compiler, node, "Scale"), texture_vector(compiler, node))
    fac = b.op("checker", place)
    first, second = (parameter(compiler, node, name) for name in ("Color1", "Color2"))
    return {"Color": b.mix(fac, second, first), "Fac": fac, node.outputs[1].identifier: fac}


@node("TEX_BRICK")
def brick(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    place = b.multiply(parameter(compiler, node, "Scale"), texture_vector(compiler, node))[:2]
    names = ("Mortar Size", "Mortar Smooth", "Bias", "Brick Width", "Row Height")
    for name in names:
        place += parameter(compiler, node, name)
    tint, mortar = b.op(
        "brick", place, 2,
        numbers=(node.offset, float(node.offset_frequency), node.squash,
                 float(node.squash_frequency)),
    )  # fmt: skip
    first, second, joint = (parameter(compiler, node, n) for n in ("Color1", "Color2", "Mortar"))
    color = b.mix((mortar,), b.mix((tint,), first, second), joint)
    return {"Color": color, "Fac": (mortar,), node.outputs[1].identifier: (mortar,)}


@node("TEX_GABOR")
def gabor(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    place = b.multiply(parameter(compiler, node, "Scale"), texture_vector(compiler, node))
    for name in ("Frequency", "Anisotropy", "Orientation 2D", "Orientation 3D"):
        place += parameter(compiler, node, name)
    value, phase, intensity = b.op("gabor", place, 3, numbers=(float(node.gabor_type == "3D"),))
    return {"Value": (value,), "Phase": (phase,), "Intensity": (intensity,)}


@node("TEX_POINTDENSITY")
def point_density(compiler: Compiler, node: Any) -> Outputs:
    compiler.warn(node, "not supported, rendered as an even grey")
    return {"Color": GREY, "Density": (0.5,)}


@node("TEX_IES")
def ies(compiler: Compiler, node: Any) -> Outputs:
    compiler.warn(node, "not supported, rendered as an even lamp")
    strength = parameter(compiler, node, "Strength", 1.0)
    return {node.outputs[0].identifier: strength}
