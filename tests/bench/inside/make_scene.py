"""Runs inside Blender: makes one of the bench's scenes from a mesh and saves it.

    PYTHON_WITH_BPY tests/bench/inside/make_scene.py -- KIND MESH.npz OUT.blend

KIND is dragon (on a ground), interior (a hall seen from within), instances (10,000 dragons, made
by Blender's instancing on faces), sky (the dragon on tiles under a Sky Texture) or leaves (trees of
cards that a picture cuts leaves out of, on tiles). MESH.npz holds positions float32 [V, 3], y up,
and corners int32 [T, 3]; nothing for leaves.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "blend_scenes"))

from common import add_box, add_camera, add_rectangle, empty_scene, link, set_world
from nodes import add, diffuse, material, mix, picture

SIDE = 100  # instances along each side of the field
SPACING = 2.6  # metres from one to the next
TREES, LEAVES = 40, 200  # leaves a tree
SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))


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


def lay_out(thing: Any, corners: Any) -> None:
    """A UV map for an object of one quad."""
    layer = thing.data.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, corners, strict=True):
        loop.uv = uv


def tiled_ground(size: float) -> None:
    """A ground of tiles, of a picture that is repeated every metre."""
    grain = np.random.default_rng(2).uniform(0.7, 1.0, (256, 256))

    def tile(u: float, v: float) -> tuple[float, ...]:
        dark = (int(u * 4) + int(v * 4)) % 2
        light = float(grain[int(v * 256), int(u * 256)]) * (0.35 if dark else 0.8)
        return (light, 0.9 * light, 0.75 * light, 1.0)

    image = picture("Tiles", 256, tile)
    ground = add_rectangle(
        "Ground", (-size / 2, -size / 2, 0.0), (size, 0.0, 0.0), (0.0, size, 0.0)
    )
    lay_out(ground, [(size * u, size * v) for u, v in SQUARE])
    ground.data.materials.append(
        material("Tiles", lambda t: diffuse(t, add(t, "TexImage", image=image).outputs["Color"]))
    )


def sky(positions: np.ndarray, corners: np.ndarray) -> None:
    """A coloured dragon on tiles, in the sun of Cycles' best sky with its disc."""
    mesh = mesh_object("Dragon", standing(positions, 1.44), corners)
    mesh.data.materials.append(material("Jade", lambda t: diffuse(t, (0.25, 0.5, 0.3))))
    tiled_ground(120.0)
    add_camera((1.0, -4.0, 1.75), (0.0, 0.0, 0.68), lens=50.0)
    tree = set_world(strength=0.1).node_tree
    above = add(tree, "TexSky", sky_type="NISHITA", sun_disc=True, sun_elevation=0.6)
    tree.links.new(above.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def leaf(u: float, v: float) -> tuple[float, ...]:
    """A pointed leaf with a rib and veins, on nothing."""
    across = abs(u - 0.5)
    inside = across < 0.4 * np.sin(np.pi * v) ** 0.8
    vein = across < 0.02 or (v * 9 + across * 6) % 1.0 < 0.1
    return (*((0.4, 0.5, 0.15) if vein else (0.15, 0.4, 0.08)), 1.0 if inside else 0.0)


def leaves() -> None:
    """Trees of leaves that are cut out of cards and let light through, each card an object."""
    cut = picture("Leaf", 256, leaf)

    def look(tree: Any) -> Any:
        texture = add(tree, "TexImage", image=cut)
        color = texture.outputs["Color"]
        through = add(tree, "BsdfTranslucent", {"Color": color}).outputs[0]
        green = mix(tree, 0.4, diffuse(tree, color), through)
        nothing = add(tree, "BsdfTransparent").outputs[0]
        return mix(tree, texture.outputs["Alpha"], nothing, green)

    card = add_rectangle("Leaf", (-0.2, 0.0, 0.0), (0.4, 0.0, 0.0), (0.0, 0.6, 0.12))
    lay_out(card, SQUARE)
    card.data.materials.append(material("Leaf", look))
    bark = material("Bark", lambda t: diffuse(t, (0.25, 0.15, 0.08)))
    random = np.random.default_rng(3)
    for number in range(TREES):
        x = 3.0 * (number % 8) - 10.5 + random.uniform(-0.8, 0.8)
        y = 3.5 * (number // 8) + random.uniform(-0.8, 0.8)
        add_box("Trunk", (0.16, 0.16, 2.4), (x, y, 1.2)).data.materials.append(bark)
        for _ in range(LEAVES):
            copy = link(bpy.data.objects.new("Leaf", card.data))
            height, turn = random.uniform(0.8, 3.4), random.uniform(0.0, 2.0 * np.pi)
            reach = 1.5 * np.sqrt(random.uniform()) * (1.25 - height / 4.0)
            copy.location = (x + reach * np.cos(turn), y + reach * np.sin(turn), height)
            copy.rotation_euler = (random.uniform(-0.6, 0.9), random.uniform(-0.5, 0.5), turn)
    bpy.data.objects.remove(card)
    tiled_ground(200.0)
    add_camera((0.0, -9.0, 3.2), (0.0, 0.0, 1.5), lens=32.0)


def main() -> None:
    """Make what the command line names."""
    kind, source, target = sys.argv[sys.argv.index("--") + 1 :]
    data = np.load(source)
    empty_scene(1280, 720)
    makers = {"dragon": dragon, "interior": interior, "instances": instances, "sky": sky}
    if kind == "leaves":
        leaves()
    else:
        makers[kind](data["positions"], data["corners"])
    if kind != "sky":
        set_world()
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(target).resolve()), compress=False)


main()
