"""What the panels of this engine share."""

from __future__ import annotations

from typing import Any

from .. import compat
from ..engine import ENGINE_ID

# What a ray can hit: the objects whose visibility, shading and motion mean something.
GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CURVES", "POINTCLOUD"}


class KomorebiPanel:
    """Placed among the render properties, and shown for this engine alone."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {ENGINE_ID}

    layout: Any

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES

    def column(self, **options: Any) -> Any:
        """A column in Blender's own style: labels on the left, values on the right."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column(**options)


def owner_of(name: str, *candidates: Any) -> Any | None:
    """The first of `candidates` that has a property `name`.

    Some properties moved from Cycles' groups to Blender's own between releases, and Cycles' are
    not there at all while its add-on is switched off (a candidate is None then).
    """
    for candidate in candidates:
        if candidate is not None and name in candidate.bl_rna.properties:
            return candidate
    return None


def draw_moved(layout: Any, name: str, *candidates: Any, **options: Any) -> None:
    """Draws `name` of the first of `candidates` that has it, or nothing."""
    owner = owner_of(name, *candidates)
    if owner is not None:
        layout.prop(owner, name, **options)


def cycles(owner: Any, group: str = "cycles") -> Any | None:
    """Cycles' settings of `owner`, or None while its add-on is switched off."""
    return getattr(owner, group, None)


def draw_surface(layout: Any, owner: Any, plain: str) -> None:
    """The nodes that feed the surface of a world or material, or its colour `plain`."""
    layout.use_property_split = True
    tree = compat.shader_nodes(owner)
    if tree is None:
        layout.prop(owner, "use_nodes", icon="NODETREE")
        layout.prop(owner, plain, text="Color")
        return
    outputs = (tree.get_output_node(target) for target in ("ALL", "CYCLES", "EEVEE"))
    output = next((node for node in outputs if node is not None), None)
    socket = None if output is None else output.inputs.get("Surface")
    if socket is None:
        layout.label(text="No output node")
    else:
        layout.template_node_view(tree, output, socket)
