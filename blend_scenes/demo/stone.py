"""The demo's stonework: worn steps, boulders, lanterns and the gate."""

from __future__ import annotations

import math
import random

import bpy
from common import add_mesh, link
from mathutils import Matrix, Vector, noise

from demo.scatter import scatter

STEP_RISE, STEP_RUN, STEPS = 0.17, 0.44, 16


def ground_height(y: float) -> float:
    """Height in metres of the stair's slope at depth `y`."""
    return max(0.0, min(y / STEP_RUN + 1.0, float(STEPS))) * STEP_RISE


def block(size: Vector, centre: Vector, turn: float, rng: random.Random) -> list[Vector]:
    """The eight corners of a slightly crooked block."""
    spin = Matrix.Rotation(turn, 3, "Z")
    corners = [Vector((x, y, z)) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    worn = [Vector([rng.uniform(-0.012, 0.012) for _ in range(3)]) for _ in corners]
    return [
        centre + spin @ Vector([c * s for c, s in zip(corner, size, strict=False)]) + w
        for corner, w in zip(corners, worn, strict=False)
    ]


def add_blocks(name: str, blocks: list[list[Vector]], bevel: float) -> bpy.types.Object:
    """One mesh of bevelled blocks."""
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    vertices = [v for corners in blocks for v in corners]
    faces = [tuple(8 * i + k for k in quad) for i in range(len(blocks)) for quad in quads]
    thing = add_mesh(name, vertices, faces)
    edge = thing.modifiers.new("Worn edges", "BEVEL")
    edge.width, edge.segments = bevel, 2
    return thing


def add_steps(rng: random.Random) -> None:
    """Steps of four to six slabs each, with open joints, and a paved landing in front of them."""
    blocks = []
    for step in range(-7, STEPS + 9):
        x, y = -1.5, step * STEP_RUN
        top = ground_height(y) if step < STEPS else STEPS * STEP_RISE
        while x < 1.45:
            width = min(rng.uniform(0.38, 0.85), 1.5 - x)
            width = 1.5 - x if 1.5 - x - width < 0.25 else width
            centre = Vector(
                (
                    x + width / 2,
                    y + STEP_RUN / 2 + rng.uniform(-0.012, 0.012),
                    top - 0.14 + rng.uniform(-0.012, 0.012),
                )
            )
            size = Vector((width - 0.022, STEP_RUN - 0.016, 0.28))
            blocks.append(block(size, centre, rng.uniform(-0.012, 0.012), rng))
            x += width
    add_blocks("Steps", blocks, 0.018)


def boulder_mesh(name: str, rng: random.Random) -> bpy.types.Mesh:
    """A rock of about half a metre: a ball of noise cut by fourteen random planes, smooth
    shaded."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1.0, calc_uvs=False)
    rock = bpy.context.object
    shift = Vector([rng.uniform(-50.0, 50.0) for _ in range(3)])
    cuts = [
        (Vector([rng.gauss(0.0, 1.0) for _ in range(3)]).normalized(), rng.uniform(0.33, 0.45))
        for _ in range(14)
    ]
    for vertex in rock.data.vertices:
        way = vertex.co.normalized()
        radius = 0.56 + 0.07 * noise.noise(way * 2.3 + shift)
        for normal, distance in cuts:
            if way.dot(normal) > 0.05:
                radius = min(radius, distance / way.dot(normal))
        radius += 0.012 * noise.noise(way * 7.0 + shift)
        # Coarse steps squeeze better, and a tenth of a millimetre does not show.
        vertex.co = [round(c * radius * 4096.0) / 4096.0 for c in way]
    mesh = rock.data
    mesh.name = name
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    bpy.data.objects.remove(rock)
    return mesh


def add_banks(rng: random.Random, stock: bpy.types.Collection) -> None:
    """Boulders of four kinds, scattered along both sides of the stair and up its banks."""
    places: list[list[Vector]] = [[], [], [], []]
    for side in (-1.0, 1.0):
        for row in range(38):
            for column in range(9):
                y = -2.6 + 0.36 * row + rng.uniform(-0.14, 0.14)
                out = 0.30 + 0.44 * column + rng.uniform(-0.10, 0.10)
                height = ground_height(y) + 0.02 + 0.24 * out + 0.08 * math.sin(2.1 * y + column)
                rng.choice(places).append(Vector((side * (1.5 + out), y, height)))
    for index, points in enumerate(places):
        mesh = boulder_mesh(f"Boulder {index}", rng)
        rock = link(bpy.data.objects.new(mesh.name, mesh), stock)
        rounding = rock.modifiers.new("Rounding", "SUBSURF")
        rounding.levels = rounding.render_levels = 1
        scatter(f"Boulders {index}", points, rock, math.pi, (0.8, 1.45))


def add_turned(name: str, profile: list[tuple[float, float]], sides: int) -> bpy.types.Object:
    """A body of `sides` sides from a profile of (radius, height), closed at both ends."""
    ring = [
        (math.cos(2 * math.pi * (k + 0.5) / sides), math.sin(2 * math.pi * (k + 0.5) / sides))
        for k in range(sides)
    ]
    vertices = [(r * c, r * s, z) for r, z in profile for c, s in ring]
    faces = [
        (
            row * sides + k,
            row * sides + (k + 1) % sides,
            (row + 1) * sides + (k + 1) % sides,
            (row + 1) * sides + k,
        )
        for row in range(len(profile) - 1)
        for k in range(sides)
    ]
    last = (len(profile) - 1) * sides
    faces += [tuple(reversed(range(sides))), tuple(last + k for k in range(sides))]
    return add_mesh(name, vertices, faces)
