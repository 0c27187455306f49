"""The demo's trees: branches are one curve object, leaves are geometry-nodes instances on its
twigs."""

from __future__ import annotations

import itertools
import math
import random

import bpy
from common import add_mesh, link
from mathutils import Matrix, Vector

Line = list[tuple[Vector, float]]


def branch_lines(
    root: Vector, direction: Vector, length: float, radius: float, levels: int, rng: random.Random
) -> list[Line]:
    """Polylines of (point, radius): a limb that bends at random and carries thinner limbs,
    `levels` deep."""
    steps = 8
    point, heading = root.copy(), direction.normalized()
    line: Line = [(point.copy(), radius)]
    lines: list[Line] = [line]
    for step in range(1, steps + 1):
        bend = Vector([rng.uniform(-1.0, 1.0) for _ in range(3)])
        heading = (heading + 0.16 * bend + Vector((0.0, 0.0, 0.04))).normalized()
        point = point + heading * (length / steps)
        thickness = radius * (1.0 - 0.7 * step / steps)
        line.append((point.copy(), thickness))
        if levels > 0 and step >= (4 if levels == 3 else 2):
            for _ in range(3 if step == steps else 1):
                axis = (
                    Matrix.Rotation(rng.uniform(0.0, 2.0 * math.pi), 3, heading)
                    @ heading.orthogonal().normalized()
                )
                side = Matrix.Rotation(rng.uniform(0.55, 1.0), 3, axis) @ heading
                side.z = max(side.z, -0.05)
                lines += branch_lines(
                    point, side, length * rng.uniform(0.48, 0.66), thickness * 0.75, levels - 1, rng
                )
    return lines


def add_branches(name: str, lines: list[Line]) -> bpy.types.Object:
    """All limbs as one bevelled curve object: a spline each, its radius from the line."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.resolution_u = (
        "3D",
        1.0,
        2,
        2,
    )
    curve.use_fill_caps = True
    for line in lines:
        spline = curve.splines.new("POLY")
        spline.points.add(len(line) - 1)
        for target, (point, radius) in zip(spline.points, line, strict=False):
            target.co, target.radius = (*point, 1.0), radius
    return link(bpy.data.objects.new(name, curve))


def add_leaf(
    name: str, length: float, breadth: float, collection: bpy.types.Collection
) -> bpy.types.Object:
    """A leaf folded along its rib, stem at the origin, pointing along +Y: 8 quads."""
    widths = [breadth * w for w in (0.03, 0.26, 0.30, 0.19, 0.01)]
    vertices, faces = [], []
    for row, width in enumerate(widths):
        y = row / (len(widths) - 1)
        droop = -0.22 * y * y
        for side in (-1.0, 0.0, 1.0):
            vertices.append(
                (side * width * length, y * length, (droop + 0.35 * abs(side) * width) * length)
            )
    for row in range(len(widths) - 1):
        for side in range(2):
            a = row * 3 + side
            faces.append((a, a + 1, a + 4, a + 3))
    leaf = add_mesh(name, vertices, faces, smooth=True)
    bpy.context.scene.collection.objects.unlink(leaf)
    return link(leaf, collection)


def twig_points(
    lines: list[Line], thinner_than: float, gap: float, spread: float, rng: random.Random
) -> list[Vector]:
    """Places for leaves: along every limb thinner than `thinner_than`, about `gap` metres apart."""
    points = []
    for line in lines:
        for (start, radius), (end, _) in itertools.pairwise(line):
            if radius > thinner_than:
                continue
            for _ in range(max(1, round((end - start).length / gap))):
                place = start.lerp(end, rng.random()) + Vector(
                    [rng.gauss(0.0, spread) for _ in range(3)]
                )
                points.append(place)
    return points
