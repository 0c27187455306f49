"""Lamps, and what Komorebi does not render yet: switched off in both engines, and listed."""

from __future__ import annotations

from collections import Counter
from typing import Any

import bpy

from compare.inside.settle import safe_name, settle, settle_all

# Kinds of object that Komorebi does not render yet.
KINDS = {
    "VOLUME": "volume",
    "GPENCIL": "grease pencil",
    "GREASEPENCIL": "grease pencil",
}


def lamps_unseen() -> list[str]:
    """Lamps light the scene, but no camera sees them: Komorebi shows none yet."""
    seen = [t for t in bpy.data.objects if t.type == "LIGHT" and t.visible_camera]
    for thing in seen:
        settle(thing, "visible_camera", False)
    return [f"{len(seen)} lamps hidden from the camera"] if seen else []


def lamps_off() -> list[str]:
    """Every lamp at zero power: they stay where they are, since cameras may be aimed at them."""
    for light in bpy.data.lights:
        settle(light, "energy", 0.0)
        if getattr(light, "node_tree", None) is not None:
            light.use_nodes = False
    return [f"{len(bpy.data.lights)} lamps"] if bpy.data.lights else []


def terminators_off() -> None:
    """Shadow-terminator offsets 0: Cycles ignores that of the geometry under an even sky, but
    ambient occlusion heeds it, as Cycles' own does."""
    for thing in bpy.data.objects:
        settle_all(
            getattr(thing, "cycles", None),
            shadow_terminator_offset=0.0,
            shadow_terminator_geometry_offset=0.0,
        )
        settle_all(
            thing, shadow_terminator_geometry_offset=0.0, shadow_terminator_shading_offset=0.0
        )


def visible_alike() -> list[str]:
    """Makes visibility to shadow and diffuse rays the same, for ambient occlusion: under an even sky
    Cycles sends diffuse rays alone, but ambient occlusion asks who casts shadows."""
    mixed = [t for t in bpy.data.objects if t.visible_diffuse != t.visible_shadow]
    for thing in mixed:
        settle(thing, "visible_diffuse", thing.visible_shadow)
    return (
        [f"{len(mixed)} objects made as visible to diffuse rays as to shadow rays"] if mixed else []
    )


def objects_off() -> list[str]:
    """Hide objects of kinds that Komorebi lacks."""
    found: Counter[str] = Counter()
    for thing in bpy.data.objects:
        if thing.type in KINDS:
            settle(thing, "hide_render", True)
            found[f"{KINDS[thing.type]} objects"] += 1
        settle_all(getattr(thing, "cycles", None), use_camera_cull=False, use_distance_cull=False)
    return [f"{count} {name}" for name, count in sorted(found.items())]


def unsupported_instances(depsgraph: Any) -> list[str]:
    """What geometry nodes make that cannot be switched off: listed, so that a disagreement is
    understood."""
    found: Counter[str] = Counter()
    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.object.type in KINDS:
            found[f"{KINDS[instance.object.type]} made by {safe_name(instance.parent)}"] += 1
    return [f"NOT switched off: {count} {name}" for name, count in sorted(found.items())]
