"""Everything that renders, with its place: one shape per unique data, many instances."""

from __future__ import annotations

from array import array
from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import compat, reporting
from ..errors import RenderCancelled
from ..scene_data import InstanceData, ObjectData, SceneData, UIntArray
from ..unchanged import Unchanged
from .instance_matrices import AllAtOnce, OneByOne, loses_memory
from .materials import MaterialExporter
from .names import name_of
from .shapes import NONE, TYPES, ShapeExporter
from .unsupported import warn_object
from .visibility import Visibility
from .wanted import Wanted

UNSUPPORTED_TYPES = {"VOLUME": "a volume"}  # grease pencil is drawn by Blender, over the picture
CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop


@dataclass(slots=True)
class _Subject:
    """What some instances show: the same object with the same data, so all but place is equal."""

    original: Any
    ignored: str  # its type, if that is not rendered
    surface: int | None = None  # index of an entry or NONE; None: not asked for yet
    hair: int | None = None


@dataclass(frozen=True, slots=True)
class _Entry:
    """What all instances of one shape of one subject have in common."""

    shape: int
    object_index: int
    slots: int


def export_instances(
    engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged
) -> None:
    """Fills shapes, instances, objects, materials and what was ignored into `data`."""
    exporter = _Exporter(engine, depsgraph, data, wanted, unchanged)
    exporter.walk()
    data.instances = exporter.groups()
    data.ignored = dict(exporter.ignored)


class _Exporter:
    """One walk over the instances of a depsgraph; a few numbers are kept of each, no object."""

    def __init__(
        self, engine: Any, depsgraph: Any, data: SceneData, wanted: Wanted, unchanged: Unchanged
    ) -> None:
        self._engine = engine
        self._depsgraph = depsgraph
        self._data = data
        self._object2index: dict[int, int] = {}
        self._shapes = ShapeExporter(engine, depsgraph, data.meshes, wanted, unchanged)
        self._visibility = Visibility(depsgraph)
        self._materials = (
            MaterialExporter(depsgraph.view_layer, data.materials) if wanted.materials else None
        )
        self._entries: list[_Entry] = []
        # Of each instance that is taken, in the order of the walk:
        self._entry = array("I")
        self._masks = array("I")
        self._flags = array("I")
        self._matrices: OneByOne | AllAtOnce = OneByOne()
        self.ignored: Counter[str] = Counter()

    def walk(self) -> None:
        """Takes every instance. Raises RenderCancelled."""
        instances = iter(self._depsgraph.object_instances)
        try:
            walked = self._take_all(instances)
        finally:
            deque(instances, 0)  # an instancer's list of instances is freed at its end only
        self._matrices.finish(self._depsgraph, walked)

    def _take_all(self, instances: Iterator[Any]) -> int:
        subjects: dict[Any, _Subject] = {}
        walked = 0
        while True:
            if self._engine.test_break():
                raise RenderCancelled
            before = walked
            for walked, instance in enumerate(islice(instances, CANCEL_INTERVAL), before + 1):
                if walked == 1 and not loses_memory(instance):
                    self._matrices = AllAtOnce()
                inner = instance.instance_object
                key = (inner, instance.path_resolve("object.data")) if inner else instance.object
                subject = subjects.get(key)
                if subject is None:
                    obj = _object_of(instance)
                    kind = "" if obj.type in TYPES else obj.type
                    subject = subjects[key] = _Subject(obj.original, kind)
                self._take(subject, instance, walked - 1)
            self._matrices.flush()
            if walked == before:
                return walked

    def _take(self, subject: _Subject, instance: Any, number: int) -> None:
        # A curve, text, surface or metaball comes twice: as itself, and as the mesh that it makes.
        if subject.ignored:
            self._note_ignored(subject, instance.show_self)
            return
        if instance.show_self:
            entry = subject.surface
            if entry is None:
                obj = _object_of(instance)
                entry = subject.surface = self._add_entry(self._shapes.surface_of(obj), obj)
            if entry != NONE:
                self._place(entry, instance, subject.original, number)
        if instance.show_particles:
            entry = subject.hair
            if entry is None:
                obj = _object_of(instance)
                entry = subject.hair = self._add_entry(self._shapes.hair_of(obj), obj)
            if entry != NONE:
                self._place(entry, instance, subject.original, number)

    def _place(self, entry: int, instance: Any, original: Any, number: int) -> None:
        self._entry.append(entry)
        self._matrices.add(instance, number)
        if self._visibility.matters:
            mask, flags = self._visibility.of(instance, original)
            self._masks.append(mask)
            self._flags.append(flags)

    def _add_entry(self, shape: int, obj: Any) -> int:
        if shape == NONE:
            return NONE
        slots = 0 if self._materials is None else self._materials.slots_of(obj)
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

    def _note_ignored(self, subject: _Subject, show_self: bool) -> None:
        kind = subject.ignored
        if kind == "LIGHT":
            self.ignored["lamp"] += 1
        elif kind in UNSUPPORTED_TYPES and show_self:
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

        def chosen(numbers: array[int]) -> UIntArray | None:
            return np.frombuffer(numbers, np.uint32)[members] if numbers else None

        return InstanceData(
            mesh=shape,
            name=self._data.meshes[shape].name,
            matrices=self._matrices.of(members),
            object_index=np.array([e.object_index for e in self._entries], np.uint32)[own],
            mask=chosen(self._masks),
            flags=chosen(self._flags),
            material_slots=(
                None if self._materials is None
                else np.array([e.slots for e in self._entries], np.uint32)[own]
            ),
        )  # fmt: skip


def _object_of(instance: Any) -> Any:
    """The evaluated object that an instance shows.

    For the instances of an instancer Blender makes a passing object each, with data of its own
    where geometry nodes have made them. Whoever asks for it leaves a Python object behind for ever,
    64 (3.4) to 128 bytes (4.5): so only here, once for all instances of the same subject, and only
    where the instanced object itself does not say the same.
    """
    inner = instance.instance_object
    if inner and inner.data == instance.path_resolve("object.data"):
        return inner
    return instance.object


def _object_data(original: Any) -> ObjectData:
    root = original
    while root.parent is not None:
        root = root.parent
    return ObjectData(
        name_of(original), original.pass_index, name_of(root), *compat.shadow_terminator(original)
    )
