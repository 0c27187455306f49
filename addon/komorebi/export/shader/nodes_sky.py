"""Sky Texture: operations on directions, and the sun's disc as a light of its own."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from ... import core
from ...scene_data import FloatArray, Value
from .compiler import Compiler, Outputs, node
from .texture_inputs import texture_vector

OPS = {"PREETHAM": "sky_preetham", "HOSEK_WILKIE": "sky_hosek"}  # all else: sky_scattering
SMALLEST_SUN = 0.0005  # radians; Cycles draws none that is smaller


@dataclass(frozen=True, slots=True)
class SkyData:
    """What core.sky_numbers, sky_table and sky_sun read; angles in radians, altitude in metres."""

    model: str
    sun_direction: tuple[float, float, float] = (0.0, 0.0, 1.0)
    turbidity: float = 2.2
    ground_albedo: float = 0.3
    sun_disc: bool = False
    sun_size: float = 0.0095
    sun_intensity: float = 1.0
    sun_elevation: float = 0.26
    sun_rotation: float = 0.0  # from +y to +x
    altitude: float = 0.0
    air: float = 1.0
    aerosol: float = 1.0
    ozone: float = 1.0


@dataclass(frozen=True, slots=True)
class SkySun:
    """The disc of a sky's sun as a light: even, of the same irradiance. What is on the way from
    the node to the world's surface (strengths, mixes) is not in it."""

    direction: tuple[float, float, float]  # towards it, unit
    radius: float  # of the disc, an angle in radians
    radiance: tuple[float, float, float]  # linear Rec. 709


@node("TEX_SKY")
def sky_texture(compiler: Compiler, node: Any) -> Outputs:
    """Camera rays see the disc. For all others the sky is without it, and `compiler.suns` has it:
    a map that is made of the sky would have to be enormous to hold a sun. A ray towards a sun sees
    the sky and the disc's mean radiance, wherever it looks."""
    data = _read(node)
    direction = texture_vector(compiler, node)
    table = None if data.model in OPS else _table(_of_table(data))
    disc: Value = (0.0, 0.0, 0.0)
    if data.sun_disc and compiler.ray.kind != "CAMERA":
        sun = SkySun(*core.load().sky_sun(data, table))
        if any(sun.radiance) and sun not in compiler.suns:
            compiler.suns.append(sun)
        if compiler.ray.kind == "SUN" and compiler.suns.index(sun) == compiler.ray.sun:
            disc = sun.radiance
        data = replace(data, sun_disc=False)
    numbers = tuple(core.load().sky_numbers(data))
    name = OPS.get(data.model, "sky_scattering")
    color = compiler.builder.op(name, direction, 3, numbers=numbers, table=table)
    return {node.outputs[0].identifier: compiler.builder.add(color, disc)}


def _read(node: Any) -> SkyData:
    if node.sky_type in OPS:
        sun = node.sun_direction.normalized()
        return SkyData(
            model=node.sky_type, sun_direction=tuple(sun), turbidity=node.turbidity,
            ground_albedo=node.ground_albedo,
        )  # fmt: skip
    elevation, rotation = _wrapped(node.sun_elevation, node.sun_rotation)
    return SkyData(
        model=node.sky_type, sun_disc=node.sun_disc, sun_size=max(node.sun_size, SMALLEST_SUN),
        sun_intensity=node.sun_intensity, sun_elevation=elevation, sun_rotation=rotation,
        altitude=node.altitude, air=node.air_density,
        aerosol=node.aerosol_density if hasattr(node, "aerosol_density") else node.dust_density,
        ozone=node.ozone_density,
    )  # fmt: skip


def _wrapped(elevation: float, rotation: float) -> tuple[float, float]:
    """The same direction with an elevation in [−π/2, π/2]: an animated day goes over the zenith."""
    elevation = math.remainder(elevation, math.tau)
    if abs(elevation) > math.pi / 2:
        elevation = math.copysign(math.pi, elevation) - elevation
        rotation += math.pi
    return elevation, rotation % math.tau


def _of_table(data: SkyData) -> SkyData:
    """What of a sky its table depends on."""
    return SkyData(
        model=data.model, sun_elevation=data.sun_elevation, altitude=data.altitude, air=data.air,
        aerosol=data.aerosol, ozone=data.ozone,
    )  # fmt: skip


@lru_cache(maxsize=8)
def _table(data: SkyData) -> FloatArray:
    """A sky's table, 0.4 to 0.8 MB."""
    table: FloatArray = core.load().sky_table(data)
    return table
