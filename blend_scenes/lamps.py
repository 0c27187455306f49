"""Scenes that lamps light."""

from __future__ import annotations

from collections.abc import Callable
from math import radians

import bpy
from common import add_box, add_camera, add_rectangle, add_sphere, empty_scene, link, set_world
from mathutils import Euler, Matrix, Vector

# name, kind, settings, turn in degrees, stretch
LAMPS = (
    ("Point", "POINT", {"shadow_soft_size": 0.0}, (0, 0, 0), (1, 1, 1)),
    ("Ball", "POINT", {"shadow_soft_size": 0.35}, (0, 0, 0), (1, 1, 1)),
    ("Spot", "SPOT", {"shadow_soft_size": 0.0, "spot_size": radians(80), "spot_blend": 0.4},
     (20, 10, 0), (1, 1, 1)),
    ("Stretched spot", "SPOT",
     {"shadow_soft_size": 0.2, "spot_size": radians(50), "spot_blend": 0.0}, (0, 0, 30), (2, 1, 1)),
    ("Square", "AREA", {"shape": "SQUARE", "size": 0.8}, (0, 0, 20), (1, 1, 1)),
    ("Rectangle", "AREA", {"shape": "RECTANGLE", "size": 1.6, "size_y": 0.1}, (0, 60, 40),
     (1, 1, 1)),
    ("Disk", "AREA", {"shape": "DISK", "size": 0.8}, (-40, 0, 0), (1.5, 1, 1)),
    ("Ellipse", "AREA", {"shape": "ELLIPSE", "size": 0.4, "size_y": 1.2, "spread": radians(90)},
     (0, 20, 0), (1, 1, 1)),
    ("Narrow", "AREA", {"shape": "RECTANGLE", "size": 1.0, "size_y": 0.7, "spread": radians(15)},
     (15, 0, 0), (1, 1, 1)),
)  # fmt: skip


def add_lamp(name: str, kind: str, **settings: object) -> bpy.types.Object:
    """A light object at the origin; `settings` are properties of its data."""
    light = bpy.data.lights.new(name, kind)
    for key, value in settings.items():
        setattr(light, key, value)
    return link(bpy.data.objects.new(name, light))


def lamps() -> None:
    """A lamp of each shape over a block and a ball of its own, two more made by instances of a
    collection, and a low sun over all."""
    empty_scene(320, 320)
    add_rectangle("Floor", (-6.0, -6.0, 0.0), (12.0, 0.0, 0.0), (0.0, 12.0, 0.0))
    for i, (name, kind, settings, turn, stretch) in enumerate(LAMPS):
        place = Vector((3.4 * (i % 3 - 1), 3.4 * (i // 3 - 1), 0.0))
        lamp = add_lamp(name, kind, energy=25.0, **settings)
        lamp.data.color = [(1.0, 0.8, 0.6), (0.7, 1.0, 0.8), (0.6, 0.8, 1.0)][i % 3]
        turned = Euler([radians(a) for a in turn]).to_matrix().to_4x4()
        scaled = Matrix.Diagonal((*stretch, 1.0))
        lamp.matrix_world = Matrix.Translation(place + Vector((0.1, 0.0, 1.7))) @ turned @ scaled
        add_box(f"Block, {name}", (0.5, 0.2, 0.6), place + Vector((-0.5, 0.3, 0.3)))
        add_sphere(f"Ball, {name}", 0.25, place + Vector((0.5, -0.3, 0.25)), level=5)
    sun = add_lamp("Sun", "SUN", energy=0.4, angle=radians(12.0))
    sun.rotation_euler = (radians(55.0), 0.0, radians(30.0))
    stock = bpy.data.collections.new("Stock")
    lamp = add_lamp("In a collection", "POINT", energy=6.0, shadow_soft_size=0.1)
    lamp.data.color = (1.0, 0.3, 0.3)
    bpy.context.scene.collection.objects.unlink(lamp)
    link(lamp, stock)
    for x in (-1.7, 1.7):
        empty = link(bpy.data.objects.new("Instance", None))
        empty.instance_type, empty.instance_collection = "COLLECTION", stock
        empty.location = (x, 1.7, 0.6)
    add_camera((0.0, -9.0, 12.0), (0.0, -0.4, 0.0), lens=38.0)
    set_world((0.0, 0.0, 0.0))


def add_nodes(lamp: bpy.types.Object, falloff: str, smooth: float, kelvin: float) -> None:
    """Light of a temperature that falls off in a way of its own, halved by a Math node."""
    lamp.data.use_nodes = True
    tree = lamp.data.node_tree
    emission = tree.nodes["Emission"]
    node, half = tree.nodes.new("ShaderNodeLightFalloff"), tree.nodes.new("ShaderNodeMath")
    node.inputs["Strength"].default_value, node.inputs["Smooth"].default_value = 1.6, smooth
    half.operation, half.inputs[1].default_value = "MULTIPLY", 0.5
    tree.links.new(node.outputs[falloff], half.inputs[0])
    tree.links.new(half.outputs[0], emission.inputs["Strength"])
    blackbody = tree.nodes.new("ShaderNodeBlackbody")
    blackbody.inputs[0].default_value = kelvin
    tree.links.new(blackbody.outputs[0], emission.inputs["Color"])


def lamp_nodes() -> None:
    """A corner with a ball and a block, in the light of lamps with nodes of every falloff, two of
    which bounce less often than the others."""
    empty_scene(320, 240)
    add_rectangle("Floor", (-4.0, -4.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))
    add_rectangle("Wall", (-4.0, 3.0, 0.0), (8.0, 0.0, 0.0), (0.0, 0.0, 5.0))
    add_rectangle("Side", (-3.0, -4.0, 0.0), (0.0, 8.0, 0.0), (0.0, 0.0, 5.0))
    add_box("Block", (1.2, 0.5, 1.6), (-0.9, 1.2, 0.8))
    add_sphere("Ball", 0.6, (0.9, 0.4, 0.6), level=5)
    things = (
        ("Quadratic", "POINT", {"shadow_soft_size": 0.3, "energy": 30.0}, 2.0, 4000.0, 1024),
        ("Linear", "AREA", {"shape": "RECTANGLE", "size": 1.2, "size_y": 0.5, "energy": 10.0}, 0.0,
         2500.0, 1024),
        ("Constant", "SPOT", {"shadow_soft_size": 0.0, "energy": 12.0, "spot_size": radians(70)},
         1.0, 8000.0, 1),
        ("Quadratic", "POINT", {"shadow_soft_size": 0.0, "energy": 40.0}, 0.0, 12000.0, 0),
    )  # fmt: skip
    places = ((-2.0, -1.0, 1.5), (1.5, 1.5, 3.5), (2.0, -2.0, 3.0), (0.0, 2.2, 0.8))
    for (falloff, kind, given, smooth, kelvin, bounces), place in zip(things, places, strict=True):
        lamp = add_lamp(falloff, kind, **given)
        lamp.location = place
        add_nodes(lamp, falloff, smooth, kelvin)
        lamp.data.cycles.max_bounces = bounces
    add_camera((3.5, -6.0, 3.6), (-0.4, 0.6, 1.0), lens=32.0)
    set_world((0.0, 0.0, 0.0))


SCENES: dict[str, Callable[[], None]] = {"lamps": lamps, "lamp_nodes": lamp_nodes}
