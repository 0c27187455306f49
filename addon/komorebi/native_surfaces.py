"""SurfaceData → what the core's Scene.set_surfaces takes. No bpy."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np

from .native_programs import Programs
from .scene_data import Materials, SceneData, SurfaceData, SurfacePrograms


def surfaces(programs: Programs, materials: Materials) -> list[tuple[Any, Any, Any]]:
    """Of each material its surface to camera rays, to bounces and to light rays."""
    return [_surface(programs, m.surface) for m in materials.materials if m.surface is not None]


def _surface(programs: Programs, data: SurfaceData) -> tuple[Any, Any, Any]:
    return (
        _programs(programs, data.camera),
        None if data.bounce is None else _programs(programs, data.bounce),
        None if data.clear is None else programs.program(data.clear),
    )


def _programs(programs: Programs, data: SurfacePrograms) -> Any:
    lobes = [(lobe.transmits, lobe.has_normal) for lobe in data.lobes]
    return programs.core.SurfaceProgram(programs.program(data.program), lobes)


def values(programs: Programs, data: SceneData) -> dict[str, Any]:
    """What AOVs show, as the core's Scene.set_tables takes it: what is the same all over a material
    as a row of numbers, what is not as its program."""
    materials = data.materials.materials
    rows = np.zeros((len(materials), data.materials.value_count), np.float32)
    varying: list[Any] = [None] * len(materials)
    for i, material in enumerate(materials):
        program = None if material.values is None else programs.program(material.values)
        if program is None:
            continue
        if None in program.constants:
            varying[i] = program
        else:
            rows[i] = np.nan_to_num(program.constants, posinf=0.0, neginf=0.0)
    world = data.world_values
    return {
        "material_values": rows,
        "value_programs": varying if any(varying) else None,
        "world_values": None if world is None else programs.program(world),
    }


def simplified(materials: Materials) -> str:
    """What is rendered as something simpler by design, with how many materials it concerns."""
    notes = Counter(
        note for m in materials.materials if m.surface is not None for note in m.surface.notes
    )
    return ", ".join(
        f"{what} in {count} material{'' if count == 1 else 's'}" for what, count in notes.items()
    )
