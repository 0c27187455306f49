"""SceneData → the core's Scene. Runs on a thread of its own: nothing in here touches bpy."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import cache
from .cryptomatte import name_id
from .scene_data import (
    AnyMesh,
    CameraData,
    CurveData,
    EnvironmentImage,
    MeshData,
    PointData,
    SceneData,
)


@dataclass(slots=True)
class KnownMesh:
    """The cache's entry for a geometry: the mesh that was made of it last."""

    mesh: Any | None = None  # core.Mesh
    shading: bytes = b""  # digest of what is not its geometry
    builder: str = ""

    @property
    def byte_count(self) -> int:
        return 0 if self.mesh is None else int(self.mesh.byte_count)


@dataclass(slots=True)
class Parts:
    """What all views of a frame share, in the core's own form."""

    meshes: list[Any] = field(default_factory=list)  # core.Mesh, as SceneData.meshes
    environment: Any | None = None  # core.Environment
    builder: str = "LINEAR"  # of the trees that had to be built


def load(core: Any, data: SceneData, expected_rays: float, threads: int, cancel: Any) -> Parts:
    """The core's meshes with their trees, and its environment: those it knows, or new ones.

    Arrays of a mesh are dropped as soon as the core has its own. Raises what the core raises:
    ValueError and RuntimeError with a sentence, core.Cancelled.
    """
    # Normals are no part of the key: Blender 3.4 adds them up in the order of its threads, so that
    # the same mesh has other ones each time, which would build its tree anew.
    keys = [_mesh_key(core, mesh, threads) for mesh in data.meshes]
    image = data.world.image
    image_key = None if image is None else _image_key(core, image, threads)
    cache.make_room({*keys, image_key})
    primitives = sum(_primitive_count(mesh) for mesh in data.meshes)
    builder = core.choose_builder(primitives, expected_rays)
    parts = Parts(builder=builder)
    for index, mesh in enumerate(data.meshes):
        known = cache.get(keys[index], KnownMesh)
        shading = _digest(core, mesh.shading(), threads)
        if known.builder != builder and builder == "SAH":  # a better tree is wanted than is there
            known.mesh, known.shading, known.builder = None, b"", builder
        if known.mesh is None or known.shading != shading:
            known.mesh = _native_mesh(core, mesh, builder, threads, cancel, known.mesh)
            known.shading, known.builder = shading, known.builder or builder
        parts.meshes.append(known.mesh)
        data.meshes[index] = None  # type: ignore[call-overload]
    if image is not None and image_key is not None:
        parts.environment = cache.get(image_key, partial(_native_environment, core, image))
    return parts


def build(
    core: Any, data: SceneData, parts: Parts, camera: CameraData, threads: int, cancel: Any
) -> Any:
    """A committed core.Scene, seen by `camera`; only the tree over instances is built here."""
    scene = core.Scene()
    indices = [scene.add_mesh(mesh) for mesh in parts.meshes]
    for group in data.instances:
        scene.add_instances(
            indices[group.mesh], group.matrices, group.object_index,
            mask=group.mask, flags=group.flags, material_slots=group.material_slots,
            name=group.name,
        )  # fmt: skip
    scene.set_tables(**tables(data))
    world = data.world
    if parts.environment is None:
        scene.set_world_color(world.color)
    else:
        scene.set_world_environment(
            parts.environment,
            strength=world.strength, texture_from_world=world.texture_from_world,
        )  # fmt: skip
    scene.set_camera(
        camera.kind, camera.clip_from_world, camera.clip_start, camera.clip_end,
        camera.width, camera.height,
    )  # fmt: skip
    scene.commit(threads=threads, cancel=cancel)
    return scene


def tables(data: SceneData) -> dict[str, Any]:
    """What passes tell of objects and materials, as the core's Scene.set_tables takes it."""
    materials, slots = data.materials.materials, data.materials.slots
    mattes = [(name_id(o.name), name_id(o.asset)) for o in data.objects]
    return {
        "object_pass_index": np.array([o.pass_index for o in data.objects], np.float32),
        "object_mattes": np.array(mattes, np.uint32).reshape(-1, 2).view(np.float32),
        "material_pass_index": np.array([m.pass_index for m in materials], np.float32),
        "material_mattes": np.array([name_id(m.name) for m in materials], np.uint32).view(
            np.float32
        ),
        "slot_begin": np.cumsum([0, *map(len, slots)], dtype=np.uint32),
        "slots": np.array([m for indices in slots for m in indices], np.uint32),
    }


def _digest(core: Any, arrays: Iterable[NDArray[Any] | None], threads: int) -> bytes:
    """128 bits, equal for equal content; of use in this process alone."""
    digest = hashlib.blake2b(digest_size=16)
    for array in arrays:
        digest.update(b"-" if array is None else repr((array.dtype.str, array.shape)).encode())
        if array is not None:
            digest.update(core.content_tags(array, threads=threads))
    return digest.digest()


def _mesh_key(core: Any, mesh: AnyMesh, threads: int) -> bytes:
    kind = b"mesh" if isinstance(mesh, MeshData) else b"points"
    if isinstance(mesh, CurveData):
        kind = f"curves {mesh.shape} {mesh.subdivisions}".encode()
    return kind + _digest(core, mesh.geometry(), threads)


def _primitive_count(mesh: AnyMesh) -> int:
    if isinstance(mesh, MeshData):
        return len(mesh.corner_verts) - 2 * (len(mesh.face_offsets) - 1)
    return len(mesh.radii)


def _native_mesh(
    core: Any, mesh: AnyMesh, builder: str, threads: int, cancel: Any, same_geometry: Any | None
) -> Any:
    if isinstance(mesh, CurveData):
        return core.Mesh.from_curves(
            mesh.name, mesh.positions, mesh.radii, mesh.curve_offsets, shape=mesh.shape,
            subdivisions=mesh.subdivisions, builder=builder, threads=threads, cancel=cancel,
        )  # fmt: skip
    if isinstance(mesh, PointData):
        return core.Mesh.from_points(
            mesh.name, mesh.positions, mesh.radii, builder=builder, threads=threads, cancel=cancel
        )
    return core.Mesh(
        mesh.name, mesh.positions, mesh.corner_verts, mesh.face_offsets,
        tri2corner=mesh.tri2corner, tri2face=mesh.tri2face, corner_normals=mesh.corner_normals,
        vertex_normals=mesh.vertex_normals, smooth_faces=mesh.smooth_faces,
        face_materials=mesh.face_materials, corner_uvs=mesh.corner_uvs,
        builder=builder, threads=threads, cancel=cancel, same_geometry=same_geometry,
    )  # fmt: skip


def _native_environment(core: Any, image: EnvironmentImage) -> Any:
    if image.pixels is not None:
        return core.Environment.from_pixels(image.name, image.pixels)
    return core.Environment.from_file(image.path, color_space=image.color_space)


def _image_key(core: Any, image: EnvironmentImage, threads: int) -> bytes:
    if image.pixels is not None:
        return b"pixels" + _digest(core, (image.pixels,), threads)
    # A file is known by path, size and time of change; reading it all would cost as much as
    # loading it.
    assert image.path is not None
    status = os.stat(image.path)
    stamp = (image.path, image.color_space, status.st_size, status.st_mtime_ns, status.st_ino)
    return b"file" + repr(stamp).encode("utf-8", "surrogateescape")
