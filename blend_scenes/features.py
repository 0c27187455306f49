"""Scenes that hold one kind of thing each: what an exporter has to get right, small enough to look
at."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import bpy
from common import (
    add_box,
    add_camera,
    add_mesh,
    add_rectangle,
    add_sphere,
    empty_scene,
    link,
    set_world,
)
from demo.scatter import scatter
from demo.tree import add_leaf
from mathutils import Matrix, Vector


def ground(size: float = 20.0) -> bpy.types.Object:
    """A square floor at height 0."""
    return add_rectangle(
        "Ground", (-size, -size, 0.0), (2.0 * size, 0.0, 0.0), (0.0, 2.0 * size, 0.0)
    )


def hidden(thing: bpy.types.Object, collection: bpy.types.Collection) -> bpy.types.Object:
    """Move `thing` into a collection that is not in the scene itself."""
    bpy.context.scene.collection.objects.unlink(thing)
    return link(thing, collection)


def copies(name: str, of: bpy.types.Collection, matrix: Matrix) -> bpy.types.Object:
    """An empty that instances a collection."""
    empty = link(bpy.data.objects.new(name, None))
    empty.instance_type, empty.instance_collection = "COLLECTION", of
    empty.matrix_world = matrix
    return empty


def instance_forest() -> None:
    """Instances of every kind: collections in collections, mirrored and sheared, geometry nodes,
    faces, vertices."""
    empty_scene(320, 180)
    rng = random.Random(3)
    ground()
    tree, grove = bpy.data.collections.new("Tree"), bpy.data.collections.new("Grove")
    hidden(add_box("Trunk", (0.14, 0.14, 1.0), (0.0, 0.0, 0.5)), tree)
    for k in range(3):
        ring = [
            (math.cos(a) * (0.62 - 0.15 * k), math.sin(a) * (0.62 - 0.15 * k))
            for a in [math.tau * i / 9 for i in range(9)]
        ]
        low, tip = 0.5 + 0.42 * k, 1.25 + 0.42 * k
        cone = add_mesh(
            f"Cone {k}",
            [(0.0, 0.0, tip), *((x, y, low) for x, y in ring)],
            [(0, 1 + i, 1 + (i + 1) % 9) for i in range(9)],
        )
        hidden(cone, tree)
    for _ in range(7):
        turn = Matrix.Rotation(rng.uniform(0.0, math.tau), 4, "Z")
        place = Matrix.Translation((rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), 0.0))
        inner = copies("Tree", tree, place @ turn @ Matrix.Scale(rng.uniform(0.6, 1.3), 4))
        hidden(inner, grove)
    for row in range(5):
        for column in range(5):
            mirror = Matrix.Scale(-1.0 if (row + column) % 2 else 1.0, 4, (1.0, 0.0, 0.0))
            lean = Matrix.Shear("XY", 4, (0.15 * (row - 2), 0.0))
            copies(
                "Grove",
                grove,
                Matrix.Translation((5.0 * (column - 2), 5.0 * row - 4.0, 0.0)) @ lean @ mirror,
            )
    stock = bpy.data.collections.new("Leaves")
    bpy.context.scene.collection.children.link(stock)
    leaf = add_leaf("Leaf", 0.5, 1.0, stock)
    scatter(
        "Litter",
        [Vector((rng.uniform(-6, 6), rng.uniform(-8, 0), 0.1)) for _ in range(600)],
        leaf,
        0.5,
        (0.5, 1.0),
    )
    add_camera((0.5, -12.0, 4.5), (0.0, 0.0, 0.6), lens=30.0)
    set_world()


def text_curves_metaballs() -> None:
    """Text, a bevelled curve, a NURBS surface and metaballs: everything that becomes a mesh only
    on request."""
    empty_scene(320, 180)
    ground()
    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.size, text.extrude, text.bevel_depth, text.align_x = (
        "Komorebi",
        1.0,
        0.12,
        0.02,
        "CENTER",
    )
    sign = link(bpy.data.objects.new("Text", text))
    sign.matrix_world = Matrix.Translation((0.0, -0.6, 0.02)) @ Matrix.Rotation(math.pi / 2, 4, "X")
    curve = bpy.data.curves.new("Spiral", "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution = "3D", 0.09, 4
    spline = curve.splines.new("NURBS")
    spline.points.add(39)
    for k, point in enumerate(spline.points):
        angle = 0.45 * k
        point.co = (
            -2.4 + 0.6 * math.cos(angle),
            1.2 + 0.6 * math.sin(angle),
            0.12 + 0.045 * k,
            1.0,
        )
    spline.use_endpoint_u, spline.order_u = True, 4
    link(bpy.data.objects.new("Spiral", curve))
    bpy.ops.surface.primitive_nurbs_surface_torus_add(radius=0.6, location=(2.4, 1.3, 0.5))
    ball = bpy.data.metaballs.new("Blob")
    ball.resolution = ball.render_resolution = 0.12
    for x, y, z, r in ((0.0, 1.2, 0.55, 0.8), (0.6, 1.5, 0.9, 0.6), (-0.5, 1.1, 1.1, 0.55)):
        element = ball.elements.new()
        element.co, element.radius = (x, y, z), r
    link(bpy.data.objects.new("Blob", ball))
    add_camera((0.8, -6.5, 3.0), (0.0, 0.3, 0.5), lens=36.0)
    set_world()


def orientation() -> None:
    """Six labelled axes and a sky with six colours, turned by 30° through a Mapping node, the
    picture packed."""
    empty_scene(320, 240)
    add_sphere("Ball", 0.7, (0.0, 0.0, 0.0), level=5)
    for axis, letter in enumerate("XYZ"):
        for sign in (1.0, -1.0):
            way = Vector([sign if k == axis else 0.0 for k in range(3)])
            rod = add_box(
                f"Rod {letter}", [1.2 if k == axis else 0.08 for k in range(3)], way * 1.0
            )
            rod.scale = (1.0, 1.0, 1.0)
            text = bpy.data.curves.new("Label", "FONT")
            text.body, text.size, text.extrude = ("+" if sign > 0 else "-") + letter, 0.4, 0.03
            text.align_x = text.align_y = "CENTER"
            label = link(bpy.data.objects.new(f"Label {text.body}", text))
            label.matrix_world = (
                Matrix.Translation(way * 1.85)
                @ Matrix.Rotation(0.8, 4, "Z")
                @ Matrix.Rotation(1.1, 4, "X")
            )
    world, width, height = set_world(), 64, 32
    image = bpy.data.images.new("Six colours", width, height, float_buffer=True)
    colours = {
        (0, 1): (4, 0.4, 0.4),
        (0, -1): (0.1, 0.8, 0.8),
        (1, 1): (0.4, 4, 0.4),
        (1, -1): (0.8, 0.1, 0.8),
        (2, 1): (0.4, 0.4, 4),
        (2, -1): (0.8, 0.8, 0.1),
    }
    pixels: list[float] = []
    for row in range(height):
        for column in range(width):
            turn, rise = (
                -math.tau * ((column + 0.5) / width - 0.5),
                math.pi * ((row + 0.5) / height - 0.5),
            )
            way = (math.cos(turn) * math.cos(rise), math.sin(turn) * math.cos(rise), math.sin(rise))
            axis = max(range(3), key=lambda k: abs(way[k]))
            pixels += [*colours[axis, 1 if way[axis] > 0 else -1], 1.0]
    image.pixels.foreach_set(pixels)
    image.pack()
    nodes, links = world.node_tree.nodes, world.node_tree.links
    where, turned, sky = (
        nodes.new("ShaderNodeTexCoord"),
        nodes.new("ShaderNodeMapping"),
        nodes.new("ShaderNodeTexEnvironment"),
    )
    turned.inputs["Rotation"].default_value = (0.0, 0.0, math.radians(30.0))
    sky.image = image
    links.new(where.outputs["Generated"], turned.inputs["Vector"])
    links.new(turned.outputs["Vector"], sky.inputs["Vector"])
    links.new(sky.outputs["Color"], nodes["Background"].inputs["Color"])
    add_camera((3.6, -4.4, 2.6), (0.0, 0.0, 0.0), lens=40.0)


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (instance_forest, text_curves_metaballs, orientation)
}
