"""White Noise, Noise, Musgrave and Wave textures."""

from __future__ import annotations

from typing import Any

from ... import compat
from .compiler import Compiler, Outputs, node
from .texture_inputs import coordinates, parameter, texture_vector
from .values import Value

# native/shader/fractal_noise.h
_TYPES = (
    "MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "FBM", "HETERO_TERRAIN",
)  # fmt: skip
_FBM = _TYPES.index("FBM")
_PROFILES = ("SIN", "SAW", "TRI")


def fractal(
    compiler: Compiler, place: Value, dimensions: str, *, detail: Value, roughness: Value,
    lacunarity: Value = (2.0,), offset: Value = (0.0,), gain: Value = (0.0,), kind: int = _FBM,
    normalize: bool = True, counts_first: bool = False, channel: int = 0,
) -> Value:  # fmt: skip
    """Octaves of noise at four coordinates."""
    return compiler.builder.op(
        "noise", (*place, *detail, *roughness, *lacunarity, *offset, *gain),
        numbers=(float(dimensions[0]), float(kind), float(normalize), float(counts_first),
                 float(compat.NOISE_REPEATS), float(channel)),
    )  # fmt: skip


@node("TEX_WHITE_NOISE")
def white_noise(compiler: Compiler, node: Any) -> Outputs:
    dimensions = node.noise_dimensions
    place = coordinates(compiler, node, dimensions)
    color = compiler.builder.op("white_noise", place, 3, numbers=(float(dimensions[0]),))
    return {"Value": color[:1], "Color": color}


@node("TEX_NOISE")
def noise(compiler: Compiler, node: Any) -> Outputs:
    b, dimensions = compiler.builder, node.noise_dimensions
    place = coordinates(compiler, node, dimensions)
    distortion = parameter(compiler, node, "Distortion")
    if distortion != (0.0,):
        numbers = (float(dimensions[0]), float(compat.NOISE_REPEATS))
        place = b.op("noise_distort", place + distortion, 4, numbers=numbers)
    roughness = parameter(compiler, node, "Roughness")
    if not hasattr(node, "noise_type"):
        roughness = b.clamp01(roughness)
    fac, green, blue = (
        fractal(
            compiler, place, dimensions, channel=channel, roughness=roughness,
            detail=parameter(compiler, node, "Detail"),
            lacunarity=parameter(compiler, node, "Lacunarity", 2.0),
            offset=parameter(compiler, node, "Offset"), gain=parameter(compiler, node, "Gain"),
            kind=_TYPES.index(getattr(node, "noise_type", "FBM")),
            normalize=getattr(node, "normalize", True),
        )
        for channel in range(3)
    )  # fmt: skip
    return {node.outputs[0].identifier: fac, "Color": fac + green + blue}


@node("TEX_MUSGRAVE")
def musgrave(compiler: Compiler, node: Any) -> Outputs:
    b, dimensions = compiler.builder, node.musgrave_dimensions
    least = (1e-5,)
    lacunarity = b.each("maximum", parameter(compiler, node, "Lacunarity"), least)
    dimension = b.each("maximum", parameter(compiler, node, "Dimension"), least)
    height = fractal(
        compiler, coordinates(compiler, node, dimensions), dimensions,
        detail=parameter(compiler, node, "Detail"), lacunarity=lacunarity,
        roughness=b.each("power", lacunarity, b.multiply(dimension, (-1.0,))),
        offset=parameter(compiler, node, "Offset"), gain=parameter(compiler, node, "Gain"),
        kind=_TYPES.index(node.musgrave_type), normalize=False, counts_first=True,
    )  # fmt: skip
    return {node.outputs[0].identifier: height}


@node("TEX_WAVE")
def wave(compiler: Compiler, node: Any) -> Outputs:
    b = compiler.builder
    place = b.multiply(parameter(compiler, node, "Scale"), texture_vector(compiler, node))
    # Off whole numbers, on which coordinates often lie, as Cycles moves them.
    place = b.multiply(b.add(place, (1e-6,)), (0.999999,))
    is_bands = node.wave_type == "BANDS"
    direction = node.bands_direction if is_bands else node.rings_direction
    along = [i for i, axis in enumerate("XYZ") if axis == direction]
    if not is_bands:
        across = tuple(0.0 if i in along else c for i, c in enumerate(place))
        angle = b.multiply(b.op("length", across), (20.0,))
    elif along:
        angle = b.multiply(place[along[0] : along[0] + 1], (20.0,))
    else:
        angle = b.multiply(b.dot(place, (1.0, 1.0, 1.0)), (10.0,))
    angle = b.add(angle, parameter(compiler, node, "Phase Offset"))
    distortion = parameter(compiler, node, "Distortion")
    if distortion != (0.0,):
        roughness = parameter(compiler, node, "Detail Roughness", 0.5)
        if not compat.NOISE_REPEATS:
            roughness = b.clamp01(roughness)
        shift = fractal(
            compiler, (*b.multiply(place, parameter(compiler, node, "Detail Scale")), 0.0), "3D",
            detail=parameter(compiler, node, "Detail"), roughness=roughness,
        )  # fmt: skip
        shift = b.subtract(b.multiply(shift, (2.0,)), (1.0,))
        angle = b.add(angle, b.multiply(distortion, shift))
    profile = _PROFILES.index(node.wave_profile)
    height = b.op("wave", angle, numbers=(float(profile),))
    return {"Color": height * 3, "Fac": height, node.outputs[1].identifier: height}
