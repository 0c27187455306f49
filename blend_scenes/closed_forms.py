"""Scenes whose ambient occlusion is known exactly; the formulas are with the tests that check them.

A scene's custom properties say what a checker needs: "shape" names the formula, lengths are in
metres. Each is seen from straight above by an orthographic camera where that is possible, so that
a pixel's point is plain.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
from common import (
    Point,
    add_box,
    add_camera,
    add_mesh,
    add_rectangle,
    add_sphere,
    empty_scene,
    set_world,
)

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
FAR = 3.0e4  # planes that stand for infinite ones reach this many metres


def add_plane(name: str, u: Point, v: Point, low_u: float = -FAR, low_v: float = -FAR) -> None:
    """A practically infinite plane through the origin, or the part of it from `low_u`, `low_v` up.

    It is a grid whose cells grow with their distance: a single triangle of 60 km would place a hit
    in itself no better than a float's 24 bits, 4 mm.
    """
    marks = [-FAR, -3.0e3, -3.0e2, -30.0, -8.0, 0.0, 8.0, 30.0, 3.0e2, 3.0e3, FAR]
    columns, rows = [m for m in marks if m >= low_u], [m for m in marks if m >= low_v]
    vertices = [[x * a + y * b for a, b in zip(u, v, strict=True)] for y in rows for x in columns]
    wide = len(columns)
    faces = [
        (row * wide + k, row * wide + k + 1, (row + 1) * wide + k + 1, (row + 1) * wide + k)
        for row in range(len(rows) - 1)
        for k in range(wide - 1)
    ]
    add_mesh(name, vertices, faces)


def plane_sphere() -> None:
    """A unit sphere rests on a plane: occlusion there is 1/d³, d the distance to the centre."""
    scene = empty_scene(240, 160)
    add_plane("Plane", X, Y)
    add_sphere("Sphere", 1.0, (0.0, 0.0, 1.0))
    add_camera((3.0, 0.0, 10.0), (3.0, 0.0, 0.0), ortho_scale=6.0, up=(0.0, 1.0, 0.0))
    set_world()
    scene["shape"] = "plane_sphere"


def corner_two() -> None:
    """A floor and a wall, both practically infinite: 1/2 everywhere on both."""
    scene = empty_scene(160, 120)
    add_plane("Floor", X, (0.0, -1.0, 0.0), low_v=0.0)
    add_plane("Wall", X, Z, low_v=0.0)
    add_camera((0.3, -3.0, 2.5), (0.0, -0.2, 0.2), lens=60.0)
    set_world()
    scene["shape"] = "corner_two"


def corner_three() -> None:
    """A floor and two walls, all practically infinite: 1/4 everywhere on all three."""
    scene = empty_scene(160, 120)
    add_plane("Floor", X, Y, 0.0, 0.0)
    add_plane("Wall X", Y, Z, 0.0, 0.0)
    add_plane("Wall Y", Z, X, 0.0, 0.0)
    add_camera((3.0, 2.6, 2.4), (0.3, 0.3, 0.3), lens=60.0)
    set_world()
    scene["shape"] = "corner_three"


def point_under_disk() -> None:
    """A floor under a disk of radius 1 at height 1, seen from between the two."""
    scene = empty_scene(160, 160)
    add_rectangle("Floor", (-50.0, -50.0, 0.0), (100.0, 0.0, 0.0), (0.0, 100.0, 0.0))
    sides = 1024
    angles = [2.0 * math.pi * k / sides for k in range(sides)]
    rim = [(math.cos(a), math.sin(a), 1.0) for a in angles]
    add_mesh(
        "Disk", [(0.0, 0.0, 1.0), *rim], [(0, 1 + k, 1 + (k + 1) % sides) for k in range(sides)]
    )
    add_camera((0.0, 0.0, 0.9), (0.0, 0.0, 0.0), ortho_scale=4.0, up=(0.0, 1.0, 0.0))
    set_world()
    scene["shape"] = "point_under_disk"
    scene["radius"], scene["height"] = 1.0, 1.0


def add_egg(name: str) -> bpy.types.Object:
    """A flat-shaded convex body of 1280 triangles."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=1.0, calc_uvs=False)
    egg = bpy.context.object
    egg.name, egg.scale, egg.rotation_euler = name, (1.0, 0.7, 1.25), (0.4, 0.3, 0.2)
    return egg


def convex() -> None:
    """An egg and nothing else under a white sky: ambient occlusion is 1 everywhere."""
    empty_scene(160, 120)
    add_egg("Egg")
    add_camera((3.0, -3.0, 2.0), (0.0, 0.0, 0.0), lens=60.0)
    set_world()
    bpy.context.scene["shape"] = "convex"


def furnace() -> None:
    """An egg of albedo 1 in a sky of radiance 2.5 vanishes in it, mirrored and squeezed as it
    is."""
    empty_scene(160, 120)
    add_egg("Egg").scale = (-1.0, 0.6, 1.3)
    add_camera((3.0, -3.0, 2.0), (0.0, 0.0, 0.0), lens=60.0)
    set_world((2.5, 2.5, 2.5))
    bpy.context.scene["shape"] = "furnace"


def room() -> None:
    """A closed box seen from inside: 0 everywhere, at every edge and corner, however thin the
    walls."""
    empty_scene(160, 120)
    add_box("Room", (4.0, 4.0, 3.0))
    add_camera((1.6, -1.6, 0.9), (-1.0, 1.0, -0.4), lens=18.0)
    set_world()
    bpy.context.scene["shape"] = "room"


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene
    for scene in (plane_sphere, corner_two, corner_three, point_under_disk, convex, furnace, room)
}
