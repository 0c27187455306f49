"""Nodes that work on colours alone."""

from __future__ import annotations

from typing import Any

from .compiler import Compiler, Outputs, node
from .values import LUMINANCE, Builder, Value

ONE: Value = (1.0,)
_HSV_BLENDS = {"HUE", "SATURATION", "VALUE", "COLOR"}
_CHANNEL_BLENDS = {
    "SCREEN", "OVERLAY", "DIVIDE", "DODGE", "BURN", "SOFT_LIGHT", "LINEAR_LIGHT", "EXCLUSION"
}  # fmt: skip


def blend(b: Builder, kind: str, factor: Value, first: Value, second: Value) -> Value | None:
    """A blend of Blender's Mix node; None if it is not known."""
    if kind in _HSV_BLENDS:
        return b.op("blend_" + kind.lower(), factor + first + second, 3)
    if kind in _CHANNEL_BLENDS:
        return b.each("blend_" + kind.lower(), factor, first, second)
    if kind == "MIX":
        other = second
    elif kind in {"ADD", "SUBTRACT", "MULTIPLY"}:
        other = b.each(kind.lower(), first, second)
    elif kind == "DIFFERENCE":
        other = b.each("absolute", b.subtract(first, second))
    elif kind in {"DARKEN", "LIGHTEN"}:
        other = b.each("minimum" if kind == "DARKEN" else "maximum", first, second)
    else:
        return None
    return b.mix(factor, first, other)


def _blended(
    compiler: Compiler, node: Any, factor: Value, first: Value, second: Value, clamp: bool
) -> Value:
    b = compiler.builder
    result = blend(b, node.blend_type, factor, first, second)
    if result is None:
        compiler.warn(node, f"blend type {node.blend_type} is not supported yet, taken as Mix")
        result = b.mix(factor, first, second)
    return b.clamp01(result) if clamp else result


@node("MIX_RGB")
def mix_rgb(compiler: Compiler, node: Any) -> Outputs:
    factor, first, second = (compiler.value(s) for s in node.inputs)
    factor = compiler.builder.clamp01(factor)
    result = _blended(compiler, node, factor, first, second, node.use_clamp)
    return {node.outputs[0].identifier: result}


@node("MIX")
def mix(compiler: Compiler, node: Any) -> Outputs:
    b, kind = compiler.builder, node.data_type
    suffix = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(kind)
    if suffix is None:
        compiler.warn(node, f"{kind} values do not occur in shaders, left out")
        return {s.identifier: (0.0,) for s in node.outputs}
    by_name = {s.identifier: s for s in node.inputs}
    by_component = kind == "VECTOR" and node.factor_mode == "NON_UNIFORM"
    factor = compiler.value(by_name["Factor_Vector" if by_component else "Factor_Float"])
    first, second = (compiler.value(by_name[f"{side}_{suffix}"]) for side in "AB")
    if node.clamp_factor:
        factor = b.clamp01(factor)
    if kind == "RGBA":
        result = _blended(compiler, node, factor, first, second, node.clamp_result)
    else:
        result = b.mix(factor, first, second)
    return {f"Result_{suffix}": result}


@node("HUE_SAT")
def hue_saturation(compiler: Compiler, node: Any) -> Outputs:
    hue, saturation, value, factor, color = (compiler.value(s) for s in node.inputs)
    operands = color + hue + saturation + value + factor
    return {node.outputs[0].identifier: compiler.builder.op("hue_saturation", operands, 3)}


@node("GAMMA")
def gamma(compiler: Compiler, node: Any) -> Outputs:
    color, exponent = (compiler.value(s) for s in node.inputs)
    return {node.outputs[0].identifier: compiler.builder.each("gamma", color, exponent)}


@node("BRIGHTCONTRAST")
def bright_contrast(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    color, bright, contrast = (compiler.value(s) for s in node.inputs)
    offset = b.subtract(bright, b.multiply(contrast, (0.5,)))
    result = b.each("multiply_add", b.add(ONE, contrast), color, offset)
    return {node.outputs[0].identifier: b.each("maximum", result, (0.0,))}


@node("INVERT")
def invert(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    factor, color = (compiler.value(s) for s in node.inputs)
    return {node.outputs[0].identifier: b.mix(factor, color, b.subtract(ONE, color))}


@node("RGBTOBW")
def to_gray(compiler: Compiler, node: Any) -> Outputs:
    color = compiler.value(node.inputs[0])
    return {node.outputs[0].identifier: compiler.builder.dot(color, LUMINANCE)}


@node("BLACKBODY", "WAVELENGTH")
def spectrum(compiler: Compiler, node: Any) -> Outputs:
    value = compiler.value(node.inputs[0])
    return {node.outputs[0].identifier: compiler.builder.op(node.type.lower(), value, 3)}


_SPACES = {"SEPHSV": "HSV", "COMBHSV": "HSV"}


def _space(node: Any) -> str:
    space: str = _SPACES.get(node.type) or getattr(node, "mode", "RGB")
    return space


@node("SEPXYZ", "SEPRGB", "SEPHSV", "SEPARATE_COLOR")
def separate(compiler: Compiler, node: Any) -> Outputs:
    value, space = compiler.value(node.inputs[0]), _space(node)
    if space != "RGB":
        value = compiler.builder.op("rgb_to_" + space.lower(), value, 3)
    return {s.identifier: (part,) for s, part in zip(node.outputs, value, strict=False)}


@node("COMBXYZ", "COMBRGB", "COMBHSV", "COMBINE_COLOR")
def combine(compiler: Compiler, node: Any) -> Outputs:
    value = tuple(compiler.value(s)[0] for s in node.inputs)
    space = _space(node)
    if space != "RGB":
        value = compiler.builder.op(space.lower() + "_to_rgb", value, 3)
    return {node.outputs[0].identifier: value}
