"""WorldData → what the core's Scene takes: a colour or an Environment, and a program for camera
rays. No bpy."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from . import cache
from .mesh_cache import digest
from .native_programs import Programs
from .scene_data import DoubleArray, EnvironmentImage, LampData, SunData, WorldData

# Columns of a map that is made from a program, unless the scene says how many: its lights are as
# small as people build them into gradients and ramps, and images keep their own size.
AUTOMATIC_SIZE = 1024
LARGEST_SIZE = 8192


def key(core: Any, world: WorldData, threads: int) -> bytes | None:
    """By what the cache knows the world's Environment; None if it is a colour."""
    if world.image is not None:
        return _image_key(core, world.image, threads)
    if world.program is None:
        return None
    return b"program" + repr(_size(world)).encode() + world.program.key()


@dataclass(slots=True)
class NativeWorld:
    """What the core's Scene takes of a world."""

    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # where there is no environment
    environment: Any | None = None  # core.Environment
    camera: Any | None = None  # core.Program, what camera rays see; None: the same
    suns: list[LampData] = field(default_factory=list)

    @property
    def max_radiance(self) -> float:
        """Of the suns; a disc is brighter in its middle than as a whole."""
        return 2.0 * max((float(sun.radiance.max()) for sun in self.suns), default=0.0)


def load(
    core: Any, world: WorldData, known_as: bytes | None, programs: Programs, threads: int,
    cancel: Any,
) -> NativeWorld:  # fmt: skip
    """Raises core.Cancelled."""
    seen = world.camera_program
    native = NativeWorld(world.color, camera=None if seen is None else programs.program(seen))
    if known_as is None:
        return native
    if world.image is not None:
        native.environment = cache.get(
            known_as, partial(_native_environment, core, world.image, cancel)
        )
        return native
    assert world.program is not None
    light = programs.program(world.program)
    native.suns = [_sun(sun, light, programs, world.max_bounces) for sun in world.suns]
    color = tuple(light.constants)
    if None not in color:
        native.color = tuple(max(c, 0.0) for c in color)
        if native.camera is not None and tuple(native.camera.constants) == color:
            native.camera = None
        return native
    width = _size(world)
    native.environment = cache.get(
        known_as,
        lambda: core.Environment.from_program(
            light, width, width // 2, threads=threads, cancel=cancel
        ),
    )
    return native


def _sun(sun: SunData, light: Any, programs: Programs, max_bounces: int) -> LampData:
    """What of a sky's sun reaches the world's surface, through all that lies between: the world
    with its disc less that without."""
    towards = np.array([sun.direction], np.float32)
    away = -towards
    inputs = {
        "position": towards, "object_point": towards, "normal": away, "true_normal": away,
        "incoming": away, "object_normal": away,
    }  # fmt: skip
    radiance = (
        programs.program(sun.program).evaluate(1, inputs)[0] - light.evaluate(1, inputs)[0]
    ).astype(np.float64)
    matrix = np.eye(4)
    matrix[:3, :3] = _axes_towards(towards[0].astype(np.float64))
    sizes = {"angle": 2.0 * sun.radius, "max_bounces": float(max_bounces)}
    return LampData("the sky's sun", "SUN", np.maximum(radiance, 0.0), matrix, sizes)


def _axes_towards(z: DoubleArray) -> DoubleArray:
    """A rotation whose Z axis points that way."""
    aside = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = np.cross(aside, z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _size(world: WorldData) -> int:
    if world.resolution > 0:
        return world.resolution
    return min(max(AUTOMATIC_SIZE, world.program_size), LARGEST_SIZE)


def _native_environment(core: Any, image: EnvironmentImage, cancel: Any) -> Any:
    if image.pixels is not None:
        return core.Environment.from_pixels(image.name, image.pixels, cancel)
    return core.Environment.from_file(image.path, color_space=image.color_space, cancel=cancel)


def _image_key(core: Any, image: EnvironmentImage, threads: int) -> bytes:
    if image.pixels is not None:
        return b"pixels" + digest(core, (image.pixels,), threads)
    # A file is known by path, size and time of change; reading it all would cost as much as
    # loading it.
    assert image.path is not None
    status = os.stat(image.path)
    stamp = (image.path, image.color_space, status.st_size, status.st_mtime_ns, status.st_ino)
    return b"file" + repr(stamp).encode("utf-8", "surrogateescape")
