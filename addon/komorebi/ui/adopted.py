"""Blender's own panels that are shown for this engine too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import bpy

# Compatible by their own word, and not shown all the same: why.
EXCLUDED = {
    "DATA_PT_area": "lamps have a panel of ours",
    "DATA_PT_falloff_curve": "lamps have a panel of ours",
    "DATA_PT_light": "lamps have a panel of ours",
    "DATA_PT_spot": "lamps have a panel of ours",
    "DATA_PT_volume_render": "volumes are not rendered",
    "NODE_DATA_PT_light": "lamps have a panel of ours",
    "NODE_DATA_PT_spot": "lamps have a panel of ours",
    "OBJECT_PT_shading": "a panel of ours; this one brings light linking, which is not supported",
    "OBJECT_PT_visibility": "a panel of ours, with the rays that are traced",
    "RENDER_PT_simplify": "a panel of ours: this one would stand above Sampling",
    "RENDER_PT_simplify_greasepencil": "a panel of ours",
    "RENDER_PT_simplify_render": "a panel of ours",
    "RENDER_PT_simplify_viewport": "a panel of ours",
}
# Made for other engines by their own word, but good for any.
BY_NAME = (
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "VIEWLAYER_PT_override",
)


def adopted() -> Iterator[Any]:
    """The panels of this Blender to adopt."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if panel.__name__ in BY_NAME or (
            "BLENDER_RENDER" in engines and panel.__name__ not in EXCLUDED
        ):
            yield panel


def register(engine_id: str) -> None:
    for panel in list(adopted()):
        panel.COMPAT_ENGINES.add(engine_id)


def unregister(engine_id: str) -> None:
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if isinstance(engines, set) and not panel.__name__.startswith("KOMOREBI"):
            engines.discard(engine_id)
