"""Which shapes change while the shutter is open; they are seen again at the other times."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .. import compat, mesh_cache, reporting
from ..scene_data import AnyMesh, FloatArray, MeshData
from .mesh import MeshReader
from .moving_hair import HairReader
from .moving_keys import Keys, MovingKeys
from .moving_mesh import MovingMesh
from .names import name_of
from .shutter import Shutter, times

# What an object shows in place of its own data: in Cycles, too, it is not blurred by how it
# deforms, though it follows the object's own motion.
UNBLURRED = {"CURVES": "hair curves", "POINTCLOUD": "points"}
FIRST = -1.0  # the time at which it is looked at once more

# The attribute that fluids, caches and geometry nodes leave: metres a second, by vertex or point.
VELOCITY = "velocity"


class DeformingShapes:
    """Follows those shapes of a view layer of which Blender or a velocity says that they move."""

    def __init__(self, engine: Any, depsgraph: Any, shutter: Shutter | None) -> None:
        self._engine = engine
        self._depsgraph = depsgraph
        self._scene = depsgraph.scene
        self._shutter = shutter
        self._followed: dict[int, MovingMesh | MovingKeys] = {}  # by shape
        self._meshes: dict[int, MovingMesh] = {}  # of them, by the original's address
        self._unblurred: dict[int, FloatArray] = {}  # positions at rest, by shape

    @property
    def times(self) -> set[float]:
        """The relative times at which `record` has something to see, but the middle."""
        found = {time for shape in self._followed.values() for time in shape.times}
        return found | ({FIRST} if self._unblurred else set())

    def may_deform(self, obj: Any) -> bool:
        """Whether what an evaluated object shows may change its shape, by Cycles' rule."""
        if self._steps(obj) == 0:
            return False
        if obj.data.attributes.get(VELOCITY) is not None:
            return True
        # Of what an object shows in place of its own data, nothing tells whether it deforms.
        return self._is_own(obj) and bool(obj.is_deform_modified(self._scene, "RENDER"))

    def follow(self, shape: int, obj: Any, reader: MeshReader) -> MeshData:
        """The mesh of `obj` at rest, to be the shape of that index; `finish` gives it its key."""
        mesh = MovingMesh(reader, self._times(obj))
        self._followed[shape] = self._meshes[obj.original.as_pointer()] = mesh
        self._take_velocity(mesh, reader.velocity())
        return mesh.data

    def follow_keys(self, shape: int, obj: Any, data: Keys, read: Callable[[Any], Any]) -> None:
        """Likewise hair curves or points, which `read` reads of an evaluated object."""
        keys = MovingKeys(data, self._times(obj), lambda now, _: read(now))
        self._followed[shape] = keys
        self._take_velocity(keys, compat.point_attribute(obj.data, VELOCITY, "FLOAT_VECTOR", 3))

    def follow_hair(self, shape: int, obj: Any, data: Any) -> bool:
        """Likewise the hair on an emitter; False if nothing is to be known of its motion."""
        if not self._steps(obj):
            return False
        reader = HairReader(obj, data, self._scene)
        self._followed[shape] = MovingKeys(data, self._times(obj), reader)
        return True

    def watch(self, shape: int, obj: Any, data: Keys) -> None:
        """Curves or points that are not followed: a warning will tell if they deform."""
        if self._steps(obj) and not self._is_own(obj):
            self._unblurred[shape] = data.positions

    def wants(self, shape: int, time: float) -> bool:
        """Whether `record` is to be called for an instance of a shape at a relative time; once is
        enough."""
        followed = self._followed.get(shape)
        if followed is not None:
            return time in followed.times and time not in followed.seen
        return time == FIRST and shape in self._unblurred

    def record(self, shape: int, obj: Any, time: float) -> None:
        """Takes a shape as an evaluated object has it now."""
        followed = self._followed.get(shape)
        if followed is None:
            self._look_again(shape, obj)
            return
        ground = self._meshes.get(obj.original.as_pointer())
        restless = ground is not None and ground.moved(time)
        if not followed.record(obj, time, restless):
            followed.times.clear()
            self._warn(followed.data.name, f"{followed.changed} while the shutter is open")

    def finish(self, meshes: list[AnyMesh]) -> None:
        """Gives what was followed its motion and its key, or the shape that is known by that."""
        for shape, followed in self._followed.items():
            # Without times it has a velocity or none; else it may not be there at all of them.
            if followed.times and len(followed.seen) == len(followed.times):
                followed.take_seen(self._is_open)
            followed.set_key()
            data = followed.data
            known = None if data.key is None else mesh_cache.find(data.name, data.key)
            meshes[shape] = known or data

    @property
    def _is_open(self) -> bool:
        return self._shutter is not None and self._shutter.is_open

    def _times(self, obj: Any) -> list[float]:
        return [time for time in times(self._steps(obj)) if time != 0.0]

    def _take_velocity(self, shape: MovingMesh | MovingKeys, velocity: FloatArray | None) -> None:
        if velocity is None or self._shutter is None:
            return
        render = self._scene.render
        seconds = self._shutter.duration * render.fps_base / render.fps
        shape.times.clear()
        shape.take_velocity(np.float32(0.5 * seconds) * velocity, self._is_open)

    def _is_own(self, obj: Any) -> bool:
        """Whether it shows its own data, and not what comes in their place."""
        own = obj.original.evaluated_get(self._depsgraph).data
        return bool(own == obj.data)

    def _look_again(self, shape: int, obj: Any) -> None:
        rest = self._unblurred.pop(shape)
        now = compat.point_attribute(obj.data, "position", "FLOAT_VECTOR", 3)
        if now is None or now.shape != rest.shape or (now != rest).any():
            self._warn(name_of(obj), f"its {UNBLURRED[obj.type]} change their shape")

    def _steps(self, obj: Any) -> int:
        shutter = self._shutter
        if shutter is None or (shutter.is_open and not compat.uses_deform_motion(obj.original)):
            return 0
        return shutter.steps(obj.original)

    def _warn(self, name: str, why: str) -> None:
        what = "which is not blurred" if self._is_open else "which the pass Vector leaves out"
        reporting.warn(self._engine, f'object "{name}": {why}, {what}; its own motion is not lost')
