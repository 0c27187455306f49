"""Blender's world → what lights the scene and what is seen behind it.

A world that is one turned map is handed over as that (world_map.py). Everything else becomes a
program for rays that look for light, from which the core makes a map, and one for camera rays.
"""

from __future__ import annotations

from typing import Any

from .. import compat, reporting
from ..scene_data import ProgramData, SunData, WorldData
from . import nodes
from .names import name_of
from .shader import Compiler, Ray
from .shader.closures import total
from .shader.compiler import NOWHERE
from .shader.nodes_sky import SkySun
from .surroundings import Surroundings
from .world_map import read_map

BLACK = ProgramData("black", [], (0.0, 0.0, 0.0))


def export_world(engine: Any, world: Any | None, around: Surroundings = NOWHERE) -> WorldData:
    """What a ray that hits nothing sees; no world at all is black."""
    if world is None:
        return WorldData()
    seen, lights = compat.world_visibility(world)
    tree = compat.shader_nodes(world)
    if tree is None:
        color = tuple(float(c) for c in world.color[:3])
        data = WorldData(color=color)  # type: ignore[arg-type]
        return _hidden(data, ProgramData("world", [], color), seen, lights)
    return _WorldReader(engine, world, tree, around).read(seen, lights)


def _hidden(data: WorldData, camera: ProgramData | None, seen: bool, lights: bool) -> WorldData:
    """The world without what its ray visibility takes away."""
    if lights:
        data.camera_program = data.camera_program if seen else BLACK
        return data
    return WorldData(camera_program=camera if seen else None)


class _WorldReader:
    def __init__(self, engine: Any, world: Any, tree: Any, around: Surroundings) -> None:
        self._around = around
        self._engine = engine
        self._world = world
        self._owner = f'world "{name_of(world)}"'
        self._tree = tree

    def read(self, seen: bool, lights: bool) -> WorldData:
        output = nodes.world_output(self._tree)
        if output is None:
            return WorldData()
        volume = nodes.source(output.inputs["Volume"])
        if volume is not None:
            sentence = f'{self._owner}, node "{name_of(volume.node)}" ({volume.node.bl_label})'
            what = "volumes are not rendered yet, the air is clear"
            reporting.warn(self._engine, f"{sentence}: {what}")
        surface = output.inputs["Surface"]
        light, camera = (self._compiler(kind) for kind in ("DIFFUSE", "CAMERA"))
        data = read_map(light, surface)
        if data is None:
            program = self._program(light, surface)
            data = WorldData(program=program, program_size=light.map_size)
            shown = self._program(camera, surface) if light.heeds_ray else program
            data.camera_program = shown
            data.suns = [self._sun(i, sun, surface) for i, sun in enumerate(light.suns)]
            data.max_bounces = compat.max_bounces(self._world)
        elif light.heeds_ray and not _same_map(data, read_map(camera, surface)):
            data.camera_program = self._program(camera, surface)
        if not lights and seen and data.camera_program is None:
            data.camera_program = self._program(camera, surface)
        return _hidden(data, data.camera_program, seen, lights)

    def _sun(self, index: int, sun: SkySun, surface: Any) -> SunData:
        program = self._program(self._compiler("SUN", index), surface)
        return SunData(sun.direction, sun.radius, program)

    def _compiler(self, kind: str, sun: int = 0) -> Compiler:
        ray = Ray(kind, sun)
        return Compiler(self._engine, self._owner, ray, is_world=True, surroundings=self._around)

    @staticmethod
    def _program(compiler: Compiler, surface: Any) -> ProgramData:
        closures = compiler.closures(surface)
        outputs = total(compiler.builder, closures, "EMISSION")
        return ProgramData(compiler.owner, compiler.builder.ops, outputs)


def _same_map(a: WorldData, b: WorldData | None) -> bool:
    return (
        b is not None and a.image is not None and b.image is not None
        and a.image.name == b.image.name and a.strength == b.strength
        and (a.texture_from_world == b.texture_from_world).all()
    )  # fmt: skip
