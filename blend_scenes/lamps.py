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


SCENES: dict[str, Callable[[], None]] = {"lamps": lamps}
