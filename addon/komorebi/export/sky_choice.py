"""What lights a scene: its own world, one of Blender's studio lights, or white, as `sky` says."""

from __future__ import annotations

import os
from typing import Any

import bpy

from ..errors import RenderError
from ..scene_data import EnvironmentImage, WorldData
from ..scene_settings import settings_of
from .mapping import euler_matrix
from .surroundings import surroundings_of
from .world import export_world


def export_sky(engine: Any, scene: Any, view_layer: Any) -> WorldData:
    """RenderError when a studio light or the world's picture is not there."""
    settings = settings_of(scene)
    if not view_layer.use_sky:  # no sky at all, neither seen nor as a light
        return WorldData()
    if settings.sky == "WHITE":
        return WorldData(color=(settings.sky_strength,) * 3)
    if settings.sky == "STUDIO":
        # The map turns with the sky: a direction is looked up where it was before.
        turn = euler_matrix((0.0, 0.0, -settings.sky_rotation))
        image = EnvironmentImage(settings.sky_studio_light, path=_path(settings.sky_studio_light))
        return WorldData(image=image, strength=settings.sky_strength, texture_from_world=turn)
    world = export_world(engine, scene.world, surroundings_of(scene))
    world.resolution = settings.world_resolution
    return world


def studio_lights() -> dict[str, str]:
    """The HDR studio lights that there are, file by name: Blender's own, then the user's."""
    found: dict[str, str] = {}
    for folder in (
        bpy.utils.system_resource(  # type: ignore[attr-defined]
            "DATAFILES", path=os.path.join("studiolights", "world")
        ),
        bpy.utils.user_resource("DATAFILES", path=os.path.join("studiolights", "world")),
    ):
        if folder and os.path.isdir(folder):
            names = (n for n in sorted(os.listdir(folder)) if n.endswith((".exr", ".hdr")))
            found |= {name: os.path.join(folder, name) for name in names}
    return found


def _path(name: str) -> str:
    known = studio_lights()
    if name not in known:
        said = ", ".join(known) or "none"
        raise RenderError(f'There is no studio light "{name}": there are {said}')
    return known[name]
