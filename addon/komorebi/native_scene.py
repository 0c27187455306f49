"""SceneData → the core's Scene. Runs on a thread of its own: nothing in here touches bpy."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import (
    cache,
    dump,
    native_lamps,
    native_programs,
    native_surfaces,
    native_texture,
    native_world,
)
from .cryptomatte import name_id
from .mesh_cache import KnownMesh
from .scene_data import (
    AnyMesh,
    CameraData,
    CurveData,
    FloatArray,
    InstanceData,
    KnownShape,
    LampData,
    MeshData,
    MeshKey,
    PointData,
    SceneData,
)


@dataclass(slots=True)
class Parts:
    """What all views of a frame share, in the core's own form."""

    meshes: list[Any] = field(default_factory=list)  # core.Mesh, as SceneData.meshes
    world: native_world.NativeWorld = field(default_factory=native_world.NativeWorld)
    lamps: list[LampData] = field(default_factory=list)
    programs: Any = None  # native_programs.Programs
    warnings: list[str] = field(default_factory=list)
    builder: str = "LINEAR"  # of the trees that had to be built


def load(core: Any, data: SceneData, expected_rays: float, threads: int, cancel: Any) -> Parts:
    """The core's meshes with their trees, and its environment: those it knows, or new ones.

    Arrays of a mesh are dropped as soon as the core has its own. Raises what the core raises:
    ValueError and RuntimeError with a sentence, core.Cancelled.
    """
    image_key = native_world.key(core, data.world, threads)
    textures = native_texture.cache_keys(native_programs.images(data))
    cache.make_room({*(_key(mesh).geometry for mesh in data.meshes), image_key, *textures})
    primitives = sum(mesh.primitive_count for mesh in data.meshes)
    builder = core.choose_builder(primitives, expected_rays)
    parts = Parts(builder=builder)
    for index, mesh in enumerate(data.meshes):
        parts.meshes.append(_mesh(core, mesh, builder, threads, cancel))
        data.meshes[index] = None  # type: ignore[call-overload]
    parts.programs = native_programs.load(core, data, threads, parts.warnings, cancel)
    parts.lamps = native_lamps.load(data.lamps, parts.programs, parts.warnings)
    parts.world = native_world.load(core, data.world, image_key, parts.programs, threads, cancel)
    return parts


def warnings(parts: Parts) -> list[str]:
    """Sentences on what of them is rendered otherwise than it was meant."""
    said = []
    environment = parts.world.environment
    if environment is not None:
        for count, what in (
            (environment.nonfinite_texels, "are not finite"),
            (environment.negative_texels, "are negative"),
        ):
            if count:
                said.append(f"environment map: {count} pixels {what}, rendered as black")
    return [*said, *parts.warnings, *(s for mesh in parts.meshes for s in mesh.warnings)]


def build(
    core: Any, data: SceneData, parts: Parts, camera: CameraData | None, threads: int, cancel: Any,
    eye: Any = None,
) -> Any:  # fmt: skip
    """A committed core.Scene, seen by `camera` (None: whoever renders it says by which, and first
    by the core.Camera `eye`, if that is known); only the tree over instances is built here."""
    scene = core.Scene()
    indices = [scene.add_mesh(mesh) for mesh in parts.meshes]
    for group in data.instances:
        scene.add_instances(
            indices[group.mesh], group.matrices, group.object_index,
            mask=group.mask, flags=group.flags, material_slots=group.material_slots,
            name=group.name, motion=group.motion,
        )  # fmt: skip
    scene.set_tables(**tables(data), **native_surfaces.values(parts.programs, data))
    scene.set_surfaces(
        native_surfaces.surfaces(parts.programs, data.materials), _random(data.instances)
    )
    world = data.world
    if parts.world.environment is None:
        scene.set_world_color(parts.world.color)
    else:
        scene.set_world_environment(
            parts.world.environment,
            strength=world.strength, texture_from_world=world.texture_from_world,
        )  # fmt: skip
    if parts.world.camera is not None:
        scene.set_world_program(parts.world.camera, parts.world.max_radiance)
    for lamp in [*parts.lamps, *parts.world.suns]:
        scene.add_lamp(
            lamp.kind, lamp.radiance, lamp.matrix,
            name=lamp.name, casts_shadow=lamp.casts_shadow, lights_catchers=lamp.lights_catchers,
            spot_scales_by_cosine=lamp.spot_scales_by_cosine, **lamp.sizes,
        )  # fmt: skip
    if camera is not None:
        _set_camera(scene, camera)
    elif eye is not None:
        scene.set_eye(eye)
    scene.commit(threads=threads, cancel=cancel, keep_inputs=dump.is_wanted())
    return scene


def _set_camera(scene: Any, camera: CameraData) -> None:
    try:
        scene.set_camera(
            camera.kind, camera.matrix, camera.clip_start, camera.clip_end,
            camera.width, camera.height,
            lens=camera.lens, panorama=camera.panorama, stereo=camera.stereo,
            shutter=camera.shutter, motion=camera.motion,
        )  # fmt: skip
    except ValueError as error:
        raise ValueError(str(error).replace("camera:", f'camera "{camera.name}":', 1)) from error


def tables(data: SceneData) -> dict[str, Any]:
    """What passes tell of objects and materials, as the core's Scene.set_tables takes it."""
    materials, slots = data.materials.materials, data.materials.slots
    mattes = [(name_id(o.name), name_id(o.asset)) for o in data.objects]
    return {
        "object_pass_index": np.array([o.pass_index for o in data.objects], np.float32),
        "object_mattes": np.array(mattes, np.uint32).reshape(-1, 2).view(np.float32),
        "object_terminators": np.array(
            [(o.terminator_geometry_offset, o.terminator_shading_offset) for o in data.objects],
            np.float32,
        ).reshape(-1, 2),
        "material_pass_index": np.array([m.pass_index for m in materials], np.float32),
        "material_mattes": np.array([name_id(m.name) for m in materials], np.uint32).view(
            np.float32
        ),
        "slot_begin": np.cumsum([0, *map(len, slots)], dtype=np.uint32),
        "object_colors": np.array([o.color for o in data.objects], np.float32).reshape(-1, 4),
        "slots": np.array([m for indices in slots for m in indices], np.uint32),
    }


def _random(instances: list[InstanceData]) -> FloatArray | None:
    """The random numbers of all instances in their order; None if nobody asks."""
    if all(group.random is None for group in instances):
        return None
    numbers = [
        np.zeros(len(group.matrices), np.float32) if group.random is None else group.random
        for group in instances
    ]
    return np.concatenate(numbers)


def _key(mesh: AnyMesh) -> MeshKey:
    assert mesh.key is not None, f"{mesh.name} has no key"
    return mesh.key


def _mesh(core: Any, mesh: AnyMesh, builder: str, threads: int, cancel: Any) -> Any:
    """The core's mesh of a shape; its entry in the cache is brought up to date."""
    key = _key(mesh)
    known = cache.get(key.geometry, KnownMesh)
    if isinstance(mesh, CurveData | PointData):
        builder = "SAH"  # rays among hair cost so much that the better tree always pays
    better = builder == "SAH" and known.builder != "SAH"  # a better tree is wanted than is there
    if isinstance(mesh, KnownShape):
        known.mesh = mesh.mesh.rebuilt(builder, threads, cancel) if better else mesh.mesh
    else:
        if better:
            known.mesh, known.shading = None, b""
        if known.mesh is None or known.shading != key.shading:
            known.mesh = _native_mesh(core, mesh, builder, threads, cancel, known.mesh)
    known.shading = key.shading
    known.builder = builder if better else known.builder or builder
    return known.mesh


def _native_mesh(
    core: Any,
    mesh: MeshData | CurveData | PointData,
    builder: str,
    threads: int,
    cancel: Any,
    same_geometry: Any | None,
) -> Any:
    attributes = {name: (a.domain, a.values) for name, a in mesh.attributes.items()}
    if isinstance(mesh, CurveData):
        return core.Mesh.from_curves(
            mesh.name, mesh.positions, mesh.radii, mesh.curve_offsets, shape=mesh.shape,
            subdivisions=mesh.subdivisions, curve_materials=mesh.curve_materials,
            curve_uvs=mesh.curve_uvs, motion_positions=mesh.motion_positions,
            motion_radii=mesh.motion_radii, step_positions=mesh.step_positions,
            attributes=attributes, builder=builder, threads=threads, cancel=cancel,
        )  # fmt: skip
    if isinstance(mesh, PointData):
        return core.Mesh.from_points(
            mesh.name, mesh.positions, mesh.radii, motion_positions=mesh.motion_positions,
            motion_radii=mesh.motion_radii, step_positions=mesh.step_positions,
            attributes=attributes, builder=builder, threads=threads, cancel=cancel,
        )  # fmt: skip
    return core.Mesh(
        mesh.name, mesh.positions, mesh.corner_verts, mesh.face_offsets,
        tri2corner=mesh.tri2corner, tri2face=mesh.tri2face, corner_normals=mesh.corner_normals,
        vertex_normals=mesh.vertex_normals, smooth_faces=mesh.smooth_faces,
        face_materials=mesh.face_materials, corner_uvs=mesh.corner_uvs,
        motion_positions=mesh.motion_positions, motion_normals=mesh.motion_normals,
        step_positions=mesh.step_positions, attributes=attributes,
        builder=builder, threads=threads, cancel=cancel, same_geometry=same_geometry,
    )  # fmt: skip
