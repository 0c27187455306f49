"""Color Ramp and curves: tables of what Blender itself evaluates, as Cycles has them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scene_data import FloatArray
from .compiler import Compiler, Outputs, node
from .values import Value

STEPS = 256  # of a table from its beginning to its end


@node("VALTORGB")
def color_ramp(compiler: Compiler, node: Any) -> Outputs:
    ramp = node.color_ramp
    colors = [ramp.evaluate(i / STEPS) for i in range(STEPS + 1)]
    table = np.asarray([tuple(c) for c in colors], np.float32).reshape(-1)
    smooth = float(ramp.interpolation != "CONSTANT" or ramp.color_mode != "RGB")
    factor = compiler.value(node.inputs[0])
    result = compiler.builder.op("ramp", factor, 4, numbers=(smooth,), table=table)
    return {"Color": result[:3], "Alpha": result[3:]}


def _range(curves: list[Any]) -> tuple[float, float]:
    """Where the outermost points of any of these curves lie."""
    return (
        min(c.points[0].location[0] for c in curves),
        max(c.points[len(c.points) - 1].location[0] for c in curves),
    )


def _table(mapping: Any, curves: list[Any], low: float, high: float) -> FloatArray:
    """The curves, each applied to what the one before gives."""
    values = np.linspace(low, high, STEPS + 1)
    for curve in curves:
        values = np.array([mapping.evaluate(curve, float(x)) for x in values])
    return values.astype(np.float32)


@node("CURVE_RGB", "CURVE_VEC", "CURVE_FLOAT")
def curves(compiler: Compiler, node: Any) -> Outputs:
    mapping = node.mapping
    mapping.initialize()
    curves = list(mapping.curves)
    channels = {"CURVE_RGB": 3, "CURVE_VEC": 3, "CURVE_FLOAT": 1}[node.type]
    combined = curves[3:4] if node.type == "CURVE_RGB" else []
    low, high = _range(curves[:channels] + combined)
    numbers = (low, high, float(mapping.extend == "EXTRAPOLATED"))
    factor, value = (compiler.value(s) for s in node.inputs[:2])
    result: Value = tuple(
        compiler.builder.op(
            "curve", (factor[0], value[c]), numbers=numbers,
            table=_table(mapping, [*combined, curves[c]], low, high),
        )[0]
        for c in range(channels)
    )  # fmt: skip
    return {node.outputs[0].identifier: result}
