"""A mesh of Blender → MeshData. Primitive ids stay Blender's loop-triangle indices."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from .. import compat
from ..mesh_cache import attribute_digest, digest
from ..scene_data import Attribute, FloatArray, IntArray, MeshData, MeshKey
from .attributes import Found, read_mesh_attributes, read_tangents, uv_map_of_tangents

MAX_NATIVE_CORNERS = 4  # the core triangulates triangles and quads by Blender's own rule


class MeshReader:
    """Reads an evaluated mesh that has faces: first what tells it from others, then the rest.

    `topology` is what the mesh had when it was read last. What takes longest, normals and the
    triangles of faces with many corners, follows from the rest and is not read when the mesh is
    known.
    """

    def __init__(
        self, mesh: Any, name: str, with_uvs: bool = False, attributes: Collection[str] = (),
        topology: compat.Topology | None = None,
    ) -> None:  # fmt: skip
        self._mesh = mesh
        self._name = name
        self._positions = compat.positions(mesh)
        self.topology = compat.Topology.of(mesh, topology)
        self._smooth = compat.smooth_faces(mesh)
        self._materials = compat.face_materials(mesh)
        self._uvs = compat.corner_uvs(mesh) if with_uvs else None
        self._found = read_mesh_attributes(mesh, attributes)
        self._tangents = {name for name in attributes if uv_map_of_tangents(name) is not None}
        self._along = Found()  # the tangents, when `data` has read them
        self._normals: tuple[FloatArray | None, FloatArray | None] | None = None

    def key(self, core: Any) -> MeshKey:
        """Digests of all that the arrays of `data` follow from."""
        sources = compat.normal_sources(self._mesh) if self._smooth.any() else ()
        if sources is None:  # the normals themselves have to tell
            sources = self._read_normals()
        return MeshKey(
            b"mesh" + digest(core, (self._positions, self.topology.verts, self.topology.offsets)),
            digest(core, (self._smooth, self._materials, self._uvs, *sources))
            + self._attribute_digest(core),
        )

    def _attribute_digest(self, core: Any) -> bytes:
        found = attribute_digest(core, self._found.attributes)
        if not self._tangents:
            return found
        # Tangents follow from UV maps and the rest of the key.
        maps = {uv_map_of_tangents(name) or "" for name in self._tangents}
        sources = read_mesh_attributes(self._mesh, maps).attributes
        names = repr(sorted(self._tangents)).encode()
        return found + names + attribute_digest(core, sources)

    @property
    def problems(self) -> list[str]:
        """Sentences on attributes that cannot be read; all of them when `data` is there."""
        return self._found.problems + self._along.problems

    def data(self) -> MeshData:
        order, verts, offsets = self.topology.order, self.topology.verts, self.topology.offsets
        tri2corner = tri2face = None
        if (offsets[1:] - offsets[:-1]).max() > MAX_NATIVE_CORNERS:
            tri2corner, tri2face = _loop_triangles(self._mesh)
        by_corner, by_vertex = self._read_normals()
        uvs = self._uvs
        if order is not None:
            if tri2corner is not None:
                new_corner = np.zeros(len(verts), np.int32)
                new_corner[order] = np.arange(len(order), dtype=np.int32)
                tri2corner = new_corner[tri2corner]
            by_corner = None if by_corner is None else by_corner[order]
            uvs = None if uvs is None else uvs[order]
        self._along = read_tangents(self._mesh, self._tangents)
        attributes = {
            name: Attribute(a.domain, a.values[order])
            if order is not None and a.domain == "CORNER" else a
            for name, a in (self._found.attributes | self._along.attributes).items()
        }  # fmt: skip
        flat = by_corner is None and by_vertex is None
        return MeshData(
            name=self._name,
            positions=self._positions,
            corner_verts=verts,
            face_offsets=offsets,
            tri2corner=tri2corner,
            tri2face=tri2face,
            corner_normals=by_corner,
            vertex_normals=by_vertex,
            smooth_faces=None if flat or self._smooth.all() else self._smooth,
            face_materials=self._materials,
            corner_uvs=uvs,
            attributes=attributes,
        )

    def velocity(self) -> FloatArray | None:
        """How vertices move [vertices, 3], metres a second; None without that attribute."""
        return compat.point_attribute(self._mesh, "velocity", "FLOAT_VECTOR", 3)

    def at_other_time(self, mesh: Any) -> tuple[FloatArray, FloatArray | None] | None:
        """Positions of the same mesh as it is evaluated now, and whichever normals `data` has; None
        if its faces or the kind of its normals are others."""
        other = MeshReader(mesh, self._name, topology=self.topology)
        if other.topology is not self.topology and not self.topology.equals(other.topology):
            return None
        if not np.array_equal(self._smooth, other._smooth):
            return None
        for mine, normals in zip(self._read_normals(), other._read_normals(), strict=True):
            if (mine is None) != (normals is None):
                return None
            if normals is not None:
                by_corner = normals is other._read_normals()[0]
                order = self.topology.order if by_corner else None
                return other._positions, normals if order is None else normals[order]
        return other._positions, None

    def _read_normals(self) -> tuple[FloatArray | None, FloatArray | None]:
        """By corner in Blender's order, or by vertex; neither where all faces are flat."""
        if self._normals is None:
            if not self._smooth.any():
                self._normals = (None, None)
            elif compat.has_corner_normals(self._mesh):
                self._normals = (compat.corner_normals(self._mesh), None)
            else:
                self._normals = (None, compat.vertex_normals(self._mesh))
        return self._normals


def _loop_triangles(mesh: Any) -> tuple[IntArray, IntArray]:
    """Blender's triangulation: corners of each triangle [triangles, 3] and its face."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    corners = np.empty(count * 3, np.int32)
    mesh.loop_triangles.foreach_get("loops", corners)
    faces = np.empty(count, np.int32)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    return corners.reshape(-1, 3), faces
