"""Meshes that modifiers, keys, bones and drivers deform, at a frame that is not the first."""

from __future__ import annotations

from collections.abc import Callable

import bpy
from common import add_box, add_camera, add_mesh, empty_scene, link, set_world
from features import ground
from strands import add_hair


def column(name: str, x: float, y: float) -> bpy.types.Object:
    """A square column of eight storeys, to be bent."""
    corners = [
        (a, b, 0.2 * level)
        for level in range(9) for a, b in ((-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2))
    ]  # fmt: skip
    faces = [
        (4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i)
        for k in range(8) for i in range(4)
    ]  # fmt: skip
    made = add_mesh(name, corners, [*faces, (32, 33, 34, 35)])
    made.location = (x, y, 0.0)
    return made


def bones(
    of: bpy.types.Object, turns: tuple[tuple[int, float], ...] = ((1, 0.0), (20, 1.2))
) -> bpy.types.Object:
    """An armature that turns the upper half of a column, by a curve over (frame, angle)."""
    rig = link(bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones")))
    rig.location = of.location
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("Upper")
    bone.head, bone.tail = (0.0, 0.0, 0.8), (0.0, 0.0, 1.6)
    bpy.ops.object.mode_set(mode="OBJECT")
    pose = rig.pose.bones["Upper"]
    pose.rotation_mode = "XYZ"
    for frame, angle in turns:
        pose.rotation_euler = (0.0, 0.0, angle)
        pose.keyframe_insert("rotation_euler", frame=frame)
    of.vertex_groups.new(name="Upper").add(list(range(16, 36)), 1.0, "REPLACE")
    of.modifiers.new("Armature", "ARMATURE").object = rig
    return rig


def deforming() -> None:
    """At frame 12: shape keys, one of them by a driver of the frame; bones; Skin with Subdivision;
    Multires and Subdivision that Simplify cuts to level 2, and hair with half of its children."""
    scene = empty_scene(320, 180)
    ground()
    column_of_keys = column("Keys", -2.2, 0.0)
    column_of_keys.shape_key_add(name="Basis")
    for name, way in (("Lean", (0.4, 0.0, 0.0)), ("Swell", (0.0, 0.0, 0.0))):
        key = column_of_keys.shape_key_add(name=name)
        for k, point in enumerate(key.data):
            high = (k // 4) / 8
            point.co.x += way[0] * high * high
            if name == "Swell":
                point.co.x *= 1.0 + 1.5 * high
                point.co.y *= 1.0 + 1.5 * high
    keys = column_of_keys.data.shape_keys.key_blocks
    for frame, value in ((1, 0.0), (20, 2.0)):
        keys["Lean"].value = min(1.0, value)
        keys["Lean"].keyframe_insert("value", frame=frame)
    driver = keys["Swell"].driver_add("value").driver
    variable = driver.variables.new()  # of the file's own data: no Python to be trusted
    variable.name, target = "frame", variable.targets[0]
    target.id_type, target.id, target.data_path = "SCENE", scene, "frame_current"
    driver.type, driver.expression = "SCRIPTED", "frame * 0.05"
    bones(column("Bent", -1.1, 0.2))

    edges = [(0, 1), (1, 2), (1, 3), (3, 4), (3, 5)]
    skin = add_mesh("Skin", [], [])
    joints = [(0, 0, 0), (0, 0, 0.5), (-0.4, 0, 0.9), (0.3, 0.1, 0.8), (0.3, -0.3, 1.2)]
    skin.data.from_pydata([*joints, (0.6, 0.2, 1.3)], edges, [])
    skin.location = (0.0, 0.1, 0.05)
    skin.modifiers.new("Skin", "SKIN")
    for vertex in skin.data.skin_vertices[0].data:
        vertex.radius = (0.12, 0.12)
    round_skin = skin.modifiers.new("Round", "SUBSURF")
    round_skin.levels, round_skin.render_levels = 0, 4

    sculpted = add_box("Multires", (0.8, 0.8, 0.8), (1.2, 0.2, 0.4))
    bpy.context.view_layer.objects.active = sculpted
    multires = sculpted.modifiers.new("Multires", "MULTIRES")
    for _ in range(3):
        bpy.ops.object.multires_subdivide(modifier=multires.name)
    multires.levels, multires.render_levels = 0, 3

    smooth = add_box("Subdivision", (0.8, 0.8, 0.8), (2.3, 0.2, 0.4))
    cut = smooth.modifiers.new("Subdivision", "SUBSURF")
    cut.levels, cut.render_levels = 0, 5
    fur = add_hair(smooth, "Fur", 40, 0.3)
    fur.child_type, fur.rendered_child_count = "INTERPOLATED", 20
    fur.root_radius, fur.tip_radius, fur.radius_scale = 1.0, 0.3, 0.03
    render = scene.render
    render.use_simplify = True
    render.simplify_subdivision, render.simplify_subdivision_render = 6, 2
    render.simplify_child_particles, render.simplify_child_particles_render = 0.0, 0.5
    scene.frame_end = 20
    scene.frame_set(12)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.65), lens=35.0)
    set_world()


SCENES: dict[str, Callable[[], None]] = {"deforming": deforming}
