"""Everything that renders, with its place: one MeshData per unique data, many instances."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import compat, reporting
from ..errors import RenderCancelled
from ..scene_data import DoubleArray, InstanceData, MeshData, SceneData
from .mesh import export_mesh
from .names import name_of
from .visibility import Visibility

SURFACE_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
UNSUPPORTED_TYPES = {
    "CURVES": "hair curves", "POINTCLOUD": "a point cloud", "VOLUME": "a volume",
    "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil",
}  # fmt: skip
CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class _Group:
    """The instances of one mesh while they are collected."""

    rows: list[int] = field(default_factory=list)  # indices into the depsgraph's instances
    objects: list[int] = field(default_factory=list)
    masks: list[int] = field(default_factory=list)
    flags: list[int] = field(default_factory=list)


def export_instances(engine: Any, depsgraph: Any, data: SceneData) -> None:
    """Fills meshes, instances, object names and what was ignored into `data`."""
    visibility = Visibility(depsgraph)
    key2mesh: dict[tuple[int, int], int] = {}  # −1: no surface
    object2index: dict[int, int] = {}
    groups: list[_Group] = []
    ignored: Counter[str] = Counter()

    for row, instance in enumerate(depsgraph.object_instances):
        if row % CANCEL_INTERVAL == 0 and engine.test_break():
            raise RenderCancelled
        obj = instance.object
        kind = obj.type
        if kind not in SURFACE_TYPES:
            _note_ignored(engine, obj, kind, instance.show_self, ignored)
            continue
        if not instance.show_self:
            continue
        original = obj.original
        pointer = original.as_pointer()
        # A mesh is shared by its pointer; other kinds keep their surface on the object.
        key = (0 if kind == "MESH" else pointer, obj.data.as_pointer())
        mesh = key2mesh.get(key)
        if mesh is None:
            if engine.test_break():
                raise RenderCancelled
            mesh = key2mesh[key] = _add_mesh(obj, data.meshes)
            if mesh >= 0:
                groups.append(_Group())
        if mesh < 0:
            continue
        if pointer not in object2index:
            object2index[pointer] = len(data.object_names)
            data.object_names.append(name_of(original))
        group = groups[mesh]
        group.rows.append(row)
        group.objects.append(object2index[pointer])
        if visibility.matters:
            mask, flags = visibility.of(instance, original)
            group.masks.append(mask)
            group.flags.append(flags)

    data.instances = _build(depsgraph, groups, data.meshes, visibility.matters)
    data.ignored = dict(ignored)


def _add_mesh(obj: Any, meshes: list[MeshData]) -> int:
    with compat.mesh_of(obj) as mesh:
        exported = None if mesh is None else export_mesh(mesh, name_of(obj))
    if exported is None:
        return -1
    meshes.append(exported)
    return len(meshes) - 1


def _note_ignored(
    engine: Any, obj: Any, kind: str, show_self: bool, ignored: Counter[str]
) -> None:
    if kind == "LIGHT":
        ignored["lamp"] += 1
    elif kind in UNSUPPORTED_TYPES and show_self:
        what = UNSUPPORTED_TYPES[kind]
        reporting.warn(engine, f'object "{name_of(obj)}" is {what}, not rendered yet')


def _build(
    depsgraph: Any, groups: list[_Group], meshes: list[MeshData], with_visibility: bool
) -> list[InstanceData]:
    if not groups:
        return []
    matrices = _all_matrices(depsgraph)
    return [
        InstanceData(
            mesh=index,
            name=meshes[index].name,
            matrices=matrices[group.rows],
            object_index=np.array(group.objects, np.uint32),
            mask=np.array(group.masks, np.uint32) if with_visibility else None,
            flags=np.array(group.flags, np.uint32) if with_visibility else None,
        )
        for index, group in enumerate(groups)
    ]


def _all_matrices(depsgraph: Any) -> DoubleArray:
    """world_from_object of every instance [instances, 4, 4], in the order of iteration."""
    instances = depsgraph.object_instances
    columns = np.empty(len(instances) * 16, np.float32)
    instances.foreach_get("matrix_world", columns)
    return columns.reshape(-1, 4, 4).transpose(0, 2, 1).astype(np.float64, order="C")
