"""Meshes that deform while the shutter is open: their vertices at the other times."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from .. import compat, core, mesh_cache, reporting
from ..scene_data import AnyMesh, FloatArray, MeshData, MeshKey
from .mesh import MeshReader
from .names import name_of
from .shutter import Shutter, times

# What the core does not blur by how it deforms, though it follows the object's own motion.
UNBLURRED = {"CURVES": "hair curves", "POINTCLOUD": "points"}
FIRST = -1.0  # the time at which they are looked at once more

# The attribute that fluids, caches and geometry nodes leave: metres a second, by vertex.
VELOCITY = "velocity"


@dataclass(slots=True)
class _Mesh:
    """A mesh that may deform, as it is at rest and at the other times."""

    reader: MeshReader
    data: MeshData
    key: MeshKey  # of what it is at rest
    times: list[float]
    seen: dict[float, tuple[FloatArray, FloatArray | None]] = field(default_factory=dict)

    @property
    def moves(self) -> bool:
        return self.data.motion_positions is not None or self.data.step_positions is not None


class DeformingMeshes:
    """Follows those shapes of a view layer of which Blender or a velocity says that they move."""

    def __init__(self, engine: Any, depsgraph: Any, shutter: Shutter | None) -> None:
        self._engine = engine
        self._depsgraph = depsgraph
        self._scene = depsgraph.scene
        self._shutter = shutter
        self._meshes: dict[int, _Mesh] = {}  # by shape
        self._by_object: dict[int, _Mesh] = {}  # by the original's address
        self._unblurred: dict[int, FloatArray] = {}  # positions at rest, by shape
        self._hair: list[Any] = []  # emitters

    @property
    def times(self) -> set[float]:
        """The relative times at which `record` has something to see, but the middle."""
        found = {time for mesh in self._meshes.values() for time in mesh.times}
        return found | ({FIRST} if self._unblurred else set())

    def may_deform(self, obj: Any) -> bool:
        """Whether the mesh of an evaluated object may change its shape, by Cycles' rule."""
        if obj.type != "MESH" or self._steps(obj) == 0:
            return False
        if obj.data.attributes.get(VELOCITY) is not None:
            return True
        # Of what an object shows in place of its own data, nothing tells whether it deforms.
        own = obj.original.evaluated_get(self._depsgraph).data
        return own == obj.data and bool(obj.is_deform_modified(self._scene, "RENDER"))

    def follow(self, shape: int, obj: Any, reader: MeshReader) -> MeshData:
        """The mesh of `obj` at rest, to be the shape of that index; `finish` gives it its key."""
        mesh = _Mesh(reader, reader.data(), reader.key(core.load()), [])
        self._meshes[shape] = mesh
        self._by_object[obj.original.as_pointer()] = mesh
        velocity = reader.velocity()
        if velocity is None:
            mesh.times = [time for time in times(self._steps(obj)) if time != 0.0]
        elif self._shutter is not None:
            render = self._scene.render
            seconds = self._shutter.duration * render.fps_base / render.fps
            reach = np.float32(0.5 * seconds) * velocity
            rest = mesh.data.positions
            self._set_positions(mesh.data, np.stack([rest - reach, rest + reach]))
        return mesh.data

    def watch(self, shape: int, obj: Any, positions: FloatArray) -> None:
        """Hair curves or points, of which a warning will tell if they deform."""
        if self._steps(obj):
            self._unblurred[shape] = positions

    def watch_hair(self, obj: Any) -> None:
        """Hair on an emitter, likewise."""
        if self._steps(obj):
            self._hair.append(obj.original)

    def wants(self, shape: int, time: float) -> bool:
        """Whether `record` is to be called for an instance of a shape at a relative time; once is
        enough."""
        mesh = self._meshes.get(shape)
        if mesh is not None:
            return time in mesh.times and time not in mesh.seen
        return time == FIRST and shape in self._unblurred

    def record(self, shape: int, obj: Any, time: float) -> None:
        """Takes the vertices of a shape as an evaluated object has them now."""
        mesh = self._meshes.get(shape)
        if mesh is None:
            self._look_again(shape, obj)
            return
        with compat.mesh_of(obj) as evaluated:
            seen = mesh.reader.at_other_time(evaluated)
        if seen is not None:
            mesh.seen[time] = seen
        else:
            mesh.times.clear()
            self._warn(mesh.data.name, "its faces change while the shutter is open")

    def _look_again(self, shape: int, obj: Any) -> None:
        rest = self._unblurred.pop(shape)
        now = compat.point_attribute(obj.data, "position", "FLOAT_VECTOR", 3)
        if now is None or now.shape != rest.shape or (now != rest).any():
            self._warn(name_of(obj), f"its {UNBLURRED[obj.type]} change their shape")

    def finish(self, meshes: list[AnyMesh]) -> None:
        """Gives what was followed its motion and its key, or the mesh that is known by that."""
        for shape, mesh in self._meshes.items():
            self._set_motion(mesh)
            mesh.data.key = _key_in_time(mesh.key, mesh.data)
            meshes[shape] = mesh_cache.find(mesh.data.name, mesh.data.key) or mesh.data
        for emitter in self._hair:
            own = self._by_object.get(emitter.as_pointer())
            dynamic = any(system.use_hair_dynamics for system in emitter.particle_systems)
            if dynamic or (own is not None and own.moves):
                self._warn(name_of(emitter), "its hair changes its shape")

    def _set_motion(self, mesh: _Mesh) -> None:
        if not mesh.times or len(mesh.seen) < len(mesh.times):  # not there at all of its times
            return
        data = mesh.data
        seen = [mesh.seen[time] for time in mesh.times]
        positions = np.stack([positions for positions, _ in seen])
        if (positions == data.positions).all():
            return
        self._set_positions(data, positions)
        if data.motion_positions is None:
            return
        normals = [normals for _, normals in seen if normals is not None]
        if len(normals) == len(seen):
            data.motion_normals = np.stack(normals)

    def _set_positions(self, data: MeshData, positions: FloatArray) -> None:
        if self._shutter is not None and self._shutter.is_open:
            data.motion_positions = positions
        else:
            data.step_positions = positions

    def _steps(self, obj: Any) -> int:
        shutter = self._shutter
        if shutter is None or (shutter.is_open and not compat.uses_deform_motion(obj.original)):
            return 0
        return shutter.steps(obj.original)

    def _warn(self, name: str, why: str) -> None:
        is_open = self._shutter is not None and self._shutter.is_open
        what = "which is not blurred" if is_open else "which the pass Vector leaves out"
        reporting.warn(self._engine, f'object "{name}": {why}, {what}; its own motion is not lost')


def _key_in_time(rest: MeshKey, data: MeshData) -> MeshKey:
    """The key of a mesh that at rest would have that one."""
    moved, turned, steps = data.motion_positions, data.motion_normals, data.step_positions
    digest = partial(mesh_cache.digest, core.load())
    geometry = b"" if moved is None else digest((moved,))
    shading = b"" if moved is None and steps is None else digest((turned, steps))
    return MeshKey(rest.geometry + geometry, rest.shading + shading)
