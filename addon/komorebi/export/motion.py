"""How instances move while the shutter is open: each is found again at the other times."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..scene_data import DoubleArray, FloatArray, InstanceData
from .deform import DeformingShapes
from .shapes import TYPES
from .shutter import Shutter, times
from .walk import Subject, object_of, walk

SURFACE, HAIR = 0, 1  # what of an object an instance shows

# What stays the same over time: object, what of it, instancer, place among its instances.
Key = tuple[int, str, int, int, tuple[int, ...]]


@dataclass(slots=True)
class _Track:
    """The instances of one shape."""

    steps: dict[int, int] = field(default_factory=dict)  # by number; others stand still
    particles: set[int] = field(default_factory=set)  # numbers that are there while they live
    # What was seen at each time: which instances, and 12 numbers of the matrix for each.
    poses: dict[float, tuple[array[int], array[float]]] = field(default_factory=dict)


class InstanceMotion:
    """Follows the instances of a depsgraph, and with them the shapes that deform.

    Objects are told apart as Cycles tells them: by the instancer and Blender's persistent ids.
    """

    def __init__(self, shutter: Shutter, deforming: DeformingShapes) -> None:
        self._shutter = shutter
        self._deforming = deforming
        self._places: dict[Key, tuple[int, int] | None] = {}  # None: more than one has this key
        self._tracks: dict[int, _Track] = {}
        self._steps: dict[tuple[int, int], int] = {}
        self.members: dict[int, NDArray[np.intp]] = {}  # numbers of the instances of each shape

    @property
    def times(self) -> set[float]:
        """The relative times at which `record` has something to see, but the middle."""
        counts = {n for track in self._tracks.values() for n in track.steps.values()}
        return {time for n in counts for time in times(n)} - {0.0} | self._deforming.times

    def place(self, shape: int, number: int, instance: Any, subject: Subject, what: int) -> None:
        """This instance at rest is the one of that number, and shows that shape."""
        steps = self._steps_of(instance, subject)
        if not steps:
            return
        key = _key(instance, subject, what)
        self._places[key] = None if key in self._places else (shape, number)
        track = self._tracks.setdefault(shape, _Track())
        track.steps[number] = steps
        if instance.particle_system is not None:
            track.particles.add(number)

    def record(self, engine: Any, depsgraph: Any, time: float) -> None:
        """Sees where everything is now, at a relative time. Raises RenderCancelled."""
        for instance, subject, what in _shown(engine, depsgraph):
            place = self._places.get(_key(instance, subject, what))
            if place is None:
                continue
            shape, number = place
            if self._deforming.wants(shape, time):
                self._deforming.record(shape, object_of(instance), time)
            track = self._tracks[shape]
            if time in times(track.steps[number]):
                numbers, matrices = track.poses.setdefault(time, (array("q"), array("f")))
                row_x, row_y, row_z, _ = instance.matrix_world
                numbers.append(number)
                matrices.extend(row_x[:] + row_y[:] + row_z[:])

    def finish(self, instances: list[InstanceData]) -> list[InstanceData]:
        """The same, with what moves in groups of its own; a particle that is not there at all of
        its times is left out, as in Cycles."""
        return [part for data in instances for part in self._parts(data)]

    def _steps_of(self, instance: Any, subject: Subject) -> int:
        parent = instance.parent.original if instance.is_instance and instance.parent else None
        key = (subject.address, 0 if parent is None else parent.as_pointer())
        steps = self._steps.get(key)
        if steps is None:
            steps = self._steps[key] = self._shutter.steps(subject.original, parent)
        return steps

    def _parts(self, data: InstanceData) -> Iterator[InstanceData]:
        track = self._tracks.get(data.mesh)
        if track is None:
            yield data
            return
        members = self.members[data.mesh].tolist()
        steps_of = np.array([track.steps.get(number, 0) for number in members])
        particle = np.array([number in track.particles for number in members])
        row_of = np.zeros(max(members) + 1, np.int64)
        row_of[members] = np.arange(len(members))
        poses = {
            time: (row_of[np.frombuffer(numbers, np.int64)],
                   np.frombuffer(rows, np.float32).reshape(-1, 3, 4))
            for time, (numbers, rows) in track.poses.items()
        }  # fmt: skip
        seen = np.zeros(len(members), np.int64)
        moves = np.zeros(len(members), np.bool_)
        for rows, matrices in poses.values():
            seen[rows] += 1
            moves[rows] |= (matrices != data.matrices[rows, :3]).any(axis=(1, 2))
        gone = particle & (steps_of > 0) & (seen < steps_of - 1)
        for steps in np.unique(steps_of[moves & ~gone]).tolist():
            chosen = moves & ~gone & (steps_of == steps)
            part = data.take(chosen)
            part.motion = _motion(poses, chosen, part.matrices, steps)
            yield part
        still = ~(moves | gone)
        if still.any():
            yield data if still.all() else data.take(still)


def _motion(
    poses: dict[float, tuple[Any, FloatArray]], chosen: NDArray[np.bool_], rest: FloatArray,
    steps: int,
) -> DoubleArray:  # fmt: skip
    """Poses [chosen, steps, 4, 4] of the chosen rows, at rest where nothing was seen."""
    motion = np.repeat(rest[:, None], steps, axis=1).astype(np.float64)
    place = np.cumsum(chosen) - 1
    for step, time in enumerate(times(steps)):
        if time in poses:
            rows, matrices = poses[time]
            mine = chosen[rows]
            motion[place[rows[mine]], step, :3] = matrices[mine]
    return motion


def _shown(engine: Any, depsgraph: Any) -> Iterator[tuple[Any, Subject, int]]:
    for _, instance, subject in walk(engine, depsgraph):
        if subject.kind not in TYPES:
            continue
        if instance.show_self:
            yield instance, subject, SURFACE
        if instance.show_particles:
            yield instance, subject, HAIR


def _key(instance: Any, subject: Subject, what: int) -> Key:
    if not instance.is_instance:
        return subject.address, subject.kind, what, 0, ()
    parent = instance.parent
    of_parent = parent.original.as_pointer() if parent else 0
    return subject.address, subject.kind, what, of_parent, instance.persistent_id[:]
