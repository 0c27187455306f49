"""Nodes that work on numbers and vectors alone: Math, Vector Math, Clamp, Map Range."""

from __future__ import annotations

import math
from typing import Any

from .compiler import Compiler, Outputs, node
from .values import Builder, Value

# Blender's operations that the core has under their own names, by the number of their inputs.
_OPERATIONS = {
    1: "SQRT INVERSE_SQRT ABSOLUTE EXPONENT SIGN ROUND FLOOR CEIL TRUNC FRACT SINE COSINE TANGENT "
    "ARCSINE ARCCOSINE ARCTANGENT SINH COSH TANH",
    2: "ADD SUBTRACT MULTIPLY DIVIDE POWER LOGARITHM MINIMUM MAXIMUM LESS_THAN GREATER_THAN MODULO "
    "FLOORED_MODULO SNAP PINGPONG ARCTAN2",
    3: "MULTIPLY_ADD COMPARE SMOOTH_MIN SMOOTH_MAX WRAP",
}
_ARITY = {name: count for count, names in _OPERATIONS.items() for name in names.split()}
_SCALED = {"RADIANS": math.pi / 180.0, "DEGREES": 180.0 / math.pi}
# Those of Vector Math that go component by component.
_BY_COMPONENT = {
    "ADD", "SUBTRACT", "MULTIPLY", "DIVIDE", "MULTIPLY_ADD", "ABSOLUTE", "MINIMUM", "MAXIMUM",
    "FLOOR", "CEIL", "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT", "POWER", "SIGN",
    "ROUND"
}  # fmt: skip


def operate(b: Builder, operation: str, inputs: list[Value]) -> Value | None:
    """An operation of Blender's Math node; None if it is not known."""
    if operation in _SCALED:
        return b.multiply(inputs[0], (_SCALED[operation],))
    if operation not in _ARITY:
        return None
    operands = inputs[: _ARITY[operation]]
    if operation == "ADD":
        return b.add(*operands)
    if operation == "MULTIPLY":
        return b.multiply(*operands)
    return b.each(operation.lower(), *operands)


@node("MATH")
def math_node(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    inputs = [compiler.value(s) for s in node.inputs]
    result = operate(b, node.operation, inputs)
    if result is None:
        compiler.warn(node, f"operation {node.operation} is not supported yet, left out")
        result = inputs[0]
    if node.use_clamp:
        result = b.clamp01(result)
    return {node.outputs[0].identifier: result}


@node("VECT_MATH")
def vector_math(compiler: Compiler, node: Any) -> Outputs:
    b, operation = compiler.builder, node.operation
    vectors = [compiler.value(s) for s in node.inputs if s.type == "VECTOR"]
    scale = next((s for s in node.inputs if s.type == "VALUE"), None)
    first, second = vectors[:2]
    vector: Value = (0.0, 0.0, 0.0)
    number: Value = (0.0,)
    if operation in _BY_COMPONENT:
        vector = operate(b, operation, vectors) or first
    elif operation == "FRACTION":
        vector = b.each("fract", first)
    elif operation == "SCALE":
        vector = b.multiply(first, compiler.value(scale))
    elif operation == "NORMALIZE":
        vector = b.op("normalize", first, 3)
    elif operation in {"CROSS_PRODUCT", "PROJECT", "REFLECT"}:
        vector = b.op(operation.lower(), first + second, 3)
    elif operation == "REFRACT":
        vector = b.op("refract", first + second + compiler.value(scale), 3)
    elif operation == "FACEFORWARD":
        vector = b.op("faceforward", first + second + vectors[2], 3)
    elif operation == "DOT_PRODUCT":
        number = b.dot(first, second)
    elif operation == "DISTANCE":
        number = b.op("length", b.subtract(first, second))
    elif operation == "LENGTH":
        number = b.op("length", first)
    else:
        compiler.warn(node, f"operation {operation} is not supported yet, left out")
        vector = first
    return {"Vector": vector, "Value": number}


@node("CLAMP")
def clamp(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    value, low, high = compiler.inputs(node, "Value", "Min", "Max")
    if node.clamp_type == "RANGE":  # whichever is the lower
        low, high = b.each("minimum", low, high), b.each("maximum", low, high)
    return {node.outputs[0].identifier: b.each("clamp", value, low, high)}


@node("MAP_RANGE")
def map_range(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    is_vector = getattr(node, "data_type", "FLOAT") == "FLOAT_VECTOR"
    sockets = [s for s in node.inputs if (s.type == "VECTOR") == is_vector]
    value, from_low, from_high, to_low, to_high, steps = map(compiler.value, sockets)
    kind = node.interpolation_type
    t = b.each("divide", b.subtract(value, from_low), b.subtract(from_high, from_low))
    if kind == "STEPPED":
        t = b.each("divide", b.each("floor", b.multiply(t, b.add(steps, (1.0,)))), steps)
        t = b.multiply(t, b.each("greater_than", steps, (0.0,)))
    elif kind in {"SMOOTHSTEP", "SMOOTHERSTEP"}:
        t = b.each(kind.lower(), b.clamp01(t))
    result = b.each("multiply_add", t, b.subtract(to_high, to_low), to_low)
    if not is_vector:  # one number: a range that is empty gives 0
        same = b.each("compare", from_low, from_high, (0.0,))
        result = b.multiply(result, b.subtract((1.0,), same))
    if node.clamp and not (is_vector and kind.startswith("SMOOTH")):
        low, high = b.each("minimum", to_low, to_high), b.each("maximum", to_low, to_high)
        result = b.each("clamp", result, low, high)
    return {node.outputs["Vector" if is_vector else "Result"].identifier: result}
