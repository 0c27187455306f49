"""The demo's gate with its name plate, and the stone lanterns beside the stair."""

from __future__ import annotations

import math

import bpy
from common import add_box, add_mesh, link
from mathutils import Matrix, Vector

from demo.stone import add_turned, ground_height


def add_beam(
    name: str, half: float, depth: float, height: float, lift: float, centre: Vector
) -> bpy.types.Object:
    """A lintel whose ends sweep up by `lift` metres; `half` is half its length."""
    pieces = 24
    vertices, faces = [], []
    for i in range(pieces + 1):
        s = 2.0 * i / pieces - 1.0
        z = lift * abs(s) ** 2.6
        x = half * s
        slant = 0.10 * s * abs(s) ** 6
        for dx, y, dz in (
            (0.0, -depth, 0.0),
            (slant, -1.25 * depth, height),
            (slant, 1.25 * depth, height),
            (0.0, depth, 0.0),
        ):
            vertices.append((x + dx, y, z + dz))
    for i in range(pieces):
        faces += [
            (4 * i + k, 4 * i + 4 + k, 4 * i + 4 + (k + 1) % 4, 4 * i + (k + 1) % 4)
            for k in range(4)
        ]
    faces += [(0, 1, 2, 3), tuple(4 * pieces + k for k in (3, 2, 1, 0))]
    beam = add_mesh(name, vertices, faces)
    beam.location = centre
    edge = beam.modifiers.new("Edges", "BEVEL")
    edge.width, edge.segments, edge.limit_method = 0.012, 2, "ANGLE"
    return beam


def add_gate(y: float) -> None:
    """A torii at depth `y`: two leaning pillars, tie beam, two lintels and a plate that reads
    木漏れ日."""
    base = ground_height(y)
    for side in (-1.0, 1.0):
        pillar = add_turned(
            "Pillar", [(0.26, -0.2), (0.26, 0.22), (0.22, 0.24), (0.17, 0.25), (0.145, 3.05)], 32
        )
        pillar.location = (side * 1.42, y, base)
        pillar.rotation_euler = (0.0, -side * 0.035, 0.0)
    add_box("Tie beam", (3.5, 0.14, 0.24), (0.0, y, base + 2.42))
    add_beam("Lower lintel", 2.0, 0.13, 0.17, 0.20, Vector((0.0, y, base + 3.02)))
    add_beam("Upper lintel", 2.2, 0.18, 0.20, 0.27, Vector((0.0, y, base + 3.20)))
    add_box("Plate", (0.36, 0.10, 0.62), (0.0, y - 0.06, base + 2.78))
    for x in (-0.19, 0.19):
        add_box("Frame", (0.03, 0.14, 0.68), (x, y - 0.06, base + 2.78))
    text = bpy.data.curves.new("Name", "FONT")
    text.body = "木\n漏\nれ\n日"
    text.size, text.extrude, text.bevel_depth, text.space_line = 0.155, 0.014, 0.002, 0.86
    text.align_x, text.align_y = "CENTER", "CENTER"
    name = link(bpy.data.objects.new("Name", text))
    name.matrix_world = Matrix.Translation((0.0, y - 0.12, base + 2.785)) @ Matrix.Rotation(
        math.pi / 2, 4, "X"
    )


def add_lanterns(places: list[tuple[float, float]]) -> None:
    """Stone lanterns at (x, y): one set of meshes, linked copies at every place."""
    parts = [
        add_turned(
            "Foot",
            [
                (0.30, -0.3),
                (0.30, 0.10),
                (0.24, 0.16),
                (0.13, 0.20),
                (0.105, 0.30),
                (0.105, 0.78),
                (0.14, 0.82),
            ],
            24,
        ),
        add_turned("Table", [(0.12, 0.82), (0.29, 0.93), (0.29, 0.99), (0.22, 1.01)], 6),
        add_turned("Core", [(0.10, 1.0), (0.10, 1.32)], 12),
        add_turned(
            "Roof", [(0.20, 1.30), (0.44, 1.31), (0.46, 1.36), (0.27, 1.47), (0.10, 1.57)], 6
        ),
        add_turned(
            "Jewel",
            [(0.06, 1.56), (0.10, 1.60), (0.085, 1.66), (0.10, 1.70), (0.075, 1.77), (0.012, 1.86)],
            24,
        ),
    ]
    for k in range(6):
        angle = 2.0 * math.pi * (k + 0.5) / 6
        post = add_box(
            "Post", (0.05, 0.05, 0.32), (0.19 * math.cos(angle), 0.19 * math.sin(angle), 1.16)
        )
        post.rotation_euler[2] = angle
        parts.append(post)
    lantern = bpy.data.collections.new("Lantern")
    for part in parts:
        bpy.context.scene.collection.objects.unlink(part)
        link(part, lantern)
    for x, y in places:
        copy = link(bpy.data.objects.new("Lantern", None))
        copy.instance_type, copy.instance_collection = "COLLECTION", lantern
        copy.location = (x, y, ground_height(y) + 0.05)
