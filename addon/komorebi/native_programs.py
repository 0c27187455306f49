"""ProgramData → the core's Program, with the textures that programs read. No bpy."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from . import native_texture
from .scene_data import ProgramData, SceneData, TextureImage


@dataclass(slots=True)
class Programs:
    """Makes the programs of one scene."""

    core: Any
    textures: dict[bytes, Any] = field(default_factory=dict)  # core.Texture by its image's key

    def program(self, data: ProgramData) -> Any:
        """The core's Program."""
        ops = [
            op if op.texture is None else replace(op, texture=self.textures[op.texture.key])
            for op in data.ops
        ]
        return self.core.Program(data.name, ops, list(data.outputs))


def load(
    core: Any, data: SceneData, threads: int, warnings: list[str], cancel: Any = None
) -> Programs:
    """With all textures of a scene in memory; `warnings` gets sentences on what is wrong. Raises
    core.Cancelled."""
    found = native_texture.load(
        core,
        images(data),
        data.texture_limit,
        threads,
        warnings.append,
        _averaged(data),
        cancel,
    )
    return Programs(core, found)


def images(data: SceneData) -> list[TextureImage]:
    """All pictures that a scene's programs look up."""
    found = {
        op.texture.key: op.texture
        for program in _programs(data) for op in program.ops if op.texture is not None
    }  # fmt: skip
    return list(found.values())


def _averaged(data: SceneData) -> set[bytes]:
    """The keys of those that are looked up with a footprint, the last operand."""
    return {
        op.texture.key
        for program in _programs(data) for op in program.ops
        if op.texture is not None and op.op in {"image", "image_box"}
        and isinstance(op.operands[-1], tuple)
    }  # fmt: skip


def _programs(data: SceneData) -> Iterator[ProgramData]:
    for program in (data.world.program, data.world.camera_program, data.world_values):
        if program is not None:
            yield program
    for lamp in data.lamps:
        if lamp.program is not None:
            yield lamp.program
    for material in data.materials.materials:
        yield from material.programs()
