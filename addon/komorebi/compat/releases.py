"""Which of Blender's releases this is, and whether Cycles' settings are there."""

from __future__ import annotations

from typing import Any

import bpy

VERSION: tuple[int, int, int] = bpy.app.version

FLAT_RECTS = VERSION >= (4, 1, 0)  # rect.foreach_set wants one dimension instead of two
GENERIC_ATTRIBUTES = VERSION >= (3, 6, 0)  # position, .corner_vert, sharp_face are attributes
LONG_PASS_NAMES = VERSION >= (5, 0, 0)  # "Material Index", not "IndexMA"
FLAT_NORMAL_MAPS = VERSION < (4, 0, 0)  # strength leans the mapped normal, not the map's colour
NORMALS_AS_DIRECTIONS = VERSION < (4, 0, 0)  # so the node Vector Transform turned them
CORNER_NORMALS = VERSION >= (4, 1, 0)  # mesh.corner_normals, no auto smooth
NOISE_REPEATS = VERSION >= (4, 1, 0)  # every 100,000 cells, where floats lose places in a cell
VORONOI_PCG = VERSION >= (5, 0, 0)  # hashes cells of two dimensions and more
UNLIMITED_BOUNCES = 1024  # the most that a lamp's or world's setting can be
OLD_LAMPS = VERSION < (4, 0, 0)  # disks for balls, areas of a quarter of their power
# An image editor that is drawn while an engine hands over small tiles may come to wait for itself,
# and Blender stands still for ever. Seen in 5.2, with any engine; by whole pictures it was not.
WHOLE_RESULTS = VERSION >= (5, 1, 0)


def cycles_or(block: Any, otherwise: Any) -> Any:
    """Cycles' settings of a data-block, which artists have made; without Cycles, `otherwise`."""
    settings = getattr(block, "cycles", None)
    return otherwise if settings is None else settings
