"""The demo: sunlight through leaves (木漏れ日) on a stone stair that climbs to a gate."""

from __future__ import annotations

import random

import bpy
from common import add_camera, add_rectangle, empty_scene, link, set_world
from mathutils import Vector

from demo.gate import add_gate, add_lanterns
from demo.looks import paint
from demo.scatter import scatter
from demo.stone import STEP_RISE, STEP_RUN, STEPS, add_banks, add_steps, add_turned, ground_height
from demo.tree import add_branches, add_leaf, branch_lines, twig_points


def fallen(count: int, rng: random.Random) -> list[Vector]:
    """Points just above the treads, where leaves have fallen."""
    points = []
    for _ in range(count):
        y = rng.uniform(-2.4, STEPS * STEP_RUN + 2.0)
        tread = (y // STEP_RUN) * STEP_RUN
        top = ground_height(tread) if tread < STEPS * STEP_RUN else STEPS * STEP_RISE
        points.append(Vector((rng.triangular(-1.45, 1.45, rng.choice((-1.4, 1.4))), y, top + 0.03)))
    return points


def add_bamboo(rng: random.Random, stock: bpy.types.Collection) -> list[Vector]:
    """A grove on both banks and behind the gate; returns places for its leaves."""
    profile = []
    for joint in range(24):
        z, r = 0.42 * joint, 0.058 * (1.0 - 0.022 * joint)
        rings = ((r, 0.02), (0.94 * r, 0.05), (0.94 * r, 0.38), (1.1 * r, 0.41))
        profile += [(radius, z + rise) for radius, rise in rings]
    culm = add_turned("Culm", profile, 10)
    culm.data.polygons.foreach_set("use_smooth", [True] * len(culm.data.polygons))
    bpy.context.scene.collection.objects.unlink(culm)
    link(culm, stock)
    feet, leaves = [], []
    for _ in range(300):
        y = rng.uniform(4.0, 19.0)
        beside = rng.choice((-1.0, 1.0)) * rng.uniform(3.6, 11.0)
        x = beside if y < 12.5 else rng.uniform(-11.0, 11.0)
        foot = Vector((x, y, ground_height(y) + 0.2 * abs(x) - 0.9))
        feet.append(foot)
        for _ in range(9):
            spread = Vector([rng.gauss(0.0, 0.45), rng.gauss(0.0, 0.45), rng.uniform(4.5, 10.0)])
            leaves.append(foot + spread)
    scatter("Bamboo", feet, culm, 0.06, (0.75, 1.2))
    return leaves


def build() -> None:
    """The whole scene: 1280 × 720, about two million triangles, most of them instances."""
    scene = empty_scene(1280, 720)
    rng = random.Random(20)
    stock = bpy.data.collections.new("Scattered")
    bpy.context.scene.collection.children.link(stock)
    add_steps(rng)
    add_banks(rng, stock)
    add_rectangle("Ground", (-40.0, -10.0, -0.4), (80.0, 0.0, 0.0), (0.0, 80.0, 0.0))
    add_gate(STEPS * STEP_RUN + 0.9)
    add_lanterns([(-1.95, -0.5), (1.95, -0.5), (-1.95, 4.2), (1.95, 4.2)])
    leaf, blade = add_leaf("Leaf", 0.15, 1.0, stock), add_leaf("Blade", 0.30, 0.45, stock)
    roots = [
        (Vector((-3.5, 1.3, 0.3)), Vector((0.40, 0.10, 1.0)), 4.6, 0.25),
        (Vector((3.3, 3.4, 1.5)), Vector((-0.26, -0.36, 1.0)), 4.4, 0.20),
    ]
    lines = [line for root in roots for line in branch_lines(*root, 3, rng)]
    add_branches("Branches", lines)
    scatter("Foliage", twig_points(lines, 0.05, 0.085, 0.15, rng), leaf, 0.8, (0.7, 1.25))
    scatter("Fallen leaves", fallen(420, rng), leaf, 0.25, (0.5, 0.9))
    scatter("Bamboo leaves", add_bamboo(rng, stock), blade, 1.2, (0.6, 1.2))
    add_camera((0.55, -5.0, 1.30), (-0.05, 6.0, 3.15), lens=27.0)
    set_world((0.80, 0.88, 1.0))
    paint()
    scene.render.resolution_percentage = 75
    scene["komorebi"] = {"samples": 64}  # where the add-on keeps its properties: a minute a picture
    scene["studio_light"], scene["studio_light_rotation"] = "sunrise", (45.0, 0.0, 84.0)
