"""Everything that renders, with its place: one MeshData per unique data, many instances."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import compat, reporting
from ..errors import RenderCancelled
from ..scene_data import AnyMesh, InstanceData, SceneData
from .curves import export_curves
from .hair import export_hair, hair_systems
from .mesh import export_mesh
from .names import name_of
from .points import export_points
from .visibility import Visibility

SURFACE_TYPES = {"MESH", "CURVES", "POINTCLOUD"}
UNSUPPORTED_TYPES = {
    "VOLUME": "a volume", "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil",
}  # fmt: skip
CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class _Group:
    """The instances of one mesh while they are collected."""

    rows: list[float] = field(default_factory=list)  # 12 numbers each: rows 0 to 2 of the matrix
    objects: list[int] = field(default_factory=list)
    masks: list[int] = field(default_factory=list)
    flags: list[int] = field(default_factory=list)


def export_instances(engine: Any, depsgraph: Any, data: SceneData) -> None:
    """Fills meshes, instances, object names and what was ignored into `data`."""
    visibility = Visibility(depsgraph)
    key2mesh: dict[int, int] = {}  # −1: no surface
    key2hair: dict[int, int] = {}  # by emitter
    hair_is_shown = depsgraph.view_layer.use_strand
    object2index: dict[int, int] = {}
    groups: list[_Group] = []
    ignored: Counter[str] = Counter()

    for count, instance in enumerate(depsgraph.object_instances):
        if count % CANCEL_INTERVAL == 0 and engine.test_break():
            raise RenderCancelled
        obj = instance.object
        kind = obj.type
        # A curve, text, surface or metaball comes twice: as itself, and as the mesh that it makes.
        if kind not in SURFACE_TYPES:
            _note_ignored(engine, obj, kind, instance.show_self, ignored)
            continue
        original = obj.original
        pointer = original.as_pointer()
        shown: list[int] = []  # its surface, and its hair
        if instance.show_self:
            key = obj.data.as_pointer()  # unique while the depsgraph holds the data
            mesh = key2mesh.get(key)
            if mesh is None:
                if engine.test_break():
                    raise RenderCancelled
                mesh = key2mesh[key] = _add_mesh(obj, kind, depsgraph.scene, data.meshes)
                if mesh >= 0:
                    groups.append(_Group())
            shown.append(mesh)
        if kind == "MESH" and instance.show_particles and hair_is_shown and hair_systems(obj):
            mesh = key2hair.get(pointer)
            if mesh is None:
                mesh = key2hair[pointer] = _add(
                    export_hair(obj, name_of(obj), depsgraph.scene), data.meshes
                )
                if mesh >= 0:
                    groups.append(_Group())
            shown.append(mesh)
        for mesh in shown:
            if mesh >= 0:
                _place(groups[mesh], instance, original, visibility, object2index, data)

    data.instances = [
        _build(group, mesh, data.meshes[mesh].name) for mesh, group in enumerate(groups)
    ]
    data.ignored = dict(ignored)


def _place(
    group: _Group, instance: Any, original: Any, visibility: Visibility,
    object2index: dict[int, int], data: SceneData,
) -> None:  # fmt: skip
    pointer = original.as_pointer()
    if pointer not in object2index:
        object2index[pointer] = len(data.object_names)
        data.object_names.append(name_of(original))
    # foreach_get('matrix_world') on all is faster, and loses 220 bytes for each instance of
    # particles and geometry nodes (3.4, 4.5); converting whole matrices is 8 times slower.
    row_x, row_y, row_z, _ = instance.matrix_world
    group.rows += row_x[:] + row_y[:] + row_z[:]
    group.objects.append(object2index[pointer])
    if visibility.matters:
        mask, flags = visibility.of(instance, original)
        group.masks.append(mask)
        group.flags.append(flags)


def _add_mesh(obj: Any, kind: str, scene: Any, meshes: list[AnyMesh]) -> int:
    if kind == "CURVES":
        return _add(export_curves(obj.data, name_of(obj), scene), meshes)
    if kind == "POINTCLOUD":
        return _add(export_points(obj.data, name_of(obj)), meshes)
    with compat.mesh_of(obj) as mesh:
        return _add(export_mesh(mesh, name_of(obj)), meshes)


def _add(exported: AnyMesh | None, meshes: list[AnyMesh]) -> int:
    if exported is None:
        return -1
    meshes.append(exported)
    return len(meshes) - 1


def _note_ignored(engine: Any, obj: Any, kind: str, show_self: bool, ignored: Counter[str]) -> None:
    if kind == "LIGHT":
        ignored["lamp"] += 1
    elif kind in UNSUPPORTED_TYPES and show_self:
        what = UNSUPPORTED_TYPES[kind]
        reporting.warn(engine, f'object "{name_of(obj)}" is {what}, not rendered yet')


def _build(group: _Group, mesh: int, name: str) -> InstanceData:
    count = len(group.objects)
    matrices = np.zeros((count, 4, 4))
    matrices[:, :3, :] = np.array(group.rows).reshape(count, 3, 4)
    matrices[:, 3, 3] = 1.0
    return InstanceData(
        mesh=mesh,
        name=name,
        matrices=matrices,
        object_index=np.array(group.objects, np.uint32),
        mask=np.array(group.masks, np.uint32) if group.masks else None,
        flags=np.array(group.flags, np.uint32) if group.flags else None,
    )
