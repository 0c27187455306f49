"""What a 3D viewport shows of its scene: local view and collections, scene lights and world."""

from __future__ import annotations

from typing import Any

import bpy

from ..export.instance import Shown
from ..export.mapping import euler_matrix
from ..export.walk import Subject
from ..scene_data import EnvironmentImage, WorldData


def shown_in(space: Any) -> Shown | None:
    """Which instances a viewport shows; None: all that its depsgraph has."""
    lamps = space.shading.use_scene_lights_render
    part = space.local_view is not None or space.use_local_collections
    if lamps and not part:
        return None

    def shown(instance: Any, subject: Subject) -> bool:
        if subject.kind == "LIGHT" and not lamps:
            return False
        if not part:
            return True
        who = instance.parent if instance.is_instance else instance.object
        return bool(who.visible_in_viewport_get(space))

    return shown


def background_of(space: Any) -> float | None:
    """How opaque the studio light is behind the scene; None: the film decides."""
    shading = space.shading
    if shading.use_scene_world_render or shading.studiolight_background_alpha == 1.0:
        return None
    return float(shading.studiolight_background_alpha)


def blur_of(space: Any) -> float:
    """How blurred the studio light is behind the scene, 0 to 1."""
    shading = space.shading
    if shading.use_scene_world_render or shading.studiolight_background_alpha == 0.0:
        return 0.0
    return float(shading.studiolight_background_blur)


def world_of(space: Any) -> WorldData | None:
    """The studio light that takes the scene's world's place; None: the scene's own."""
    shading = space.shading
    if shading.use_scene_world_render:
        return None
    # By name: what Blender calls the selected one may be that of Solid shading.
    lights = bpy.context.preferences.studio_lights
    light = next((x for x in lights if x.type == "WORLD" and x.name == shading.studio_light), None)
    if light is None:
        return None
    turn = euler_matrix((0.0, 0.0, shading.studiolight_rotate_z))
    image = EnvironmentImage(light.name, path=light.path)
    return WorldData(image=image, strength=shading.studiolight_intensity, texture_from_world=turn)
