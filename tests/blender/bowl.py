"""A smooth ball, open where x and z are positive, so that its inside is seen as well."""

import math

import bmesh
import bpy
import mathutils
import numpy as np


def bowl(smooth=True):
    """The object, turned and stretched, before an orthographic camera that looks down."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    thing = bpy.context.object
    mesh = bmesh.new()
    mesh.from_mesh(thing.data)
    away = [f for f in mesh.faces if min(f.calc_center_median().x, f.calc_center_median().z) > 0.0]
    bmesh.ops.delete(mesh, geom=away, context="FACES")
    mesh.to_mesh(thing.data)
    mesh.free()
    thing.data.polygons.foreach_set("use_smooth", [smooth] * len(thing.data.polygons))
    thing.scale, thing.rotation_euler = (2.0, 0.9, 0.8), (0.3, 0.2, 0.5)
    thing.location = (0.1, 0.05, -0.2)
    thing.color, thing.pass_index = (0.2, 0.4, 0.6, 0.7), 3
    look_down(4.0)
    return thing


def look_down(width):
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", width
    camera.matrix_world = mathutils.Matrix.Translation((0.0, 0.0, 5.0)) @ (
        mathutils.Matrix.Rotation(math.radians(20.0), 4, "Z")
    )
    bpy.context.view_layer.update()


def steps(stage):
    """How far the point moves in the surface from a pixel to the right, and to the one above."""
    inputs, _ = stage.points()
    camera = np.array(stage.scene.camera.matrix_world, np.float32)
    pixel = stage.scene.camera.data.ortho_scale / stage.scene.render.resolution_x
    normal, view = inputs["true_normal"], -camera[:3, 2]
    result = []
    for axis in (0, 1):
        step = np.tile(camera[:3, axis] * pixel, (len(normal), 1))
        along = (step * normal).sum(1, keepdims=True) / (view * normal).sum(1, keepdims=True)
        result.append((step - along * view).astype(np.float32))
    return result
