"""What an object shows, as MeshData, CurveData or PointData: each unique data once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .. import compat, core, mesh_cache, reporting
from ..errors import RenderCancelled
from ..scene_data import AnyMesh, CurveData, PointData
from ..unchanged import Unchanged
from .attributes import read_round_attributes
from .curves import export_curves
from .deform import DeformingShapes
from .hair import export_hair, hair_systems
from .mesh import MeshReader
from .names import name_of
from .points import export_points
from .wanted import Wanted

TYPES = {"MESH", "CURVES", "POINTCLOUD"}
NONE = -1  # the index of a shape that shows nothing


class ShapeExporter:
    """Fills the list of meshes of one view layer."""

    def __init__(
        self, engine: Any, depsgraph: Any, meshes: list[AnyMesh], wanted: Wanted,
        unchanged: Unchanged, deforming: DeformingShapes,
    ) -> None:  # fmt: skip
        self._engine = engine
        self._core = core.load()
        self._unchanged = unchanged
        self._deforming = deforming
        self._scene = depsgraph.scene
        self._meshes = meshes
        self._wanted = wanted
        self._surfaces = depsgraph.view_layer.use_solid
        self._strands = depsgraph.view_layer.use_strand
        self._by_data: dict[tuple[int, frozenset[str]], int] = {}
        self._by_emitter: dict[tuple[int, frozenset[str]], int] = {}

    def surface_of(self, obj: Any) -> int:
        """The index of an evaluated object's own surface, of type TYPES, or NONE."""
        if not self._is_shown(obj.type):
            return NONE
        names = self._wanted.attributes_of(obj)
        key = (obj.data.as_pointer(), names)  # unique while the depsgraph holds the data
        index = self._by_data.get(key)
        if index is None:
            index = self._by_data[key] = self._add(self._export(obj))
        return index

    def hair_of(self, obj: Any) -> int:
        """The index of the hair that grows on an evaluated object, or NONE."""
        if not self._strands or obj.type != "MESH" or not hair_systems(obj):
            return NONE
        key = (obj.original.as_pointer(), self._wanted.attributes_of(obj))
        index = self._by_emitter.get(key)
        if index is None:
            index = self._by_emitter[key] = self._add(self._read_hair(obj))
        return index

    def _is_shown(self, kind: str) -> bool:
        return self._strands if kind == "CURVES" else self._surfaces

    def _export(self, obj: Any) -> AnyMesh | None:
        if self._engine.test_break():
            raise RenderCancelled
        if self._deforming.may_deform(obj):  # known only when all of its times are
            return self._read(obj)
        address = (
            obj.data.as_pointer(), obj.original.as_pointer(), self._wanted.uvs,
            self._wanted.attributes_of(obj),
        )  # fmt: skip
        key = self._unchanged.key(address)
        known = None if key is None else mesh_cache.find(name_of(obj), key)
        if known is not None:
            return known
        exported = self._read(obj)
        if exported is not None and exported.key is not None and not compat.is_deferred(obj):
            self._unchanged.remember(address, exported.key)
        return exported

    def _read(self, obj: Any) -> AnyMesh | None:
        if obj.type == "CURVES":
            curves = export_curves(obj.data, name_of(obj), self._scene, self._wanted.uvs)
            self._add_attributes(obj, curves)
            return self._followed(obj, curves, self._read_curves)
        if obj.type == "POINTCLOUD":
            points = _read_points(obj)
            self._add_attributes(obj, points)
            return self._followed(obj, points, _read_points)
        with compat.mesh_of(obj) as mesh:
            return self._read_mesh(obj, mesh) if len(mesh.polygons) else None

    def _read_mesh(self, obj: Any, mesh: Any) -> AnyMesh:
        names = self._wanted.attributes_of(obj)
        original = obj.original.as_pointer()
        known_topology = self._unchanged.topology(original)
        reader = MeshReader(mesh, name_of(obj), self._wanted.uvs, names, known_topology)
        self._unchanged.remember_topology(original, reader.topology)
        if self._deforming.may_deform(obj):
            followed = self._deforming.follow(len(self._meshes), obj, reader)
            self._warn(obj, reader.problems)
            return followed
        key = reader.key(self._core)
        known = mesh_cache.find(name_of(obj), key)
        if known is not None:
            return known
        data = reader.data()
        data.key = key
        self._warn(obj, reader.problems)
        return data

    def _add_attributes(self, obj: Any, data: CurveData | PointData | None) -> None:
        names = self._wanted.attributes_of(obj)
        if data is None or not names:
            return
        found = read_round_attributes(obj.data, names)
        data.attributes = found.attributes
        self._warn(obj, found.problems)

    def _warn(self, obj: Any, problems: list[str]) -> None:
        for problem in problems:
            reporting.warn(
                self._engine, f'object "{name_of(obj)}": {problem}: materials have 0 in its place'
            )

    def _read_hair(self, obj: Any) -> AnyMesh | None:
        hair = export_hair(
            obj, name_of(obj), self._scene, self._wanted.uvs, self._wanted.attributes_of(obj)
        )
        if hair is not None and self._deforming.follow_hair(len(self._meshes), obj, hair):
            return hair
        return self._with_key(hair)

    def _read_curves(self, obj: Any) -> CurveData | None:
        return export_curves(obj.data, name_of(obj), self._scene, uvs=False)

    def _followed(
        self, obj: Any, data: CurveData | PointData | None, read: Callable[[Any], Any]
    ) -> AnyMesh | None:
        """Curves or points, of which `read` reads where they are at other times."""
        if data is not None and self._deforming.may_deform(obj):
            self._deforming.follow_keys(len(self._meshes), obj, data, read)
            return data
        if data is not None:
            self._deforming.watch(len(self._meshes), obj, data)
        return self._with_key(data)

    def _with_key(self, data: CurveData | PointData | None) -> AnyMesh | None:
        if data is None:
            return None
        data.key = mesh_cache.round_key(self._core, data)
        return mesh_cache.find(data.name, data.key) or data

    def _add(self, exported: AnyMesh | None) -> int:
        if exported is None:
            return NONE
        self._meshes.append(exported)
        return len(self._meshes) - 1


def _read_points(obj: Any) -> PointData | None:
    return export_points(obj.data, name_of(obj))
