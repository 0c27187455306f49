"""SurfaceData → what the core's Scene.set_surfaces takes. No bpy."""

from __future__ import annotations

from collections import Counter
from typing import Any

from .native_world import program
from .scene_data import Materials, SurfaceData, SurfacePrograms


def surfaces(core: Any, materials: Materials) -> list[tuple[Any, Any, Any]]:
    """Of each material its surface to camera rays, to bounces and to light rays."""
    return [_surface(core, m.surface) for m in materials.materials if m.surface is not None]


def _surface(core: Any, data: SurfaceData) -> tuple[Any, Any, Any]:
    return (
        _programs(core, data.camera),
        None if data.bounce is None else _programs(core, data.bounce),
        None if data.shadow is None else program(core, data.shadow),
    )


def _programs(core: Any, data: SurfacePrograms) -> Any:
    lobes = [(lobe.transmits, lobe.has_normal) for lobe in data.lobes]
    return core.SurfaceProgram(program(core, data.program), lobes)


def simplified(materials: Materials) -> str:
    """What is rendered as something simpler by design, with how many materials it concerns."""
    notes = Counter(
        note for m in materials.materials if m.surface is not None for note in m.surface.notes
    )
    return ", ".join(
        f"{what} in {count} material{'' if count == 1 else 's'}" for what, count in notes.items()
    )
