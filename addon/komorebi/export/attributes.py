"""Named arrays of Blender's meshes, curves and point clouds, as materials ask for them by name.

Names are GENERATED, those of attributes, or begin by what they are of: UV maps, colour attributes
or the tangents of UV maps, of which an empty name is the one that is used for renders. A name that
a shape does not have is left out: it counts as 0 there.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compat
from ..scene_data import Attribute, FloatArray

GENERATED = "generated"  # undeformed positions in the texture space, 0 to 1
UV = "uv:"  # a UV map
COLOR = "color:"  # a colour attribute
TANGENT = "tangent:"  # of a UV map: along u, and the sign of the bitangent


# Of each data_type of attributes that is read: its property, how many numbers, and of what type.
_ATTRIBUTE_TYPES: dict[str, tuple[str, int, type]] = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int8),
    "BOOLEAN": ("value", 1, np.bool_),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),  # linear
}


@dataclass(slots=True)
class Found:
    """What a shape has of the names, and sentences on what it has but cannot be read."""

    attributes: dict[str, Attribute] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)


def uv_map_of_tangents(name: str) -> str | None:
    """The name by which the UV map is asked for whose tangents a name stands for; None if it stands
    for no tangents."""
    return UV + name.removeprefix(TANGENT) if name.startswith(TANGENT) else None


def read_mesh_attributes(mesh: Any, names: Iterable[str]) -> Found:
    """All but tangents, which follow from the rest (`read_tangents`)."""
    found = Found()
    for name in sorted(set(names)):
        if uv_map_of_tangents(name) is not None:
            continue
        if name == GENERATED:
            found.attributes[name] = Attribute("POINT", generated(mesh))
            continue
        layer = _uv_layer(mesh, name)
        if layer is not None:
            found.attributes[name] = Attribute("CORNER", compat.uvs_of_layer(mesh, layer))
            continue
        source = name.removeprefix(COLOR)
        if name == COLOR:
            source = _render_color_name(mesh)
        _read_named(mesh, source, name, found)
    return found


def read_round_attributes(data: Any, names: Iterable[str]) -> Found:
    """Those of Curves or PointCloud data, by point or curve."""
    found = Found()
    for name in sorted(set(names)):
        uvs = compat.curve_uvs(data) if name == UV and hasattr(data, "curves") else None
        if uvs is not None:
            found.attributes[name] = Attribute("CURVE", uvs)
        else:
            _read_named(data, name.removeprefix(COLOR), name, found)
    return found


def read_tangents(mesh: Any, names: Iterable[str]) -> Found:
    """Tangents by corner [corners, 4]: along u, and the sign of the bitangent."""
    found = Found()
    for name in sorted(set(names)):
        uv_map = uv_map_of_tangents(name)
        layer = None if uv_map is None else _uv_layer(mesh, uv_map)
        if layer is None:
            continue
        values = _tangents(mesh, layer.name)
        if values is None:
            found.problems.append(
                f'the tangents of UV map "{layer.name}" cannot be had of faces with more than '
                "four corners"
            )
        else:
            found.attributes[name] = Attribute("CORNER", values)
    return found


def generated(mesh: Any) -> FloatArray:
    """Cycles' generated coordinates [vertices, 3]: where vertices are without modifiers that
    deform, from 0 to 1 in the mesh's texture space."""
    undeformed = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("undeformed_co", undeformed)
    size = np.array(mesh.texspace_size, np.float32)
    scale = np.divide(np.float32(0.5), size, out=np.zeros_like(size), where=size != 0.0)
    shift = np.array(mesh.texspace_location, np.float32) * scale - np.float32(0.5)
    return undeformed.reshape(-1, 3) * scale - shift


def _uv_layer(mesh: Any, name: str) -> Any | None:
    if name == UV:
        return next((layer for layer in mesh.uv_layers if layer.active_render), None)
    return mesh.uv_layers.get(name.removeprefix(UV))


def _read_named(data: Any, source: str, name: str, found: Found) -> None:
    attribute = data.attributes.get(source) if source else None
    if attribute is None:
        return
    if attribute.domain not in {"POINT", "CORNER", "FACE", "CURVE"}:
        found.problems.append(f'attribute "{source}" is by {attribute.domain.lower()}')
        return
    values = _values(attribute)
    if values is None:
        found.problems.append(f'attribute "{source}" holds {attribute.data_type}')
        return
    found.attributes[name] = Attribute(attribute.domain, values)


def _values(attribute: Any) -> FloatArray | None:
    """An attribute of any domain [elements, numbers], colours linear; None for other types."""
    known = _ATTRIBUTE_TYPES.get(attribute.data_type)
    if known is None:
        return None
    name, columns, kind = known
    result: NDArray[Any] = np.empty(len(attribute.data) * columns, kind)
    attribute.data.foreach_get(name, result)
    return result.astype(np.float32, copy=False).reshape(-1, columns)


def _render_color_name(mesh: Any) -> str:
    """The colour attribute that is used for renders, or ""."""
    colors = mesh.color_attributes
    index = colors.render_color_index
    return str(colors[index].name) if 0 <= index < len(colors) else ""


def _tangents(mesh: Any, uv_map: str) -> FloatArray | None:
    """Tangents by corner and the bitangent's sign [corners, 4]; None where a face has more than
    four corners, for which Blender has none."""
    sizes = np.empty(len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    if sizes.max(initial=0) > 4:  # Blender would write an error to the log
        return None
    mesh.calc_tangents(uvmap=uv_map)
    along = np.empty(3 * len(mesh.loops), np.float32)
    sign = np.empty(len(mesh.loops), np.float32)
    mesh.loops.foreach_get("tangent", along)
    mesh.loops.foreach_get("bitangent_sign", sign)
    mesh.free_tangents()
    return np.column_stack([along.reshape(-1, 3), sign])
