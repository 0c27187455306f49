"""The scene's own materials, made matt: what Komorebi renders as matt is so in both engines."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

from compare.inside.settle import safe_name, settle

# Inputs of the Principled BSDF by which light is reflected or goes otherwise than diffusely.
GLOSS = (
    "Specular", "Specular IOR Level", "Metallic", "Sheen", "Sheen Weight", "Clearcoat",
    "Coat Weight", "Transmission", "Transmission Weight", "Subsurface", "Subsurface Weight",
)  # fmt: skip


def trees() -> Iterator[tuple[str, Any]]:
    """Every shader tree with what it belongs to; groups too."""
    for material in bpy.data.materials:
        if material.node_tree is not None:
            yield f"material {safe_name(material)}", material.node_tree
    for group in bpy.data.node_groups:
        if group.bl_idname == "ShaderNodeTree":
            yield f"group {safe_name(group)}", group


def make_matt() -> list[str]:
    """Takes gloss, metal and what lies beneath the surface away; says from how many nodes."""
    changed = 0
    for _, tree in trees():
        for node in tree.nodes:
            if node.type == "BSDF_PRINCIPLED":
                changed += _without(tree, node, GLOSS)
            elif node.type == "BSDF_DIFFUSE":
                changed += _without(tree, node, ("Roughness",))
    for material in bpy.data.materials:
        for owner in (material, getattr(material, "cycles", None)):
            settle(owner, "displacement_method", "BUMP")
    return [f"{changed} shaders made matt"] if changed else []


def _without(tree: Any, node: Any, names: tuple[str, ...]) -> bool:
    changed = False
    for name in names:
        socket = node.inputs.get(name)
        if socket is None:
            continue
        for link in [k for k in tree.links if k.to_socket == socket]:
            tree.links.remove(link)
            changed = True
        changed |= socket.default_value != 0.0
        socket.default_value = 0.0
    return changed
