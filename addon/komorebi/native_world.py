"""WorldData → what the core's Scene takes: a colour or an Environment, and a program for camera
rays. No bpy."""

from __future__ import annotations

import os
from functools import partial
from typing import Any

from . import cache
from .mesh_cache import digest
from .native_programs import Programs
from .scene_data import EnvironmentImage, WorldData

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


def load(
    core: Any,
    world: WorldData,
    known_as: bytes | None,
    programs: Programs,
    threads: int,
    cancel: Any,
) -> tuple[Any | None, tuple[float, ...], Any | None]:
    """The Environment (None: it is a colour), the colour, the camera's program (None: the same)."""
    seen = world.camera_program
    shown = None if seen is None else programs.program(seen)
    if world.image is not None and known_as is not None:
        environment = cache.get(known_as, partial(_native_environment, core, world.image))
        return environment, world.color, shown
    if world.program is None or known_as is None:
        return None, world.color, shown
    light = programs.program(world.program)
    color = tuple(light.constants)
    if None not in color:
        same = shown is not None and tuple(shown.constants) == color
        return None, tuple(max(c, 0.0) for c in color), None if same else shown
    width = _size(world)
    environment = cache.get(
        known_as,
        lambda: core.Environment.from_program(
            light, width, width // 2, threads=threads, cancel=cancel
        ),
    )
    return environment, world.color, shown


def _size(world: WorldData) -> int:
    if world.resolution > 0:
        return world.resolution
    return min(max(AUTOMATIC_SIZE, world.program_size), LARGEST_SIZE)


def _native_environment(core: Any, image: EnvironmentImage) -> Any:
    if image.pixels is not None:
        return core.Environment.from_pixels(image.name, image.pixels)
    return core.Environment.from_file(image.path, color_space=image.color_space)


def _image_key(core: Any, image: EnvironmentImage, threads: int) -> bytes:
    if image.pixels is not None:
        return b"pixels" + digest(core, (image.pixels,), threads)
    # A file is known by path, size and time of change; reading it all would cost as much as
    # loading it.
    assert image.path is not None
    status = os.stat(image.path)
    stamp = (image.path, image.color_space, status.st_size, status.st_mtime_ns, status.st_ino)
    return b"file" + repr(stamp).encode("utf-8", "surrogateescape")
