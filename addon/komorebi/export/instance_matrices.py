"""World matrices of a depsgraph's instances, collected during one walk over them.

Asked for all at once by foreach_get, a matrix costs a third of what Python takes to read it. But
Blender (3.4 to 4.5) frees the list of an instancer's instances only for those who walk to its end,
and foreach_get looks at the first instance and turns back before it reads any. So where an
instancer comes first, each call loses its whole list, 220 bytes an instance, and matrices are read
one by one.
"""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from ..scene_data import FloatArray


def loses_memory(first: Any) -> bool:
    """Whether reading all at once would, in a depsgraph whose first instance is `first`."""
    if first.is_instance:
        return True
    obj = first.object
    return bool(
        obj.is_instancer
        or len(obj.particle_systems)
        or any(modifier.type == "NODES" for modifier in obj.modifiers)
    )


class OneByOne:
    """Matrices as Python reads them, 48 bytes each when they are kept."""

    def __init__(self) -> None:
        self._fresh: list[float] = []
        self._rows = array("f")

    def add(self, instance: Any, _: int) -> None:
        matrix = instance.matrix_world
        self._fresh += matrix[0][:] + matrix[1][:] + matrix[2][:]

    def flush(self) -> None:
        """To be called now and then: numbers are Python's objects until then."""
        self._rows.fromlist(self._fresh)
        self._fresh.clear()

    def finish(self, depsgraph: Any, walked: int) -> None:
        self.flush()

    def of(self, members: Any) -> FloatArray:
        """float32 [count, 4, 4], M @ p, of those added ones that an index of numpy chooses."""
        rows = np.frombuffer(self._rows, np.float32).reshape(-1, 3, 4)[members]
        matrices = np.empty((len(rows), 4, 4), np.float32)
        matrices[:, :3] = rows
        matrices[:, 3] = (0.0, 0.0, 0.0, 1.0)
        return matrices


class AllAtOnce:
    """Matrices that are read when the walk is over; until then their numbers in it."""

    def __init__(self) -> None:
        self._numbers = array("I")
        self._columns: FloatArray = np.empty((0, 4, 4), np.float32)

    def add(self, _: Any, number: int) -> None:
        self._numbers.append(number)

    def flush(self) -> None:
        pass

    def finish(self, depsgraph: Any, walked: int) -> None:
        """Reads them; the walk had `walked` instances."""
        if self._numbers:
            values = np.empty(16 * walked, np.float32)
            depsgraph.object_instances.foreach_get("matrix_world", values)
            self._columns = values.reshape(walked, 4, 4)

    def of(self, members: Any) -> FloatArray:
        """As OneByOne.of."""
        numbers = np.frombuffer(self._numbers, np.uint32)[members]
        matrices = np.empty((len(numbers), 4, 4), np.float32)
        for column in range(4):  # no second copy of all of them
            matrices[:, :, column] = self._columns[numbers, column]
        return matrices
