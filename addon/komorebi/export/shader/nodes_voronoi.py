"""Voronoi texture."""

from __future__ import annotations

from typing import Any

from ... import compat
from .compiler import Compiler, Outputs, node
from .texture_inputs import coordinates, parameter

# native/shader/voronoi.h
_FEATURES = ("F1", "F2", "SMOOTH_F1")
_METRICS = ("EUCLIDEAN", "MANHATTAN", "CHEBYCHEV", "MINKOWSKI")
_FLOAT_MAX = 3.4028234663852886e38


@node("TEX_VORONOI")
def voronoi(compiler: Compiler, node: Any) -> Outputs:
    b, dimensions, feature = compiler.builder, node.voronoi_dimensions, node.feature
    place = coordinates(compiler, node, dimensions)
    randomness = parameter(compiler, node, "Randomness", 1.0)
    detail = parameter(compiler, node, "Detail", 0.0)
    roughness = parameter(compiler, node, "Roughness", 0.5)
    lacunarity = parameter(compiler, node, "Lacunarity", 2.0)
    normalize = float(getattr(node, "normalize", False))
    count, hashed = float(dimensions[0]), float(compat.VORONOI_PCG)
    if feature == "N_SPHERE_RADIUS":
        radius = b.op("voronoi_radius", place + randomness, numbers=(count, hashed))
        return {"Radius": radius}
    if feature == "DISTANCE_TO_EDGE":
        operands = place + detail + roughness + lacunarity + randomness
        return {"Distance": b.op("voronoi_edge", operands, numbers=(count, normalize, hashed))}
    color = next(s for s in node.outputs if s.identifier == "Color")
    is_fractal = hasattr(node, "normalize")
    smoothness = parameter(compiler, node, "Smoothness")
    if not is_fractal:  # where it is 0, later releases search fewer cells
        smoothness = b.each("maximum", smoothness, (1e-30,))
    operands = (
        place + parameter(compiler, node, "Scale") + detail + roughness + lacunarity
        + smoothness + parameter(compiler, node, "Exponent") + randomness
    )  # fmt: skip
    found = b.op(
        "voronoi", operands, 8,
        numbers=(
            count, float(_FEATURES.index(feature)), float(_METRICS.index(node.distance)),
            normalize, hashed, _FLOAT_MAX if is_fractal else 8.0,
            float(color.is_linked),
        ),
    )  # fmt: skip
    position = found[4:]
    w = {"1D": position[:1], "4D": position[3:]}.get(dimensions, (0.0,))
    position = {"1D": (0.0,) * 3, "2D": (*position[:2], 0.0)}.get(dimensions, position[:3])
    return {"Distance": found[:1], "Color": found[1:4], "Position": position, "W": w}
