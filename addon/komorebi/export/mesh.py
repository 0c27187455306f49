"""A mesh of Blender → MeshData. Primitive ids stay Blender's loop-triangle indices."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import compat
from ..scene_data import IntArray, MeshData

MAX_NATIVE_CORNERS = 4  # the core triangulates triangles and quads by Blender's own rule


def export_mesh(mesh: Any, name: str, with_uvs: bool = False) -> MeshData | None:
    """The arrays of an evaluated mesh; None when it has no face."""
    if not len(mesh.polygons):
        return None
    verts = compat.corner_verts(mesh)
    offsets, order = compat.face_offsets(mesh)
    tri2corner = tri2face = None
    if (offsets[1:] - offsets[:-1]).max() > MAX_NATIVE_CORNERS:
        tri2corner, tri2face = _loop_triangles(mesh)
    smooth = compat.smooth_faces(mesh)
    by_corner = by_vertex = None
    if smooth.any():
        if compat.has_corner_normals(mesh):
            by_corner = compat.corner_normals(mesh)
        else:
            by_vertex = compat.vertex_normals(mesh)

    uvs = compat.corner_uvs(mesh) if with_uvs else None

    if order is not None:
        if tri2corner is not None:
            new_corner = np.zeros(len(verts), np.int32)
            new_corner[order] = np.arange(len(order), dtype=np.int32)
            tri2corner = new_corner[tri2corner]
        verts = verts[order]
        by_corner = None if by_corner is None else by_corner[order]
        uvs = None if uvs is None else uvs[order]

    flat = by_corner is None and by_vertex is None
    return MeshData(
        name=name,
        positions=compat.positions(mesh),
        corner_verts=verts,
        face_offsets=offsets,
        tri2corner=tri2corner,
        tri2face=tri2face,
        corner_normals=by_corner,
        vertex_normals=by_vertex,
        smooth_faces=None if flat or smooth.all() else smooth,
        face_materials=compat.face_materials(mesh),
        corner_uvs=uvs,
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
