"""Everything that renders, with its place: one MeshData per unique data, many instances."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import compat, reporting
from ..errors import RenderCancelled
from ..scene_data import InstanceData, MeshData, ObjectData, SceneData
from .materials import MaterialExporter
from .mesh import export_mesh
from .names import name_of
from .visibility import Visibility
from .wanted import Wanted

UNSUPPORTED_TYPES = {
    "CURVES": "hair curves", "POINTCLOUD": "a point cloud", "VOLUME": "a volume",
    "GPENCIL": "grease pencil", "GREASEPENCIL": "grease pencil",
}  # fmt: skip
CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class _Group:
    """The instances of one mesh while they are collected."""

    rows: list[float] = field(default_factory=list)  # 12 numbers each: rows 0 to 2 of the matrix
    objects: list[int] = field(default_factory=list)
    masks: list[int] = field(default_factory=list)
    flags: list[int] = field(default_factory=list)
    slots: list[int] = field(default_factory=list)


def export_instances(engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted) -> None:
    """Fills meshes, instances, objects, materials and what was ignored into `data`."""
    if not depsgraph.view_layer.use_solid:  # Blender's switch for surfaces, whatever they are
        return
    visibility = Visibility(depsgraph)
    materials = MaterialExporter(depsgraph.view_layer, data.materials)
    key2mesh: dict[int, int] = {}  # −1: no surface
    object2index: dict[int, int] = {}
    groups: list[_Group] = []
    ignored: Counter[str] = Counter()

    for count, instance in enumerate(depsgraph.object_instances):
        if count % CANCEL_INTERVAL == 0 and engine.test_break():
            raise RenderCancelled
        obj = instance.object
        kind = obj.type
        # A curve, text, surface or metaball comes twice: as itself, and as the mesh that it makes.
        if kind != "MESH":
            _note_ignored(engine, obj, kind, instance.show_self, ignored)
            continue
        if not instance.show_self:
            continue
        original = obj.original
        pointer = original.as_pointer()
        key = obj.data.as_pointer()  # unique while the depsgraph holds the data
        mesh = key2mesh.get(key)
        if mesh is None:
            if engine.test_break():
                raise RenderCancelled
            mesh = key2mesh[key] = _add_mesh(obj, data.meshes, wanted)
            if mesh >= 0:
                groups.append(_Group())
        if mesh < 0:
            continue
        if pointer not in object2index:
            object2index[pointer] = len(data.objects)
            data.objects.append(_object_data(original))
        group = groups[mesh]
        # foreach_get('matrix_world') on all is faster, and loses 220 bytes for each instance of
        # particles and geometry nodes (3.4, 4.5); converting whole matrices is 8 times slower.
        row_x, row_y, row_z, _ = instance.matrix_world
        group.rows += row_x[:] + row_y[:] + row_z[:]
        group.objects.append(object2index[pointer])
        if wanted.materials:
            group.slots.append(materials.slots_of(obj))
        if visibility.matters:
            mask, flags = visibility.of(instance, original)
            group.masks.append(mask)
            group.flags.append(flags)

    data.instances = [
        _build(group, mesh, data.meshes[mesh].name) for mesh, group in enumerate(groups)
    ]
    data.ignored = dict(ignored)


def _object_data(original: Any) -> ObjectData:
    root = original
    while root.parent is not None:
        root = root.parent
    return ObjectData(name_of(original), original.pass_index, name_of(root))


def _add_mesh(obj: Any, meshes: list[MeshData], wanted: Wanted) -> int:
    with compat.mesh_of(obj) as mesh:
        exported = export_mesh(mesh, name_of(obj), wanted.uvs)
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
        material_slots=np.array(group.slots, np.uint32) if group.slots else None,
    )
