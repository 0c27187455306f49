"""Which native meshes are known, by what they were made from. No bpy in here.

A mesh has two digests: of what decides where rays hit, and of what decides how it is shaded. With
both known before its arrays are all read, most of them never are.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from . import cache
from .scene_data import Attribute, CurveData, KnownShape, MeshKey, PointData


@dataclass(slots=True)
class KnownMesh:
    """The cache's entry for a geometry: the mesh that was made of it last."""

    mesh: Any | None = None  # core.Mesh
    shading: bytes = b""
    builder: str = ""

    @property
    def byte_count(self) -> int:
        return 0 if self.mesh is None else int(self.mesh.byte_count)


def find(name: str, key: MeshKey) -> KnownShape | None:
    """What the core has of this key, if it is known, for the object `name`."""
    known = cache.peek(key.geometry)
    if not isinstance(known, KnownMesh) or known.mesh is None or known.shading != key.shading:
        return None
    return KnownShape(name, key, known.mesh)


def round_key(core: Any, data: CurveData | PointData) -> MeshKey:
    """The key of curves or points; of shading they have no more than what passes tell."""
    places = (data.positions, data.radii, data.motion_positions, data.motion_radii)
    if isinstance(data, CurveData):
        kind = f"curves {data.shape} {data.subdivisions}".encode()
        geometry = kind + digest(core, (*places, data.curve_offsets))
        shading = digest(core, (data.curve_materials, data.curve_uvs, data.step_positions))
    else:
        geometry = b"points" + digest(core, places)
        shading = digest(core, (data.step_positions,))
    return MeshKey(geometry, shading + attribute_digest(core, data.attributes))


def attribute_digest(core: Any, attributes: Mapping[str, Attribute]) -> bytes:
    """Of named arrays; nothing where there are none."""
    if not attributes:
        return b""
    names = repr([(name, a.domain) for name, a in attributes.items()]).encode()
    return names + digest(core, (a.values for a in attributes.values()))


def digest(core: Any, arrays: Iterable[NDArray[Any] | None], threads: int = 0) -> bytes:
    """128 bits, equal for equal content; of use in this process alone."""
    result = hashlib.blake2b(digest_size=16)
    for array in arrays:
        result.update(b"-" if array is None else repr((array.dtype.str, array.shape)).encode())
        if array is not None:
            result.update(core.content_tags(array, threads=threads))
    return result.digest()
