"""Komorebi's native core: scenes in, pictures out.

Data goes in as NumPy arrays, read in place and copied once; pictures come out as NumPy arrays that
own their memory. Long calls release the GIL. Nothing here knows about Blender.
"""

from ._komorebi import (
    AUTOMATIC_LIGHT_SAMPLES,
    Camera,
    Cancel,
    Cancelled,
    Environment,
    Mesh,
    Program,
    Scene,
    Session,
    Settings,
    SurfaceProgram,
    Texture,
    __version__,
    build_info,
    choose_builder,
    content_tags,
    film_bytes_per_pixel,
    force_instruction_set,
    has_op,
    known_passes,
    sky_numbers,
    sky_sun,
    sky_table,
)

__all__ = [
    "AUTOMATIC_LIGHT_SAMPLES",
    "Camera",
    "Cancel",
    "Cancelled",
    "Environment",
    "Mesh",
    "Program",
    "Scene",
    "Session",
    "Settings",
    "SurfaceProgram",
    "Texture",
    "__version__",
    "build_info",
    "choose_builder",
    "content_tags",
    "film_bytes_per_pixel",
    "force_instruction_set",
    "has_op",
    "known_passes",
    "sky_numbers",
    "sky_sun",
    "sky_table",
]
