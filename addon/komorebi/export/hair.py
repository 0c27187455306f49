"""Hair of particle systems → CurveData: what Blender evaluated for the frame, as Cycles has it."""

from __future__ import annotations

from array import array
from collections.abc import Collection
from typing import Any

import numpy as np

from .. import compat
from ..scene_data import Attribute, CurveData, FloatArray, IntArray
from .attributes import UV

NOT_SHOWN_IN = {"EDIT", "PARTICLE_EDIT"}  # modes of the emitter


def hair_systems(obj: Any) -> list[Any]:
    """The modifiers of an evaluated object whose particle systems render as hair strands."""
    if not len(obj.particle_systems) or obj.mode in NOT_SHOWN_IN:
        return []
    systems = []
    for modifier in obj.modifiers:
        if modifier.type != "PARTICLE_SYSTEM" or not modifier.show_render:
            continue
        settings = modifier.particle_system.settings
        if settings.type == "HAIR" and settings.render_type == "PATH":
            systems.append(modifier)
    return systems


def export_hair(
    obj: Any, name: str, scene: Any, uvs: bool, attributes: Collection[str] = (), stride: int = 1
) -> CurveData | None:
    """All strands of an emitter in its own space, or every `stride`-th of them, with `uvs` also its
    UVs where they grow, and of `attributes` those that are its UV maps; None when it has none."""
    parts, slots, roots = [], [], []
    maps = _uv_maps(obj.data, attributes)
    by_map: dict[str, list[FloatArray]] = {name: [] for name in maps}
    for modifier in hair_systems(obj):
        system = modifier.particle_system
        strands = _strands(system)[::stride]
        if not strands:
            continue
        parts.append(_export_system(obj, system, strands))
        slots.append(np.full(len(strands), max(system.settings.material - 1, 0), np.int32))
        if uvs and len(obj.data.uv_layers):
            roots.append(_uvs(modifier, strands, _render_layer(obj.data)))
        for name_of_map, layer in maps.items():
            by_map[name_of_map].append(_uvs(modifier, strands, layer))
    if not parts:
        return None
    materials = np.concatenate(slots)
    counts = np.concatenate([part[2] for part in parts])
    offsets = np.zeros(len(counts) + 1, np.int32)
    np.cumsum(counts, out=offsets[1:])
    shape, subdivisions = compat.curve_shape(scene)
    return CurveData(
        name=name,
        positions=np.concatenate([part[0] for part in parts]),
        radii=np.concatenate([part[1] for part in parts]),
        curve_offsets=offsets,
        shape=shape,
        subdivisions=subdivisions,
        curve_materials=materials if materials.any() else None,
        curve_uvs=np.concatenate(roots) if roots else None,
        attributes={n: Attribute("CURVE", np.concatenate(rows)) for n, rows in by_map.items()},
    )


def _render_layer(mesh: Any) -> int:
    return next((i for i, uv in enumerate(mesh.uv_layers) if uv.active_render), 0)


def _uv_maps(mesh: Any, names: Collection[str]) -> dict[str, int]:
    """Which of the names are UV maps, and their numbers."""
    by_name = ((UV + uv.name, i) for i, uv in enumerate(mesh.uv_layers))
    maps = {name: i for name, i in by_name if name in names}
    if UV in names and len(mesh.uv_layers):
        maps[UV] = _render_layer(mesh)
    return dict(sorted(maps.items()))


def _strands(system: Any) -> range:
    """Which particles are strands: where there are children, parents only lead them."""
    parents, children = len(system.particles), len(system.child_particles)
    first = parents if system.settings.child_type != "NONE" and children else 0
    return range(first, parents + children)


def _uvs(modifier: Any, strands: range, layer: int) -> FloatArray:
    """The emitter's UVs where each strand grows [strands, 2]."""
    system = modifier.particle_system
    particles, uv_on_emitter = system.particles, system.uv_on_emitter
    numbers = array("f")
    for strand in strands:
        # Of a child its number is enough.
        particle = particles[strand if strand < len(particles) else 0]
        numbers.extend(uv_on_emitter(modifier, particle=particle, particle_no=strand, uv_no=layer))
    return np.frombuffer(numbers, np.float32).reshape(-1, 2).copy()


def _export_system(
    obj: Any, system: Any, strands: range
) -> tuple[FloatArray, FloatArray, IntArray]:
    """Positions [keys, 3], radii [keys] and how many keys each strand has."""
    settings = system.settings
    keys = (1 << settings.render_step) + 1
    if settings.kink == "SPIRAL":
        keys += settings.kink_extra_steps
    world = _world_positions(obj, system, strands, keys)
    local = _to_local(world, obj.matrix_world)
    radii = _radii(local, settings)
    return (
        local.reshape(-1, 3),
        radii.reshape(-1),
        np.full(len(strands), keys, np.int32),
    )


def _world_positions(obj: Any, system: Any, strands: range, keys: int) -> FloatArray:
    """[strands, keys, 3]. A key that a strand has not got is the one before it."""
    co_hair = system.co_hair
    numbers = array("f")
    for strand in strands:
        for step in range(keys):
            numbers.extend(co_hair(object=obj, particle_no=strand, step=step)[:])
    world = np.frombuffer(numbers, np.float32).reshape(len(strands), keys, 3).copy()
    for step in range(1, keys):
        missing = ~world[:, step].any(axis=1)
        world[missing, step] = world[missing, step - 1]
    return world


def _to_local(world: FloatArray, matrix: Any) -> FloatArray:
    inverse = np.linalg.pinv(np.array(matrix, np.float64))
    local = world.astype(np.float64) @ inverse[:3, :3].T + inverse[:3, 3]
    return local.astype(np.float32)


def _radii(local: FloatArray, settings: Any) -> FloatArray:
    """[strands, keys]: from root to tip along the strand's length, bent by the setting Shape."""
    steps = np.linalg.norm(np.diff(local, axis=1), axis=2)
    along = np.zeros(local.shape[:2], np.float64)
    np.cumsum(steps, axis=1, out=along[:, 1:])
    length = along[:, -1:]
    time = np.divide(along, length, out=np.zeros_like(along), where=length > 0.0)
    share = np.clip(1.0 - time, 0.0, 1.0)
    shape = settings.shape
    # At −1 and 1 the power is 0 and infinite: all root, or a root alone.
    exponent = 1.0 + shape if shape < 0.0 else 1.0 / max(1.0 - shape, 1e-6)
    share **= exponent
    scale = 0.5 * settings.radius_scale
    root, tip = scale * settings.root_radius, scale * settings.tip_radius
    radii = share * (root - tip) + tip
    if settings.use_close_tip:
        radii[:, -1] = 0.0
    return radii.astype(np.float32)
