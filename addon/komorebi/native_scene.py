"""SceneData → the core's Scene. Runs on a thread of its own: nothing in here touches bpy."""

from __future__ import annotations

import hashlib
import os
from functools import partial
from typing import Any

import numpy as np

from . import cache
from .scene_data import EnvironmentImage, MeshData, SceneData, WorldData


def build(core: Any, data: SceneData, threads: int, cancel: Any) -> tuple[Any, Any | None]:
    """A committed core.Scene, and its core.Environment if it has one.

    Arrays of a mesh are dropped as soon as the core has its own. Raises what the core raises:
    ValueError and RuntimeError with a sentence, core.Cancelled.
    """
    scene = core.Scene()
    indices = []
    for index, mesh in enumerate(data.meshes):
        key = b"mesh" + mesh.digest()
        native = cache.get(key, partial(_native_mesh, core, mesh, threads, cancel))
        indices.append(scene.add_mesh(native))
        data.meshes[index] = None  # type: ignore[call-overload]
    for group in data.instances:
        scene.add_instances(
            indices[group.mesh], group.matrices, group.object_index,
            mask=group.mask, flags=group.flags, name=group.name,
        )  # fmt: skip
    environment = _set_world(core, scene, data.world)
    camera = data.camera
    scene.set_camera(
        camera.kind, camera.clip_from_world, camera.clip_start, camera.clip_end,
        camera.width, camera.height,
    )  # fmt: skip
    scene.commit(threads=threads, cancel=cancel)
    cache.trim()
    return scene, environment


def _native_mesh(core: Any, mesh: MeshData, threads: int, cancel: Any) -> Any:
    return core.Mesh(
        mesh.name, mesh.positions, mesh.corner_verts, mesh.face_offsets,
        tri2corner=mesh.tri2corner, tri2face=mesh.tri2face, corner_normals=mesh.corner_normals,
        smooth_faces=mesh.smooth_faces, face_materials=mesh.face_materials,
        threads=threads, cancel=cancel,
    )  # fmt: skip


def _set_world(core: Any, scene: Any, world: WorldData) -> Any | None:
    if world.image is None:
        scene.set_world_color(world.color)
        return None
    image = world.image
    environment = cache.get(_image_key(image), lambda: _native_environment(core, image))
    scene.set_world_environment(
        environment, strength=world.strength, texture_from_world=world.texture_from_world
    )
    return environment


def _native_environment(core: Any, image: EnvironmentImage) -> Any:
    if image.pixels is not None:
        return core.Environment.from_pixels(image.name, image.pixels)
    return core.Environment.from_file(image.path, color_space=image.color_space)


def _image_key(image: EnvironmentImage) -> bytes:
    digest = hashlib.blake2b(digest_size=16)
    if image.pixels is not None:
        digest.update(repr(image.pixels.shape).encode())
        digest.update(np.ascontiguousarray(image.pixels).data)
    else:
        # A file is known by path, size and time of change; reading it all would cost as much
        # as loading it.
        assert image.path is not None
        status = os.stat(image.path)
        stamp = (image.path, image.color_space, status.st_size, status.st_mtime_ns, status.st_ino)
        digest.update(repr(stamp).encode("utf-8", "surrogateescape"))
    return b"image" + digest.digest()
