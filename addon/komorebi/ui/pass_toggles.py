"""The table of what switches passes on, for the panels that show it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any


@dataclass(frozen=True)
class Toggle:
    """One property, by its place: `view_layer`, `view_layer.komorebi`, `scene.komorebi` …"""

    group: str  # the panel: DATA, LIGHT, CRYPTOMATTE
    owner: str
    name: str
    label: str
    heading: str = ""  # left of it and of those after it that have the same
    by_blender: bool = False  # Blender makes the pass, and the engine's table does not name it

    def find_owner(self, context: Any) -> Any | None:
        """What has the property, or None in releases (or without add-ons) that lack it."""
        owner = reduce(lambda o, name: getattr(o, name, None), self.owner.split("."), context)
        return owner if owner is not None and self.name in owner.bl_rna.properties else None


TOGGLES = (
    Toggle("DATA", "view_layer", "use_pass_z", "Depth"),
    Toggle("DATA", "view_layer", "use_pass_normal", "Normal"),
    Toggle("DATA", "view_layer", "use_pass_grease_pencil", "Grease Pencil", by_blender=True),
    Toggle("DATA", "view_layer.komorebi", "pass_debug_sample_count", "Sample Count", "Debug"),
)


def toggles(group: str, context: Any) -> list[tuple[Toggle, Any]]:
    """The toggles of `group` that exist here, each with what has its property."""
    found = ((t, t.find_owner(context)) for t in TOGGLES if t.group == group)
    return [(toggle, owner) for toggle, owner in found if owner is not None]
