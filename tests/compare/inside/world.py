"""The world of a comparison: white for ambient occlusion; the scene's own for world light, where
Komorebi can."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from compare.inside.settle import settle, settle_all

STUDIO_LIGHT = "city"
BLACK = {"the world is black", "there is no world"}


def uniform_world(scene: Any, colour: tuple[float, float, float]) -> None:
    """A new world of one radiance in all directions."""
    world = bpy.data.worlds.new("compare world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*colour, 1.0)
    scene.world = world


def picture_world(scene: Any, path: Path) -> None:
    """A new world lit by an equirectangular picture as it is stored."""
    world = bpy.data.worlds.new("compare world")
    world.use_nodes = True
    tree = world.node_tree
    picture = tree.nodes.new("ShaderNodeTexEnvironment")
    picture.image = bpy.data.images.load(str(path))
    tree.links.new(picture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    scene.world = world


def studio_light() -> Path:
    """One of the HDR maps that Blender ships."""
    data = bpy.utils.system_resource("DATAFILES") or bpy.utils.resource_path("SYSTEM")
    return Path(data) / "studiolights" / "world" / f"{STUDIO_LIGHT}.exr"


def source(socket: Any) -> Any:
    """The node that feeds `socket`, through reroutes; None when nothing does."""
    while socket.is_linked and socket.links[0].is_valid and not socket.links[0].is_muted:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def why_not_picture(picture: Any) -> str | None:
    """Why an Environment Texture cannot be kept, or None."""
    if picture.projection != "EQUIRECTANGULAR":
        return f"projection {picture.projection}"
    if picture.image is None or picture.image.source not in {"FILE", "GENERATED"}:
        return "no still image in the Environment Texture"
    if min(picture.image.size) == 0:
        return "the world's image is missing"
    vector = source(picture.inputs["Vector"])
    if vector is None:
        return None
    if vector.type == "TEX_COORD":
        return (
            None
            if picture.inputs["Vector"].links[0].from_socket.name == "Generated"
            else "texture coordinates"
        )
    if vector.type != "MAPPING":
        return f"node {vector.type} before the Environment Texture"
    moved = any(abs(v) > 1e-9 for v in vector.inputs["Location"].default_value)
    scaled = any(abs(v - 1.0) > 1e-9 for v in vector.inputs["Scale"].default_value)
    if (
        moved
        or scaled
        or any(vector.inputs[n].is_linked for n in ("Location", "Rotation", "Scale"))
    ):
        return "a Mapping node that does more than rotate"
    before = source(vector.inputs["Vector"])
    if (
        before is None
        or before.type != "TEX_COORD"
        or vector.inputs["Vector"].links[0].from_socket.name != "Generated"
    ):
        return "texture coordinates that are not Generated"
    return None


def why_not(world: Any) -> str | None:
    """Why the world cannot be kept for both engines, or None."""
    if world is None:
        return "there is no world"
    if not world.use_nodes:
        return None if max(world.color) > 0.0 else "the world is black"
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    background = source(output.inputs["Surface"]) if output is not None else None
    if background is None:
        return "the world is black"
    if background.type != "BACKGROUND":
        return f"world node {background.type}"
    if background.inputs["Strength"].is_linked:
        return "a node sets the world's strength"
    if background.inputs["Strength"].default_value <= 0.0:
        return "the world is black"
    colour = source(background.inputs["Color"])
    if colour is None:
        return (
            None
            if max(background.inputs["Color"].default_value[:3]) > 0.0
            else "the world is black"
        )
    return (
        why_not_picture(colour) if colour.type == "TEX_ENVIRONMENT" else f"world node {colour.type}"
    )


def set_world(scene: Any, mode: str, picture: str | None, lamps: bool) -> list[str]:
    """White for `ao`; for `world` the map at `picture`, else the scene's own world, else a studio
    light; but a black world may stay where there are `lamps`."""
    if mode == "ao":
        uniform_world(scene, (1.0, 1.0, 1.0))
        return []
    if picture is not None:
        picture_world(scene, Path(picture))
        return [f"world replaced by {Path(picture).name}, as asked"]
    reason = why_not(scene.world)
    if lamps and reason in BLACK:
        uniform_world(scene, (0.0, 0.0, 0.0))
        return []
    if reason is not None:
        picture_world(scene, studio_light())
        return [f"{reason}: replaced by Blender's studio light {STUDIO_LIGHT}"]
    return tidy(scene.world)


def tidy(world: Any) -> list[str]:
    """Undo what a kept world has beside its light: volume, ray visibility, unusual
    interpolation."""
    notes = []
    settle_all(getattr(world, "cycles", None), sampling_method="AUTOMATIC", max_bounces=1024)
    visibility = getattr(world, "cycles_visibility", None)
    for ray in ("camera", "diffuse", "glossy", "transmission", "scatter"):
        if visibility is not None and not getattr(visibility, ray, True):
            settle(visibility, ray, True)
            notes.append(f"world hidden from {ray} rays")
    if world.use_nodes:
        for link in [
            k for k in world.node_tree.links if k.to_socket.name in {"Volume", "Displacement"}
        ]:
            world.node_tree.links.remove(link)
            notes.append("world volume")
        for node in world.node_tree.nodes:
            if node.type == "TEX_ENVIRONMENT" and node.interpolation != "Linear":
                notes.append(f"interpolation {node.interpolation} made Linear")
                settle(node, "interpolation", "Linear")
    return notes
