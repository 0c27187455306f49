"""Scenes that light reaches from surface to surface."""

from __future__ import annotations

import math
from collections.abc import Callable

from common import (
    add_box,
    add_camera,
    add_mesh,
    add_rectangle,
    add_sphere,
    empty_scene,
    set_map,
    set_world,
)

RINGS, CUT = 96, 24  # of the cavity, from pole to pole, and how many its cap had


def cavity() -> None:
    """A hollow sphere without its cap, from inside: as bright everywhere, by a geometric series in
    the bounces."""
    scene = empty_scene(160, 120)
    around = 2 * RINGS
    vertices = []
    for ring in range(CUT, RINGS):
        theta = math.pi * ring / RINGS
        for k in range(around):
            phi = math.tau * k / around
            vertices.append(
                (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))
            )
    faces: list[tuple[int, ...]] = [
        (ring * around + k, ring * around + (k + 1) % around,
         (ring + 1) * around + (k + 1) % around, (ring + 1) * around + k)
        for ring in range(RINGS - CUT - 1)
        for k in range(around)
    ]  # fmt: skip
    last = len(vertices) - around
    vertices.append((0.0, 0.0, -1.0))
    faces += [(last + k, last + (k + 1) % around, len(vertices) - 1) for k in range(around)]
    add_mesh("Cavity", vertices, faces)
    add_camera((0.3, 0.1, 0.2), (0.1, 0.5, -1.0), lens=30.0)
    set_world()
    scene["shape"] = "cavity"
    scene["open_share"] = 0.5 - 0.5 * math.cos(math.pi * CUT / RINGS)


def interior() -> None:
    """A furnished room with two windows under a sky with a low sun: most of it sees no sky."""
    empty_scene(240, 160)
    add_rectangle("Floor", (-3.0, -2.5, 0.0), (6.0, 0.0, 0.0), (0.0, 5.0, 0.0))
    add_rectangle("Ceiling", (-3.0, -2.5, 2.6), (0.0, 5.0, 0.0), (6.0, 0.0, 0.0))
    add_rectangle("Left", (-3.0, -2.5, 0.0), (0.0, 5.0, 0.0), (0.0, 0.0, 2.6))
    add_rectangle("Back", (-3.0, 2.5, 0.0), (6.0, 0.0, 0.0), (0.0, 0.0, 2.6))
    add_rectangle("Behind", (-3.0, -2.5, 0.0), (0.0, 0.0, 2.6), (6.0, 0.0, 0.0))
    # The right wall has two windows: what is left of it are bars.
    for name, y, z, wide, high in (
        ("Below", -2.5, 0.0, 5.0, 0.9), ("Above", -2.5, 2.1, 5.0, 0.5),
        ("Near", -2.5, 0.9, 0.9, 1.2), ("Middle", -0.4, 0.9, 0.8, 1.2), ("Far", 1.6, 0.9, 0.9, 1.2),
    ):  # fmt: skip
        add_box(name, (0.2, wide, high), (3.1, y + wide / 2, z + high / 2))
    add_box("Table", (1.6, 0.9, 0.06), (0.2, 0.6, 0.75))
    for x in (-0.5, 0.9):
        for y in (0.25, 0.95):
            add_box("Leg", (0.07, 0.07, 0.72), (x, y, 0.36))
    add_sphere("Bowl", 0.2, (0.3, 0.6, 0.98), level=4)
    add_box("Shelf", (0.4, 1.8, 1.9), (-2.75, 0.9, 0.95))
    add_box("Chest", (1.0, 0.6, 0.6), (-1.6, -0.6, 0.3)).rotation_euler = (0.0, 0.0, 0.5)
    add_camera((1.4, -2.3, 1.5), (-0.6, 1.2, 0.9), lens=22.0)
    sun = (16.5 / 64, 20.5 / 32)
    sky, ground = (0.5, 0.8, 1.3), (0.25, 0.22, 0.18)

    def afternoon(x: float, y: float) -> tuple[float, float, float]:
        return (90.0, 75.0, 50.0) if (x, y) == sun else sky if y > 0.5 else ground

    set_map("Afternoon", 64, 32, afternoon)


SCENES: dict[str, Callable[[], None]] = {scene.__name__: scene for scene in (cavity, interior)}
