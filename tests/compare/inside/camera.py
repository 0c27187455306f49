"""A camera for files that have none, or whose camera is not a camera."""

from __future__ import annotations

from typing import Any

import bpy
from mathutils import Matrix, Vector

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
