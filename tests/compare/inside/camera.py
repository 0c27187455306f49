"""The camera: one for files that have none, and what neither engine may take differently."""

from __future__ import annotations

from typing import Any

import bpy
from mathutils import Matrix, Vector

from compare.inside.settle import require, settle

BACK = Vector((0.62, -0.68, 0.39)).normalized()


def visible_bounds(depsgraph: Any) -> tuple[Vector, Vector]:
    """Corners of the box around all that renders, in world space; a unit box when nothing does."""
    low, high = Vector((float("inf"),) * 3), Vector((float("-inf"),) * 3)
    for instance in depsgraph.object_instances:
        if not instance.show_self or instance.object.type not in {
            "MESH",
            "CURVE",
            "SURFACE",
            "FONT",
            "META",
        }:
            continue
        matrix = instance.matrix_world.copy()
        for corner in instance.object.bound_box:
            point = matrix @ Vector(corner)
            low = Vector([min(a, b) for a, b in zip(low, point, strict=False)])
            high = Vector([max(a, b) for a, b in zip(high, point, strict=False)])
    if low.x > high.x:
        return Vector((-0.5, -0.5, -0.5)), Vector((0.5, 0.5, 0.5))
    return low, high


def ensure_camera(scene: Any, depsgraph: Any) -> list[str]:
    """Give `scene` a perspective camera that frames everything, unless it has one; returns the
    note about it."""
    if scene.camera is not None and scene.camera.type == "CAMERA":
        return []
    low, high = visible_bounds(depsgraph)
    centre, radius = (low + high) / 2, max((high - low).length / 2, 1e-3)
    data = bpy.data.cameras.new("compare camera")
    distance = 2.6 * radius
    data.lens, data.clip_start, data.clip_end = 40.0, distance * 1e-3, distance * 10.0
    camera = bpy.data.objects.new("compare camera", data)
    right = Vector((0.0, 0.0, 1.0)).cross(BACK).normalized()
    axes = Matrix((right, BACK.cross(right), BACK)).transposed().to_4x4()
    camera.matrix_world = Matrix.Translation(centre + BACK * distance) @ axes
    scene.collection.objects.link(camera)
    scene.camera = camera
    return ["no camera in the file: one that frames everything added"]


def look_through(scene: Any, name: str) -> None:
    """Make the object `name` the scene's camera, whatever markers say. Raises KeyError when there
    is none."""
    if name not in scene.objects or scene.objects[name].type != "CAMERA":
        raise KeyError(f"the scene has no camera {name!r}")
    for marker in scene.timeline_markers:
        marker.camera = None
    settle(scene, "camera", scene.objects[name])


def both_eyes(scene: Any, spherical: bool) -> None:
    """Stereo 3D, the eyes side by side in one picture."""
    require(scene.render, use_multiview=True, views_format="STEREO_3D")
    for view in scene.render.views:
        view.use = True
    require(scene.render.image_settings, views_format="STEREO_3D")
    require(
        scene.render.image_settings.stereo_3d_format,
        display_mode="SIDEBYSIDE",
        use_squeezed_frame=False,
        use_sidebyside_crosseyed=False,
    )
    require(scene.camera.data.stereo, use_spherical_stereo=spherical)


def supported_camera(camera: Any) -> list[str]:
    """Lens and panorama stay as they are; a camera of a kind that Komorebi lacks becomes
    perspective."""
    data = camera.data
    notes = []
    if data.type not in {"PERSP", "ORTHO", "PANO"}:
        notes.append(f"camera of type {data.type} made perspective")
        settle(data, "type", "PERSP")
    return notes
