"""Blender's own panels that make sense for this engine too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

# Compatible by their own word, but about things that are not rendered (yet).
EXCLUDED = {
    "RENDER_PT_freestyle",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    "MATERIAL_PT_preview",
    "DATA_PT_preview",
    "DATA_PT_volume_render",
}
# Made for another engine by their own word, but good for any: the material slots of an object.
BY_NAME = ("EEVEE_MATERIAL_PT_context_material",)


def _panels() -> Iterator[Any]:
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in BY_NAME or (
            "BLENDER_RENDER" in engines
            and panel.__name__ not in EXCLUDED
            and not panel.__name__.startswith(("MATERIAL_PT_freestyle", "VIEWLAYER_PT_freestyle"))
        ):
            yield panel


def inherit(engine_id: str) -> None:
    for panel in _panels():
        panel.COMPAT_ENGINES.add(engine_id)


def disinherit(engine_id: str) -> None:
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if isinstance(engines, set) and not panel.__name__.startswith("KOMOREBI"):
            engines.discard(engine_id)


def draw_world_surface(layout: Any, world: Any) -> None:
    """The colour of a world, or the nodes that feed its surface."""
    layout.use_property_split = True
    if not world.use_nodes or world.node_tree is None:
        layout.prop(world, "use_nodes", icon="NODETREE")
        layout.prop(world, "color")
        return
    output = world.node_tree.get_output_node("ALL")
    if output is None or output.inputs.get("Surface") is None:
        layout.label(text="No output node")
    else:
        layout.template_node_view(world.node_tree, output, output.inputs["Surface"])
