"""Everything that renders, with its place: one shape per unique data, many instances."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import compat, reporting
from ..errors import RenderCancelled
from ..scene_data import InstanceData, ObjectData, SceneData
from ..unchanged import Unchanged
from .deform import DeformingMeshes
from .materials import MaterialExporter
from .motion import HAIR, SURFACE, InstanceMotion
from .names import name_of
from .shapes import NONE, TYPES, ShapeExporter
from .unsupported import warn_object
from .visibility import Visibility
from .wanted import Wanted

UNSUPPORTED_TYPES = {"VOLUME": "a volume"}  # grease pencil is drawn by Blender, over the picture
CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class _Group:
    """The instances of one shape while they are collected."""

    rows: list[float] = field(default_factory=list)  # 12 numbers each: rows 0 to 2 of the matrix
    objects: list[int] = field(default_factory=list)
    masks: list[int] = field(default_factory=list)
    flags: list[int] = field(default_factory=list)
    slots: list[int] = field(default_factory=list)


def export_instances(
    engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged,
    deforming: DeformingMeshes, motion: InstanceMotion | None = None,
) -> None:  # fmt: skip
    """Fills shapes, instances, objects, materials and what was ignored into `data`; `motion` learns
    which instances there are."""
    exporter = _Exporter(engine, depsgraph, data, wanted, unchanged, deforming, motion)
    for count, instance in enumerate(depsgraph.object_instances):
        if count % CANCEL_INTERVAL == 0 and engine.test_break():
            raise RenderCancelled
        exporter.take(instance)
    data.instances = [
        _build(group, shape, data.meshes[shape].name) for shape, group in exporter.groups.items()
    ]
    data.ignored = dict(exporter.ignored)


class _Exporter:
    """One walk over the instances of a depsgraph."""

    def __init__(
        self, engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged,
        deforming: DeformingMeshes, motion: InstanceMotion | None,
    ) -> None:  # fmt: skip
        self._engine = engine
        self._scene = depsgraph.scene
        self._objects = data.objects
        self._object2index: dict[int, int] = {}
        self._shapes = ShapeExporter(engine, depsgraph, data.meshes, wanted, unchanged, deforming)
        self._motion = motion
        self._visibility = Visibility(depsgraph)
        self._materials = (
            MaterialExporter(engine, depsgraph.view_layer, data.materials)
            if wanted.materials
            else None
        )
        self.groups: dict[int, _Group] = {}
        self.ignored: Counter[str] = Counter()

    def take(self, instance: Any) -> None:
        obj = instance.object
        # A curve, text, surface or metaball comes twice: as itself, and as the mesh that it makes.
        if obj.type not in TYPES:
            self._note_ignored(obj, instance.show_self)
            return
        if instance.show_self:
            self._place(self._shapes.surface_of(obj), instance, obj, SURFACE)
        if instance.show_particles:
            self._place(self._shapes.hair_of(obj), instance, obj, HAIR)

    def _place(self, shape: int, instance: Any, obj: Any, what: int) -> None:
        if shape == NONE:
            return
        group = self.groups.get(shape)
        if group is None:
            group = self.groups[shape] = _Group()
        if self._motion is not None:
            self._motion.place(shape, len(group.objects), instance, obj, what)
        original = obj.original
        # foreach_get('matrix_world') on all is faster, and loses 220 bytes for each instance of
        # particles and geometry nodes (3.4, 4.5); converting whole matrices is 8 times slower.
        row_x, row_y, row_z, _ = instance.matrix_world
        group.rows += row_x[:] + row_y[:] + row_z[:]
        group.objects.append(self._object_index(original))
        if self._materials is not None:
            group.slots.append(self._materials.slots_of(obj))
        if self._visibility.matters:
            mask, flags = self._visibility.of(instance, original)
            group.masks.append(mask)
            group.flags.append(flags)

    def _object_index(self, original: Any) -> int:
        pointer = original.as_pointer()
        index = self._object2index.get(pointer)
        if index is None:
            index = self._object2index[pointer] = len(self._objects)
            self._objects.append(_object_data(original))
            warn_object(self._engine, self._scene, original)
        return index

    def _note_ignored(self, obj: Any, show_self: bool) -> None:
        kind = obj.type
        if kind == "LIGHT":
            self.ignored["lamp"] += 1
        elif kind in UNSUPPORTED_TYPES and show_self:
            what = UNSUPPORTED_TYPES[kind]
            reporting.warn(self._engine, f'object "{name_of(obj)}" is {what}, not rendered yet')


def _object_data(original: Any) -> ObjectData:
    root = original
    while root.parent is not None:
        root = root.parent
    return ObjectData(
        name_of(original), original.pass_index, name_of(root), *compat.shadow_terminator(original)
    )


def _build(group: _Group, shape: int, name: str) -> InstanceData:
    count = len(group.objects)
    matrices = np.zeros((count, 4, 4))
    matrices[:, :3, :] = np.array(group.rows).reshape(count, 3, 4)
    matrices[:, 3, 3] = 1.0
    return InstanceData(
        mesh=shape,
        name=name,
        matrices=matrices,
        object_index=np.array(group.objects, np.uint32),
        mask=np.array(group.masks, np.uint32) if group.masks else None,
        flags=np.array(group.flags, np.uint32) if group.flags else None,
        material_slots=np.array(group.slots, np.uint32) if group.slots else None,
    )
