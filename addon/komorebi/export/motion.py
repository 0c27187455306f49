"""How instances move while the shutter is open: each is found again at the other times."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import RenderCancelled
from ..scene_data import DoubleArray, InstanceData
from .deform import DeformingMeshes
from .shapes import TYPES
from .shutter import Shutter, times

CANCEL_INTERVAL = 256  # instances between two looks at whether Blender wants to stop
SURFACE, HAIR = 0, 1  # what of an object an instance shows

# What stays the same over time: object, what of it, instancer, place among its instances.
Key = tuple[int, str, int, int, tuple[int, ...]]


@dataclass(slots=True)
class _Track:
    """The instances of one shape."""

    steps: dict[int, int] = field(default_factory=dict)  # by row; others stand still
    particles: set[int] = field(default_factory=set)  # rows that are there only while they live
    # What was seen at each time: rows, and 12 numbers of the matrix for each.
    poses: dict[float, tuple[array[int], array[float]]] = field(default_factory=dict)


class InstanceMotion:
    """Follows the instances of a depsgraph, and with them the meshes that deform.

    Objects are told apart as Cycles tells them: by the instancer and Blender's persistent ids.
    """

    def __init__(self, shutter: Shutter, deforming: DeformingMeshes) -> None:
        self._shutter = shutter
        self._deforming = deforming
        self._rows: dict[Key, tuple[int, int] | None] = {}  # None: more than one has this key
        self._tracks: dict[int, _Track] = {}
        self._steps: dict[tuple[int, int], int] = {}

    @property
    def times(self) -> set[float]:
        """The relative times at which `record` has something to see, but the middle."""
        counts = {n for track in self._tracks.values() for n in track.steps.values()}
        return {time for n in counts for time in times(n)} - {0.0} | self._deforming.times

    def place(self, shape: int, row: int, instance: Any, obj: Any, what: int) -> None:
        """Row `row` of the instances of `shape` is this one at rest."""
        steps = self._steps_of(instance, obj)
        if not steps:
            return
        key = _key(instance, obj, what)
        self._rows[key] = None if key in self._rows else (shape, row)
        track = self._tracks.setdefault(shape, _Track())
        track.steps[row] = steps
        if instance.particle_system is not None:
            track.particles.add(row)

    def record(self, engine: Any, depsgraph: Any, time: float) -> None:
        """Sees where everything is now, at a relative time."""
        for count, (instance, obj, what) in enumerate(_shown(depsgraph)):
            if count % CANCEL_INTERVAL == 0 and engine.test_break():
                raise RenderCancelled
            place = self._rows.get(_key(instance, obj, what))
            if place is None:
                continue
            shape, row = place
            if what == SURFACE:
                self._deforming.record(shape, obj, time)
            track = self._tracks[shape]
            if time in times(track.steps[row]):
                rows, numbers = track.poses.setdefault(time, (array("l"), array("d")))
                row_x, row_y, row_z, _ = instance.matrix_world
                rows.append(row)
                numbers.extend(row_x[:] + row_y[:] + row_z[:])

    def finish(self, instances: list[InstanceData]) -> list[InstanceData]:
        """The same, with what moves in groups of its own; a particle that is not there at all of
        its times is left out, as in Cycles."""
        return [part for data in instances for part in self._parts(data)]

    def _steps_of(self, instance: Any, obj: Any) -> int:
        original = obj.original
        parent = instance.parent.original if instance.is_instance and instance.parent else None
        key = (original.as_pointer(), 0 if parent is None else parent.as_pointer())
        steps = self._steps.get(key)
        if steps is None:
            steps = self._steps[key] = self._shutter.steps(original, parent)
        return steps

    def _parts(self, data: InstanceData) -> Iterator[InstanceData]:
        track = self._tracks.get(data.mesh)
        if track is None:
            yield data
            return
        still = np.ones(len(data.matrices), np.bool_)
        for steps in sorted(set(track.steps.values())):
            rows = np.array([row for row, n in track.steps.items() if n == steps], np.int64)
            motion, lived = _poses(track, rows, data.matrices, steps)
            particle = np.array([row in track.particles for row in rows.tolist()], np.bool_)
            gone = particle & ~lived
            moves = (motion != motion[:, :1]).any(axis=(1, 2, 3)) & ~gone
            still[rows[gone | moves]] = False
            if moves.any():
                part = data.take(rows[moves])
                part.motion = motion[moves]
                yield part
        if still.any():
            yield data if still.all() else data.take(still)


def _poses(
    track: _Track, rows: NDArray[np.int64], matrices: DoubleArray, steps: int
) -> tuple[DoubleArray, Any]:
    """[rows, steps, 4, 4], at rest where nothing was seen; whether each was seen at all times."""
    motion = np.repeat(matrices[rows][:, None], steps, axis=1)
    seen = np.zeros((len(rows), steps), np.bool_)
    seen[:, steps // 2] = True
    place = np.full(len(matrices), -1, np.int64)
    place[rows] = np.arange(len(rows))
    for step, time in enumerate(times(steps)):
        if time not in track.poses:
            continue
        found, numbers = track.poses[time]
        at = place[np.frombuffer(found, np.dtype("l"))]
        mine = at >= 0
        motion[at[mine], step, :3] = np.frombuffer(numbers).reshape(-1, 3, 4)[mine]
        seen[at[mine], step] = True
    return motion, seen.all(axis=1)


def _shown(depsgraph: Any) -> Iterator[tuple[Any, Any, int]]:
    for instance in depsgraph.object_instances:
        obj = instance.object
        if obj.type not in TYPES:
            continue
        if instance.show_self:
            yield instance, obj, SURFACE
        if instance.show_particles:
            yield instance, obj, HAIR


def _key(instance: Any, obj: Any, what: int) -> Key:
    address = obj.original.as_pointer()
    if not instance.is_instance:
        return address, obj.type, what, 0, ()
    parent = instance.parent
    of_parent = parent.original.as_pointer() if parent else 0
    return address, obj.type, what, of_parent, instance.persistent_id[:]
