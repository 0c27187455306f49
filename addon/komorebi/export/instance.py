"""Everything that renders, with its place: one shape per unique data, many instances."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compat, reporting
from ..scene_data import InstanceData, ObjectData, SceneData, UIntArray
from ..unchanged import Unchanged
from .deform import DeformingShapes
from .instance_matrices import AllAtOnce, OneByOne, loses_memory
from .lamps import LampExporter
from .materials import MaterialExporter
from .motion import HAIR, SURFACE, InstanceMotion
from .names import name_of
from .shapes import NONE, TYPES, ShapeExporter
from .unsupported import warn_object
from .visibility import Visibility
from .walk import Subject, object_of, walk
from .wanted import Wanted

UNSUPPORTED_TYPES = {"VOLUME": "a volume"}  # grease pencil is drawn by Blender, over the picture
# Whether an instance of a subject is to be seen.
Shown = Callable[[Any, Subject], bool]
FLUSH_INTERVAL = 256  # instances of which Python's own numbers are kept at a time


@dataclass(frozen=True, slots=True)
class _Entry:
    """What all instances of one shape of one subject have in common."""

    shape: int
    object_index: int
    slots: int


def export_instances(
    engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged,
    deforming: DeformingShapes | None = None, motion: InstanceMotion | None = None,
    shown: Shown | None = None,
) -> None:  # fmt: skip
    """Fills shapes, instances, objects, lamps and materials into `data`; `motion` learns
    which instances there are, and `deforming` which shapes may change. Instances that `shown`
    denies are left out."""
    deforming = deforming or DeformingShapes(engine, depsgraph, None)
    exporter = _Exporter(engine, depsgraph, data, wanted, unchanged, deforming, motion, shown)
    exporter.walk()
    data.instances = exporter.groups()


class _Exporter:
    """One walk over the instances of a depsgraph; a few numbers are kept of each, no object."""

    def __init__(
        self, engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged,
        deforming: DeformingShapes, motion: InstanceMotion | None, shown: Shown | None,
    ) -> None:  # fmt: skip
        self._engine = engine
        self._depsgraph = depsgraph
        self._data = data
        self._object2index: dict[int, int] = {}
        self._motion = motion
        self._shown = shown
        self._lamps = LampExporter(engine, data.lamps)
        self._visibility = Visibility(depsgraph)
        self._materials = MaterialExporter(
            engine, depsgraph.scene, depsgraph.view_layer, data.materials
        )
        asked, materials = wanted.attributes_of, self._materials.attributes_of
        wanted = replace(wanted, attributes_of=lambda obj: asked(obj) | materials(obj))
        self._shapes = ShapeExporter(engine, depsgraph, data.meshes, wanted, unchanged, deforming)
        self._entries: list[_Entry] = []
        # Of each instance that is taken, in the order of the walk:
        self._entry = array("I")
        self._masks = array("I")
        self._flags = array("I")
        self._random = array("I")
        self._matrices: OneByOne | AllAtOnce = OneByOne()

    def walk(self) -> None:
        """Takes every instance. Raises RenderCancelled."""
        number = -1
        for number, instance, subject in walk(self._engine, self._depsgraph):
            if number == 0 and not loses_memory(instance):
                self._matrices = AllAtOnce()
            if self._shown is None or self._shown(instance, subject):
                self._take(subject, instance, number)
            if number % FLUSH_INTERVAL == 0:
                self._matrices.flush()
        self._matrices.finish(self._depsgraph, number + 1)

    def _take(self, subject: Subject, instance: Any, number: int) -> None:
        # A curve, text, surface or metaball comes twice: as itself, and as the mesh that it makes.
        if subject.kind not in TYPES:
            self._take_other(subject, instance)
            return
        if instance.show_self:
            entry = subject.surface
            if entry is None:
                obj = object_of(instance)
                entry = subject.surface = self._add_entry(self._shapes.surface_of(obj), obj)
            if entry != NONE:
                self._place(entry, instance, subject, number, SURFACE)
        if instance.show_particles:
            entry = subject.hair
            if entry is None:
                obj = object_of(instance)
                entry = subject.hair = self._add_entry(self._shapes.hair_of(obj), obj)
            if entry != NONE:
                self._place(entry, instance, subject, number, HAIR)

    def _place(self, entry: int, instance: Any, subject: Subject, number: int, what: int) -> None:
        if self._motion is not None:
            shape = self._entries[entry].shape
            self._motion.place(shape, len(self._entry), instance, subject, what)
        self._entry.append(entry)
        self._matrices.add(instance, number)
        # What is placed before a material asks has none that does. Blender's 32 bits have a sign.
        asks = self._materials.asks_random
        self._random.append(instance.random_id & 0xFFFFFFFF if asks else 0)
        if self._visibility.matters:
            mask, flags = self._visibility.of(instance, subject.original)
            self._masks.append(mask)
            self._flags.append(flags)

    def _add_entry(self, shape: int, obj: Any) -> int:
        if shape == NONE:
            return NONE
        slots = self._materials.slots_of(obj)
        self._entries.append(_Entry(shape, self._object_index(obj.original), slots))
        return len(self._entries) - 1

    def _object_index(self, original: Any) -> int:
        pointer = original.as_pointer()
        index = self._object2index.get(pointer)
        if index is None:
            index = self._object2index[pointer] = len(self._data.objects)
            self._data.objects.append(_object_data(original))
            warn_object(self._engine, self._depsgraph.scene, original)
        return index

    def _take_other(self, subject: Subject, instance: Any) -> None:
        kind = subject.kind
        if not instance.show_self:
            return
        if kind == "LIGHT":
            self._lamps.take(instance, subject)
        elif kind in UNSUPPORTED_TYPES:
            what, name = UNSUPPORTED_TYPES[kind], name_of(subject.original)
            reporting.warn(self._engine, f'object "{name}" is {what}, not rendered yet')

    def groups(self) -> list[InstanceData]:
        """What was taken: shape by shape, the instances of each in the order of the walk."""
        if not self._entry:
            return []
        entry = np.frombuffer(self._entry, np.uint32)
        shape = np.array([e.shape for e in self._entries], np.uint32)[entry]
        order = np.argsort(shape, kind="stable")
        shape = shape[order]
        starts = np.flatnonzero(np.diff(shape)) + 1
        return [self._group(entry, members) for members in np.split(order, starts)]

    def _group(self, entry: UIntArray, members: NDArray[np.intp]) -> InstanceData:
        own = entry[members]
        shape = self._entries[own[0]].shape
        if self._motion is not None:
            self._motion.members[shape] = members

        def chosen(numbers: array[int]) -> UIntArray | None:
            return np.frombuffer(numbers, np.uint32)[members] if numbers else None

        random = chosen(self._random) if self._materials.asks_random else None
        return InstanceData(
            mesh=shape,
            name=self._data.meshes[shape].name,
            matrices=self._matrices.of(members),
            object_index=np.array([e.object_index for e in self._entries], np.uint32)[own],
            mask=chosen(self._masks),
            flags=chosen(self._flags),
            material_slots=np.array([e.slots for e in self._entries], np.uint32)[own],
            random=None if random is None else (random / np.float64(2**32 - 1)).astype(np.float32),
        )


def _object_data(original: Any) -> ObjectData:
    root = original
    while root.parent is not None:
        root = root.parent
    return ObjectData(
        name_of(original), original.pass_index, name_of(root),
        *compat.shadow_terminator(original), tuple(original.color),
    )  # fmt: skip
