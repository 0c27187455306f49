"""Scenes of colours: materials, pictures on surfaces, leaves, and worlds built of nodes."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import bpy
from common import add_box, add_camera, add_rectangle, add_sphere, empty_scene, link, set_world
from nodes import add, diffuse, material, mix, picture


def _floor(size: float, look: bpy.types.Material) -> bpy.types.Object:
    floor = add_rectangle("Floor", (-size / 2, -size / 2, 0.0), (size, 0.0, 0.0), (0.0, size, 0.0))
    floor.data.materials.append(look)
    layer = floor.data.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        loop.uv = uv
    return floor


def tile_color(u: float, v: float) -> tuple[float, ...]:
    light = (int(u * 8) + int(v * 8)) % 2
    return (0.8, 0.7, 0.5, 1.0) if light else (0.3, 0.25, 0.4, 1.0)


def colors() -> None:
    """Colours of every origin: plain, painted on corners, from pictures, by object, face and place;
    what light comes through."""
    empty_scene(240, 160)
    tiles = picture("Tiles", 64, tile_color)
    _floor(
        12.0,
        material("Tiled", lambda t: diffuse(t, add(t, "TexImage", image=tiles).outputs["Color"])),
    )
    red = material("Red", lambda t: diffuse(t, (0.8, 0.1, 0.05)))
    add_sphere("Plain", 0.8, (-3.2, 0.0, 0.8), level=4).data.materials.append(red)

    def painted(tree: Any) -> Any:
        return diffuse(tree, add(tree, "VertexColor", layer_name="Paint").outputs["Color"])

    box = add_box("Painted", (1.4, 1.4, 1.4), (-1.1, 0.0, 0.7))
    paint = box.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    for index, corner in enumerate(paint.data):
        corner.color = (index % 3 / 2, index % 5 / 4, index % 2, 1.0)
    box.data.materials.append(material("Paint", painted))

    def by_place(tree: Any) -> Any:
        place = add(tree, "TexCoord").outputs["Object"]
        steps = add(tree, "TexChecker", {"Vector": place, "Scale": 4.0}).outputs["Color"]
        shade = add(tree, "ObjectInfo").outputs["Color"]
        return diffuse(tree, add(tree, "MixRGB", {0: 0.5, 1: steps, 2: shade}).outputs[0])

    ball = add_sphere("Checked", 0.8, (1.1, 0.0, 0.8), level=4)
    ball.color = (0.1, 0.6, 0.9, 1.0)
    ball.data.materials.append(material("Place", by_place))

    def paper(tree: Any) -> Any:
        through = add(tree, "BsdfTranslucent", {"Color": (0.8, 0.7, 0.3)}).outputs[0]
        return mix(tree, 0.4, diffuse(tree, (0.7, 0.7, 0.6)), through)

    sheet = add_rectangle("Paper", (2.2, -0.6, 0.0), (1.8, 0.0, 0.3), (0.0, 0.4, 1.7))
    sheet.data.materials.append(material("Paper", paper))
    back = add_rectangle("Stripes", (-4.0, 2.2, 0.0), (8.0, 0.0, 0.0), (0.0, 0.0, 2.6))

    def stripes(tree: Any) -> Any:
        place = add(tree, "NewGeometry").outputs["Position"]
        waves = add(tree, "TexWave", {"Vector": place, "Scale": 0.7}).outputs["Fac"]
        ramp = add(tree, "ValToRGB", {"Fac": waves})
        ramp.color_ramp.elements[0].color = (0.1, 0.3, 0.1, 1.0)
        ramp.color_ramp.elements[1].color = (0.8, 0.8, 0.4, 1.0)
        return diffuse(tree, ramp.outputs["Color"])

    back.data.materials.append(material("Stripes", stripes))
    add_camera((0.0, -8.5, 4.2), (0.0, 0.2, 0.7), lens=42.0)
    set_world((0.8, 0.9, 1.0))


def _weave(u: float, v: float) -> tuple[float, ...]:
    """Threads of two colours, and grain: mostly what is smaller than a pixel far away."""
    grain = random.Random(int(u * 128) * 128 + int(v * 128)).random()
    over = (int(u * 32) + int(v * 32)) % 2
    return (*((0.9, 0.75 * grain, 0.2) if over else (0.05, 0.1, 0.6 * grain)), 1.0)


def horizon() -> None:
    """Pictures that are much finer than pixels: a ground as far as one sees, by UV coordinates and
    a Mapping; a wall by Box, a ball by Sphere and a slab whose coordinates are stretched."""
    empty_scene(240, 160)
    weave = picture("Weave", 128, _weave)

    def woven(
        tree: Any, source: str, scale: tuple[float, float, float], projection: str = "FLAT"
    ) -> Any:
        place = add(tree, "TexCoord").outputs[source]
        mapped = add(tree, "Mapping", {"Vector": place, "Rotation": (0, 0, 0.3), "Scale": scale})
        texture = add(tree, "TexImage", {"Vector": mapped.outputs[0]}, image=weave)
        texture.projection = projection
        texture.projection_blend = 0.2
        return diffuse(tree, texture.outputs["Color"])

    _floor(600.0, material("Ground", lambda t: woven(t, "UV", (300.0, 300.0, 1.0))))
    wall = add_box("Wall", (3.0, 0.6, 2.2), (-2.6, 2.0, 1.1))
    wall.rotation_euler = (0.0, 0.0, 0.5)
    wall.data.materials.append(material("Boxed", lambda t: woven(t, "Object", (1.5,) * 3, "BOX")))
    ball = add_sphere("Ball", 1.1, (0.9, 1.0, 1.1), level=4)
    ball.data.materials.append(
        material("Wrapped", lambda t: woven(t, "Generated", (1.0,) * 3, "SPHERE"))
    )
    slab = add_box("Slab", (1.2, 1.2, 1.6), (3.4, 2.5, 0.8))
    slab.data.materials.append(
        material("Stretched", lambda t: woven(t, "Generated", (12.0, 0.5, 2.0)))
    )
    add_camera((0.0, -6.5, 1.7), (0.0, 4.0, 1.1), lens=28.0)
    set_world((0.8, 0.9, 1.0))


def leaf_color(u: float, v: float) -> tuple[float, ...]:
    """A pointed leaf with a rib, on nothing."""
    across = abs(u - 0.5)
    inside = across < 0.36 * math.sin(math.pi * min(max((v - 0.05) / 0.9, 0.0), 1.0)) ** 0.8
    rib = across < 0.02 or abs((v * 7 + across * 5) % 1.0 - 0.5) < 0.06
    return (*((0.35, 0.5, 0.15) if rib else (0.15, 0.4, 0.08)), 1.0 if inside else 0.0)


def leaf(cut: Any) -> Callable[[Any], Any]:
    """What a picture's alpha cuts out of a card, of which a part of the light comes through."""

    def build(tree: Any) -> Any:
        texture = add(tree, "TexImage", image=cut)
        color = texture.outputs["Color"]
        through = add(tree, "BsdfTranslucent", {"Color": color}).outputs[0]
        green = mix(tree, 0.4, diffuse(tree, color), through)
        nothing = add(tree, "BsdfTransparent").outputs[0]
        return mix(tree, texture.outputs["Alpha"], nothing, green)

    return build


def leaves() -> None:
    """Leaves that are cut out of cards by a picture's alpha, and let light through: 400 of them."""
    empty_scene(240, 160)
    cut = picture("Leaf", 64, leaf_color)
    _floor(9.0, material("Earth", lambda t: diffuse(t, (0.5, 0.4, 0.3))))
    card = add_rectangle("Leaf", (-0.25, 0.0, 0.0), (0.5, 0.0, 0.0), (0.0, 0.7, 0.15))
    layer = card.data.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        loop.uv = uv
    card.data.materials.append(material("Leaf", leaf(cut)))
    chance = random.Random(7)
    for number in range(400):
        copy = card if number == 0 else link(bpy.data.objects.new("Leaf", card.data))
        height = 0.4 + 2.4 * chance.random()
        reach = 1.9 * math.sqrt(chance.random()) * (1.2 - height / 3.2)
        turn = math.tau * chance.random()
        copy.location = (reach * math.cos(turn), reach * math.sin(turn), height)
        copy.rotation_euler = (chance.uniform(-0.6, 0.9), chance.uniform(-0.5, 0.5), turn)
    trunk = add_box("Trunk", (0.18, 0.18, 2.4), (0.0, 0.0, 1.2))
    trunk.data.materials.append(material("Bark", lambda t: diffuse(t, (0.25, 0.15, 0.08))))
    add_camera((0.0, -7.5, 2.6), (0.0, 0.0, 1.35), lens=40.0)
    set_world((0.9, 0.95, 1.0))


def world_nodes() -> None:
    """A sky of nodes: a gradient with clouds of noise that light, another colour for the camera."""
    empty_scene(240, 160)
    _floor(12.0, material("Floor", lambda t: diffuse(t, (0.8, 0.8, 0.8))))
    white = material("White", lambda t: diffuse(t, (0.8, 0.8, 0.8)))
    for name, x in (("Left", -1.6), ("Right", 1.6)):
        add_sphere(name, 1.0, (x, 0.0, 1.0), level=4).data.materials.append(white)
    add_camera((0.0, -8.0, 3.5), (0.0, 0.0, 0.9), lens=35.0)
    tree = set_world().node_tree
    place = add(tree, "TexCoord").outputs["Generated"]
    up = add(tree, "SeparateXYZ", {0: place}).outputs["Z"]
    ramp = add(tree, "ValToRGB", {"Fac": up})
    ramp.color_ramp.elements[0].color = (1.0, 0.7, 0.4, 1.0)
    ramp.color_ramp.elements[1].color = (0.2, 0.4, 1.0, 1.0)
    clouds = add(tree, "TexNoise", {"Vector": place, "Scale": 3.0}).outputs["Fac"]
    mixed = add(tree, "MixRGB", {0: clouds, 1: ramp.outputs["Color"], 2: (1.5, 1.5, 1.5)})
    sky = tree.nodes["Background"]
    tree.links.new(mixed.outputs[0], sky.inputs["Color"])
    behind = add(tree, "Background", {"Color": (0.05, 0.2, 0.1)}).outputs[0]
    camera = add(tree, "LightPath").outputs["Is Camera Ray"]
    output = next(n for n in tree.nodes if n.type == "OUTPUT_WORLD")
    tree.links.new(mix(tree, camera, sky.outputs[0], behind), output.inputs["Surface"])


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (colors, horizon, leaves, world_nodes)
}
