"""A mesh that deforms while the shutter is open: its vertices at the other times."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from .. import compat, core, mesh_cache
from ..scene_data import FloatArray, MeshData, MeshKey
from .mesh import MeshReader
from .moving_shape import MovingShape


class MovingMesh(MovingShape):
    """A mesh as it is at rest and at the other times."""

    changed = "its faces change"

    def __init__(self, reader: MeshReader, times: list[float]) -> None:
        self.data: MeshData = reader.data()
        self.times = times
        self.seen: dict[float, tuple[FloatArray, FloatArray | None]] = {}
        self._reader = reader
        self._rest = reader.key(core.load())  # the key of what it is at rest

    def moved(self, time: float) -> bool:
        """Whether it was elsewhere than at rest when it was seen at that time."""
        seen = self.seen.get(time)
        return seen is not None and bool((seen[0] != self.data.positions).any())

    def record(self, obj: Any, time: float, restless: bool) -> bool:
        """Takes the vertices as an evaluated object has them now; False if its faces are others.

        `restless` is for what grows on a mesh.
        """
        with compat.mesh_of(obj) as evaluated:
            seen = self._reader.at_other_time(evaluated)
        if seen is None:
            return False
        self.seen[time] = seen
        return True

    def take_seen(self, is_open: bool) -> None:
        """What was seen becomes motion, if there is any."""
        seen = [self.seen[time] for time in self.times]
        positions = np.stack([positions for positions, _ in seen])
        if (positions == self.data.positions).all():
            return
        self._set_positions(positions, is_open)
        if not is_open:
            return
        normals = [normals for _, normals in seen if normals is not None]
        if len(normals) == len(seen):
            self.data.motion_normals = np.stack(normals)

    def set_key(self) -> None:
        data = self.data
        moved, turned, steps = data.motion_positions, data.motion_normals, data.step_positions
        digest = partial(mesh_cache.digest, core.load())
        geometry = b"" if moved is None else digest((moved,))
        shading = b"" if moved is None and steps is None else digest((turned, steps))
        self.data.key = MeshKey(self._rest.geometry + geometry, self._rest.shading + shading)
