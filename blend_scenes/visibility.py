"""Scenes about what sees what: rays, holes in the picture, and shadows without the thing."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from common import add_box, add_camera, add_rectangle, add_sphere, empty_scene, link, set_world


def floor() -> bpy.types.Object:
    return add_rectangle("Floor", (-4.0, -4.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0))


def into(thing: bpy.types.Object, name: str) -> bpy.types.LayerCollection:
    """Move `thing` into a collection of the scene of that name; its entry in the view layer."""
    collection = bpy.data.collections.new(name)
    scene = bpy.context.scene
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(thing)
    link(thing, collection)
    return bpy.context.view_layer.layer_collection.children[name]


def visibility() -> None:
    """Balls that camera, diffuse or shadow rays do not see, or one alone of the last two, holdouts
    of both kinds, a collection for indirect light only, and instances whose instancer decides."""
    empty_scene(320, 200)
    floor()
    kinds = (
        ("no camera", {"visible_camera": False}),
        ("no light", {"visible_diffuse": False, "visible_shadow": False}),
        ("holdout", {"is_holdout": True}),
        ("plain", {}),
    )
    for i, (name, flags) in enumerate(kinds):
        ball = add_sphere(f"Ball, {name}", 0.6, (-2.4 + 1.6 * i, 0.8, 0.7), level=5)
        for flag, value in flags.items():
            setattr(ball, flag, value)
    for x, flag in ((-1.6, "visible_diffuse"), (1.6, "visible_shadow")):
        setattr(add_sphere(f"Ball, no {flag}", 0.6, (x, 2.4, 0.7), level=5), flag, False)
    block = (0.8, 0.8, 1.2)
    into(add_box("Hole", block, (-2.4, -1.2, 0.6)), "Holdout").holdout = True
    into(add_box("Unseen", block, (-0.8, -1.2, 0.6)), "Indirect").indirect_only = True
    hidden = bpy.data.collections.new("Stock")
    part = add_box("Part", (0.7, 0.7, 0.7))
    bpy.context.scene.collection.objects.unlink(part)
    link(part, hidden)
    for x, flag in ((0.8, "is_holdout"), (2.4, "visible_camera")):
        empty = link(bpy.data.objects.new(f"Instance, {flag}", None))
        empty.instance_type, empty.instance_collection = "COLLECTION", hidden
        empty.location = (x, -1.2, 0.5)
        setattr(empty, flag, flag == "is_holdout")
    bpy.context.scene.render.film_transparent = True
    add_camera((0.0, -8.0, 5.0), (0.0, 0.0, 0.3), lens=36.0)
    set_world((0.7, 0.9, 1.2))


def shadow_catcher() -> None:
    """A floor and a step that catch the shadows of a ball and a block, to lie over a photograph."""
    empty_scene(320, 200)
    floor().is_shadow_catcher = True
    step = add_box("Step", (3.0, 1.0, 0.6), (0.0, 1.8, 0.3))
    step.is_shadow_catcher = True
    add_sphere("Ball", 0.8, (-0.9, 0.2, 0.85), level=5)
    add_box("Block", (1.0, 1.0, 1.4), (1.1, 0.1, 0.75))
    bpy.context.scene.render.film_transparent = True
    add_camera((0.0, -7.0, 4.5), (0.0, 0.3, 0.4), lens=36.0)
    set_world((0.7, 0.9, 1.2))


def shadow_catcher_opaque() -> None:
    """The same before the world itself."""
    shadow_catcher()
    bpy.context.scene.render.film_transparent = False


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (visibility, shadow_catcher, shadow_catcher_opaque)
}
