"""Corners and faces of a mesh, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scene_data import BoolArray, IntArray
from . import structures
from .releases import GENERIC_ATTRIBUTES

# foreach_get copies memory only into an array of the property's very type, and these indices are
# unsigned by Blender's own word: int32 takes item by item, 15 times longer.


PIECE = 1 << 15  # items that are compared at a time, so that nothing leaves the nearest caches


@dataclass(frozen=True, slots=True)
class Topology:
    """How vertices are joined: faces one after the other."""

    verts: IntArray  # of each corner [corners]
    offsets: IntArray  # first corner of each face and the number of corners [faces + 1]
    order: IntArray | None = None  # where the corners lie in Blender's arrays [corners]; None: here

    @classmethod
    def of(cls, mesh: Any, known: Topology | None = None) -> Topology:
        """Of a mesh; `known` itself if that is what it has, which is told without a copy of it."""
        if known is not None and known._is_that_of(mesh):
            return known
        offsets, order = face_offsets(mesh)
        verts = corner_verts(mesh)
        return cls(verts if order is None else verts[order], offsets, order)

    def equals(self, other: Topology) -> bool:
        return _equal(self.verts, other.verts) and _equal(self.offsets, other.offsets)

    def _is_that_of(self, mesh: Any) -> bool:
        faces, corners = len(mesh.polygons), len(mesh.loops)
        if (corners, faces + 1) != (len(self.verts), len(self.offsets)) or self.order is not None:
            return False
        if GENERIC_ATTRIBUTES:
            verts = structures.ints(mesh.attributes[".corner_vert"].data)
            if verts is None or not _equal(verts, self.verts):
                return False
            # Faces have three corners or more.
            return corners == 3 * faces or _equal(face_offsets(mesh)[0], self.offsets)
        known, ends = structures.corners(mesh), structures.faces(mesh)
        if known is None or ends is None or not _equal(known["vertex"].view("<i4"), self.verts):
            return False
        return _equal(ends["start"], self.offsets[:-1]) and all(
            np.array_equal(
                ends["start"][i : i + PIECE] + ends["total"][i : i + PIECE],
                self.offsets[i + 1 : i + PIECE + 1],
            )
            for i in range(0, faces, PIECE)
        )


def _equal(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return len(a) == len(b) and all(
        np.array_equal(a[i : i + PIECE], b[i : i + PIECE]) for i in range(0, len(a), PIECE)
    )


def corner_verts(mesh: Any) -> IntArray:
    """The vertex of each corner [corners]."""
    if GENERIC_ATTRIBUTES:
        result = np.empty(len(mesh.loops), np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", result)
        return result
    corners = structures.corners(mesh)
    if corners is not None:
        return np.array(corners["vertex"]).view(np.int32)
    unsigned = np.empty(len(mesh.loops), np.uint32)
    mesh.loops.foreach_get("vertex_index", unsigned)
    return unsigned.view(np.int32)


def face_offsets(mesh: Any) -> tuple[IntArray, IntArray | None]:
    """First corner of each face and the number of corners [faces + 1], in the order of faces.

    Old releases allow faces whose corners lie anywhere: then also the corners in that order.
    """
    faces, corners = len(mesh.polygons), len(mesh.loops)
    if GENERIC_ATTRIBUTES and corners == 3 * faces:  # triangles all, one after the other
        return np.arange(0, corners + 3, 3, dtype=np.int32), None
    offsets = np.empty(faces + 1, np.int32)
    offsets[-1] = corners
    known = None if GENERIC_ATTRIBUTES else structures.faces(mesh)
    if known is not None:
        offsets[:-1], totals = known["start"], known["total"]
    else:
        mesh.polygons.foreach_get("loop_start", offsets.view(np.uint32)[:-1])
        if GENERIC_ATTRIBUTES:  # faces lie one after the other
            return offsets, None
        unsigned = np.empty(faces, np.uint32)
        mesh.polygons.foreach_get("loop_total", unsigned)
        totals = unsigned.view(np.int32)
    if offsets[0] == 0 and np.array_equal(offsets[:-1] + totals, offsets[1:]):
        return offsets, None
    return face_order(offsets[:-1], totals)


def face_order(starts: IntArray, totals: IntArray) -> tuple[IntArray, IntArray]:
    """Offsets [faces + 1] of faces one after the other, and which corners they then take."""
    offsets = np.zeros(len(starts) + 1, np.int32)
    np.cumsum(totals, out=offsets[1:])
    order: IntArray = np.arange(offsets[-1], dtype=np.int32)
    order += np.repeat(starts - offsets[:-1], totals)
    return offsets, order


def smooth_faces(mesh: Any) -> BoolArray:
    """True for each face that is shaded smooth [faces]."""
    faces = len(mesh.polygons)
    if not GENERIC_ATTRIBUTES:
        known = structures.faces(mesh)
        if known is not None:
            return (known["flag"] & structures.SMOOTH) != 0
        result = np.empty(faces, np.bool_)
        mesh.polygons.foreach_get("use_smooth", result)
        return result
    sharp = mesh.attributes.get("sharp_face")
    if sharp is None or sharp.domain != "FACE" or sharp.data_type != "BOOLEAN":
        return np.ones(faces, np.bool_)
    result = np.empty(faces, np.bool_)
    sharp.data.foreach_get("value", result)
    return ~result
