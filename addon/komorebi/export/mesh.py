"""A mesh of Blender → MeshData. Primitive ids stay Blender's loop-triangle indices."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import compat
from ..scene_data import IntArray, MeshData

MAX_NATIVE_CORNERS = 4  # the core triangulates triangles and quads by Blender's own rule


def export_mesh(mesh: Any, name: str) -> MeshData | None:
    """The arrays of an evaluated mesh; None when it has no face."""
    if not len(mesh.polygons):
        return None
    verts = compat.corner_verts(mesh)
    starts, totals = compat.face_ranges(mesh)
    offsets = np.zeros(len(starts) + 1, np.int32)
    np.cumsum(totals, out=offsets[1:])

    tri2corner = tri2face = None
    if totals.max() > MAX_NATIVE_CORNERS:
        tri2corner, tri2face = _loop_triangles(mesh)
    smooth = compat.smooth_faces(mesh)
    normals = None
    if smooth.any():
        normals = compat.corner_normals(mesh, verts)
        # Broken custom normals may hold anything: a zero makes the core use the flat normal.
        normals[~np.isfinite(normals).all(axis=1)] = 0.0

    if not np.array_equal(starts, offsets[:-1]) or offsets[-1] != len(verts):
        order = _face_order(starts, totals)
        if tri2corner is not None:
            new_corner = np.zeros(len(verts), np.int32)
            new_corner[order] = np.arange(len(order), dtype=np.int32)
            tri2corner = new_corner[tri2corner]
        verts = verts[order]
        normals = None if normals is None else normals[order]

    return MeshData(
        name=name,
        positions=compat.positions(mesh),
        corner_verts=verts,
        face_offsets=offsets,
        tri2corner=tri2corner,
        tri2face=tri2face,
        corner_normals=normals,
        smooth_faces=None if normals is None or smooth.all() else smooth,
        face_materials=compat.face_materials(mesh),
    )


def _loop_triangles(mesh: Any) -> tuple[IntArray, IntArray]:
    """Blender's triangulation: corners of each triangle [triangles, 3] and its face."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    corners = np.empty(count * 3, np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    faces = np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    return corners.reshape(-1, 3), faces


def _face_order(starts: IntArray, totals: IntArray) -> IntArray:
    """Old releases allow faces whose corners lie anywhere: the corners in the order of faces."""
    first = np.repeat(starts - np.cumsum(totals) + totals, totals)
    order: IntArray = (first + np.arange(int(totals.sum()))).astype(np.int32)
    return order
