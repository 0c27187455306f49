"""A studio light's background as EEVEE blurs it: what a mirror of that roughness shows of the light
where it is looked at from the front. What lights the scene stays sharp. No bpy.

The kernel is zonal, that is, it depends on nothing but the angle between two directions. So rows of
the map are convolved with rows by Fourier transforms, which takes as long for any width of it.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import cache, native_texture
from ..export.shader.values import Builder
from ..scene_data import DoubleArray, FloatArray, ProgramData, TextureImage, WorldData

# Columns of the blurred map: two for the width of the kernel, within these.
FEWEST, MOST = 128, 512
SOURCE_WIDTH = 2048  # at how many columns the picture is looked up; studio lights have 1024
TEXTURE_LIMIT = 1 << 30
LINEAR, CUBIC = 1.0, 2.0  # interpolation, by the core's numbers


@dataclass(slots=True)
class BlurredMap:
    """As the cache keeps it."""

    pixels: FloatArray  # [height, width, 4]

    @property
    def byte_count(self) -> int:
        return self.pixels.nbytes


def blur(core: Any, world: WorldData, amount: float, threads: int) -> None:
    """Lets camera rays see the map of `world`, a file, blurred by 0 to 1.

    A file that cannot be read is left to whoever loads the world, and says so.
    """
    image = world.image
    if amount <= 0.0 or image is None or image.path is None or not os.path.isfile(image.path):
        return
    status = os.stat(image.path)
    stamp = (image.path, status.st_size, status.st_mtime_ns, round(amount, 4))
    key = b"blurred" + repr(stamp).encode("utf-8", "surrogateescape")
    made = cache.get(key, lambda: BlurredMap(_blurred(core, image.path, amount, threads)))
    picture = TextureImage(image.name, key, alpha_mode="NONE", pixels=made.pixels)
    b = Builder()
    turn = np.zeros((3, 4))
    turn[:, :3] = world.texture_from_world
    place = b.op("transform", b.input("position"), 3, numbers=tuple(map(float, turn.ravel())))
    color = b.multiply(_look_up(b, place, picture, CUBIC), (float(world.strength),))
    world.camera_program = ProgramData("the blurred studio light", b.ops, color)


def _look_up(b: Builder, place: Any, picture: TextureImage, interpolation: float) -> Any:
    numbers = (interpolation, 0.0, 0.0, 0.0)  # repeats, equirectangular
    return b.op("environment", place, 4, numbers=numbers, texture=picture)[:3]


def directions(width: int, height: int) -> DoubleArray:
    """Of the middles of a map's pixels [height, width, 3], as the core looks them up."""
    around = -2.0 * math.pi * ((np.arange(width) + 0.5) / width - 0.5)
    up = math.pi * ((np.arange(height)[:, None] + 0.5) / height - 0.5)
    flat = np.cos(up) * np.ones(width)
    return np.stack(
        [flat * np.cos(around), flat * np.sin(around), np.sin(up) * np.ones(width)], axis=2
    )


def _blurred(core: Any, path: str, amount: float, threads: int) -> FloatArray:
    alpha = amount * amount  # as of any roughness in Blender
    columns = 2.0 * math.pi / (0.65 * alpha)
    width = 1 << min(max(math.ceil(math.log2(columns)), 0), 30)
    width = min(max(width, FEWEST), MOST)
    return convolved(_averages(core, path, width, threads), alpha)


def _averages(core: Any, path: str, width: int, threads: int) -> FloatArray:
    """The picture of a file as a map of that width, [width / 2, width, 3]."""
    image = TextureImage(os.path.basename(path), b"studio light" + os.fsencode(path), path=path)
    b = Builder()
    color = _look_up(b, b.input("position"), image, LINEAR)
    textures = native_texture.load(core, [image], TEXTURE_LIMIT, threads, lambda _: None)
    ops = [
        op if op.texture is None else type(op)(
            op.op, op.operands, op.numbers, op.table, op.name, textures[image.key]
        )
        for op in b.ops
    ]  # fmt: skip
    program = core.Program("the studio light", ops, list(color))
    height, part = SOURCE_WIDTH // 2, SOURCE_WIDTH // width
    looked = directions(SOURCE_WIDTH, height).astype(np.float32).reshape(-1, 3)
    pixels = program.evaluate(len(looked), {"position": looked})
    weights = np.cos(math.pi * ((np.arange(height) + 0.5) / height - 0.5)).astype(np.float32)
    weights = weights.reshape(width // 2, part, 1)
    parts = pixels.reshape(width // 2, part, width, part, 3).mean(axis=3)
    means: FloatArray = (parts * weights[..., None]).sum(axis=1) / weights[..., None].sum(axis=1)
    return means


def convolved(pixels: FloatArray, alpha: float) -> FloatArray:
    """A map [height, width, 3] seen in a mirror of GGX's roughness `alpha`, [height, width, 4]."""
    height, width = pixels.shape[:2]
    up = math.pi * ((np.arange(height) + 0.5) / height - 0.5)
    around = 2.0 * math.pi * np.arange(width) / width
    area = np.cos(up)  # of a row's pixels, in proportion
    source = np.fft.rfft(pixels.astype(np.float64), axis=1)
    result = np.empty((height, width, 4), np.float32)
    result[..., 3] = 1.0
    for row in range(height):
        cosines = np.clip(
            math.sin(up[row]) * np.sin(up)[:, None]
            + math.cos(up[row]) * np.cos(up)[:, None] * np.cos(around),
            -1.0, 1.0,
        )  # fmt: skip
        kernel = _kernel(cosines, alpha) * area[:, None]
        kernel /= kernel.sum()
        spectrum = np.einsum("rk,rkc->kc", np.fft.rfft(kernel, axis=1), source)
        result[row, :, :3] = np.fft.irfft(spectrum, width, axis=0)
    return np.maximum(result, 0.0)


def _kernel(cosines: DoubleArray, alpha: float) -> DoubleArray:
    """How much light from that angle counts: GGX at the half vector, times the cosine."""
    half = 0.5 * (1.0 + cosines)  # the squared cosine of half the angle
    return np.maximum(cosines, 0.0) / (half * (alpha * alpha - 1.0) + 1.0) ** 2
