"""Runs inside Blender: makes one of the bench's scenes from a mesh and saves it.

    PYTHON_WITH_BPY tests/bench/inside/make_scene.py -- KIND MESH.npz OUT.blend

KIND is dragon (on a ground), interior (a hall seen from within), instances (10,000 dragons, made
by Blender's instancing on faces), leaves (the dragon in a grove of cards with pictures of leaves) or
sky (the dragon on tiles under a Sky Texture). MESH.npz holds positions float32 [V, 3], y up, and corners int32
[T, 3].
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "blend_scenes"))

from common import add_camera, add_rectangle, empty_scene, link, set_world
from materials import leaf, leaf_color, tile_color
from nodes import add, diffuse, material, picture

SIDE = 100  # instances along each side of the field
SPACING = 2.6  # metres from one to the next


def mesh_object(name: str, positions: np.ndarray, corners: np.ndarray) -> Any:
    """A triangle mesh, flat shaded, as Blender's own importers would leave it."""
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(positions))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(corners, np.int32).ravel())
    mesh.polygons.add(len(corners))
    size = corners.shape[1]
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, size, dtype=np.int32))
    if bpy.app.version < (3, 6, 0):
        mesh.polygons.foreach_set("loop_total", np.full(len(corners), size, np.int32))
    mesh.update(calc_edges=True)
    mesh.validate()
    return link(bpy.data.objects.new(name, mesh))


def standing(positions: np.ndarray, height: float) -> np.ndarray:
    """y up made z up, scaled to `height` metres, middle on the z axis, feet at z = 0."""
    points = positions[:, [0, 2, 1]].astype(np.float64) * [1.0, -1.0, 1.0]
    low, high = points.min(axis=0), points.max(axis=0)
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    return np.asarray((points - middle) * (height / (high[2] - low[2])))


def dragon(positions: np.ndarray, corners: np.ndarray) -> None:
    """The dragon on a ground that fills the rest of the frame: no pixel sees the sky."""
    mesh_object("Dragon", standing(positions, 1.44), corners)
    add_rectangle("Ground", (-60.0, -60.0, 0.0), (120.0, 0.0, 0.0), (0.0, 120.0, 0.0))
    add_camera((1.0, -4.0, 1.75), (0.0, 0.0, 0.68), lens=50.0)


def interior(positions: np.ndarray, corners: np.ndarray) -> None:
    """Along the middle of a hall of 35 × 16 × 17 metres whose roof is open."""
    mesh_object("Hall", positions[:, [0, 2, 1]] * np.array([1.0, -1.0, 1.0], np.float32), corners)
    add_camera((-10.0, 0.5, 5.0), (10.0, -0.6, 4.4), lens=22.0)


def instances(positions: np.ndarray, corners: np.ndarray) -> None:
    """A field of dragons, turned and sized at random; the places are faces of one mesh."""
    model = mesh_object("Dragon", standing(positions, 1.44), corners)
    random = np.random.default_rng(1)
    grid = (np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=-1) + 0.5) * SPACING
    middle = grid.reshape(-1, 2) - SIDE * SPACING / 2 + random.uniform(-0.4, 0.4, (SIDE**2, 2))
    angle, size = random.uniform(0.0, 2.0 * np.pi, SIDE**2), random.uniform(0.7, 1.3, SIDE**2)
    quarter = angle[:, None] + np.pi / 2 * np.arange(4)
    ring = (
        np.stack([np.cos(quarter), np.sin(quarter)], axis=-1) * (size / np.sqrt(2.0))[:, None, None]
    )
    points = np.zeros((SIDE**2, 4, 3))
    points[..., :2] = middle[:, None] + ring
    places = mesh_object("Places", points.reshape(-1, 3), np.arange(4 * SIDE**2).reshape(-1, 4))
    model.parent = places
    places.instance_type, places.use_instance_faces_scale = "FACES", True
    places.show_instancer_for_render = False
    add_rectangle("Ground", (-400.0, -400.0, 0.0), (800.0, 0.0, 0.0), (0.0, 800.0, 0.0))
    add_camera((0.0, -SIDE * SPACING / 2 - 4.0, 9.0), (0.0, -SIDE * SPACING / 2 + 14.0, 0.0))


def with_picture(obj: Any, look: Any, repeat: float = 1.0) -> None:
    """Each four-sided face shows the whole picture, `repeat` times."""
    obj.data.materials.append(look)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32) * np.float32(repeat)
    layer = obj.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", np.tile(corners, (len(obj.data.polygons), 1)).ravel())


def tiles() -> Any:
    image = picture("Tiles", 1024, tile_color)
    return material("Tiled", lambda t: diffuse(t, add(t, "TexImage", image=image).outputs["Color"]))


def leaves(positions: np.ndarray, corners: np.ndarray) -> None:
    """The dragon on tiles among 64 trees of 2,000 leaves."""
    stone = mesh_object("Dragon", standing(positions, 1.44), corners)
    stone.data.materials.append(material("Stone", lambda t: diffuse(t, (0.5, 0.45, 0.4))))
    random = np.random.default_rng(2)
    count = 2000
    direction = random.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    middle = direction * random.uniform(0.3, 1.0, (count, 1)) ** (1 / 3) * (1.3, 1.3, 1.1)
    side = np.cross(direction, random.normal(size=(count, 3)))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, direction) + 0.4 * direction
    quad = np.stack([-side, side, side + 2 * up, -side + 2 * up], axis=1) * 0.09
    points = (middle + np.array([0.0, 0.0, 2.6]))[:, None] + quad
    tree = mesh_object("Tree", points.reshape(-1, 3), np.arange(4 * count).reshape(-1, 4))
    with_picture(tree, material("Leaf", leaf(picture("Leaf", 512, leaf_color))))
    places = random.uniform(-9.0, 9.0, (200, 2))
    places = [p for p in places if np.hypot(*p) > 1.8 and not (abs(p[0]) < 1.2 and p[1] < 0)][:64]
    for number, place in enumerate(places):
        copy = tree if number == 0 else link(bpy.data.objects.new("Tree", tree.data))
        copy.location = (*place, random.uniform(-0.8, 0.2))
        copy.rotation_euler = (0.0, 0.0, random.uniform(0.0, 6.28))
    ground = add_rectangle("Ground", (-40.0, -40.0, 0.0), (80.0, 0.0, 0.0), (0.0, 80.0, 0.0))
    with_picture(ground, tiles(), 20.0)
    add_camera((1.0, -6.5, 2.2), (0.0, 0.0, 1.4), lens=35.0)


def sky(positions: np.ndarray, corners: np.ndarray) -> None:
    """The dragon on tiles in the evening, its world a Sky Texture with its sun."""
    dragon(positions, corners)
    with_picture(bpy.data.objects["Ground"], tiles(), 30.0)
    bronze = material("Bronze", lambda t: diffuse(t, (0.45, 0.3, 0.2)))
    bpy.data.objects["Dragon"].data.materials.append(bronze)


def set_sky() -> None:
    tree = set_world().node_tree
    texture = tree.nodes.new("ShaderNodeTexSky")
    texture.sky_type, texture.sun_elevation, texture.sun_rotation = "NISHITA", 0.5, 2.4
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 0.1


def main() -> None:
    """Make what the command line names."""
    kind, source, target = sys.argv[sys.argv.index("--") + 1 :]
    data = np.load(source)
    empty_scene(1280, 720)
    kinds = {
        "dragon": dragon, "interior": interior, "instances": instances, "leaves": leaves, "sky": sky,
    }  # fmt: skip
    kinds[kind](data["positions"], data["corners"])
    if kind == "sky":
        set_sky()
    else:
        set_world()
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(target).resolve()), compress=False)


main()
