"""What moves while the shutter is open."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy
from common import add_box, add_camera, add_mesh, add_sphere, empty_scene, link, set_world
from deforming import bones, column
from features import ground
from instancing import wedge
from mathutils import Matrix, Vector
from strands import add_hair, chain, node_tree

FRAME = 10


def key(holder: Any, path: str, values: dict[float, Any], index: int = -1) -> None:
    """Keyframes of `path` at frames, straight lines in between."""
    for frame, value in values.items():
        if index < 0:
            setattr(holder, path, value)
        else:
            getattr(holder, path)[index] = value
        holder.keyframe_insert(path, index=index, frame=frame)
    owner = holder.id_data
    for curve in owner.animation_data.action.fcurves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def moving_scene(shutter: float = 1.0, position: str = "CENTER") -> bpy.types.Scene:
    scene = empty_scene(320, 180)
    scene.frame_start, scene.frame_end = 1, 20
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, shutter
    scene.cycles.motion_blur_position = position
    return scene


def propeller(name: str, place: tuple[float, float, float]) -> bpy.types.Object:
    """Three blades about the y axis."""
    vertices, faces = [], []
    for blade in range(3):
        turn = 2.0 * math.pi * blade / 3.0
        along = Vector((math.cos(turn), 0.0, math.sin(turn)))
        across = Vector((-math.sin(turn), 0.0, math.cos(turn)))
        first = len(vertices)
        for reach, half, lean in ((0.08, 0.05, 0.0), (0.75, 0.12, 0.06)):
            vertices += [along * reach - across * half + Vector((0, lean, 0)),
                         along * reach + across * half - Vector((0, lean, 0))]  # fmt: skip
        faces.append((first, first + 1, first + 3, first + 2))
    made = add_mesh(name, vertices, faces)
    made.location = place
    return made


def motion_objects() -> None:
    """Objects that pass, turn by 150° with many steps and with few, grow, one without blur, a
    mirrored one; copies of a collection that turn with their instancer; the shutter opens
    slowly."""
    scene = moving_scene()
    ground()
    passing = add_box("Passing", (0.5, 0.4, 0.5), (-2.4, 0.5, 0.25))
    key(passing, "location", {1: (-2.4 - 3.6, 0.5, 0.25), 19: (-2.4 + 3.6, 0.5, 0.25)})
    for name, x, steps in (("Fast", -1.1, 4), ("Coarse", 0.6, 1)):
        fan = propeller(name, (x, 0.4, 0.9))
        fan.cycles.motion_steps = steps
        angle = math.radians(150.0)
        key(fan, "rotation_euler", {FRAME - 1: -angle, FRAME + 1: angle}, 1)
    growing = add_sphere("Growing", 0.3, (1.9, 0.6, 0.4), level=4)
    key(growing, "scale", {1: (0.1, 0.4, 1.0), 19: (2.0, 1.6, 1.0)})
    mirrored = wedge("Mirrored", 0.4)
    mirrored.scale = (-1.0, 1.0, 1.4)
    key(mirrored, "location", {1: (-0.6, -0.6, -0.9), 19: (-0.6, -0.6, 1.1)})
    key(mirrored, "rotation_euler", {1: 0.0, 19: 6.0}, 2)
    sharp = add_box("Without blur", (0.3, 0.3, 0.3), (0.4, -1.0, 0.15))
    sharp.cycles.use_motion_blur = False
    key(sharp, "location", {1: (-4.0, -1.0, 0.15), 19: (4.0, -1.0, 0.15)})

    collection = bpy.data.collections.new("Parts")
    for x in (-0.3, 0.3):
        part = link(bpy.data.objects.new(f"Part {x}", wedge("Wedge", 0.2).data), collection)
        part.location = (x, 0.0, 0.0)
    bpy.data.objects.remove(bpy.data.objects["Wedge"])
    bpy.data.objects.remove(bpy.data.objects["Wedge.001"])
    swing = link(bpy.data.objects.new("Swing", None))
    swing.instance_type, swing.instance_collection = "COLLECTION", collection
    swing.cycles.motion_steps = 3
    swing.location = (1.6, -0.7, 0.5)
    key(swing, "rotation_euler", {FRAME - 1: -1.5, FRAME + 1: 1.5}, 2)

    curve = scene.render.motion_blur_shutter_curve
    curve.curves[0].points[0].location = (0.0, 0.0)
    curve.update()
    scene.frame_set(FRAME)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    set_world()


def bent_column(name: str, x: float, y: float) -> bpy.types.Object:
    """A column of which a bone turns the upper half about its axis."""
    bent = column(name, x, y)
    bones(bent, ((FRAME - 1, -1.2), (FRAME + 2, 2.4)))
    return bent


def motion_deforming() -> None:
    """A mesh that shape keys bend in nine steps while it passes, one that bones bend (smooth), one
    whose deformation is switched off, one with velocities, one whose faces change in number; the
    shutter opens on the frame."""
    scene = moving_scene(shutter=0.8, position="START")
    ground()
    leaning = column("Leaning", -1.6, 0.2)
    leaning.shape_key_add(name="Basis")
    lean = leaning.shape_key_add(name="Lean")
    for k, point in enumerate(lean.data):
        point.co.x += 1.4 * ((k // 4) / 8) ** 2
    leaning.cycles.motion_steps = 3
    for frame, value in ((FRAME - 1, 0.0), (FRAME, 0.9), (FRAME + 1, 0.2)):
        lean.value = value
        lean.keyframe_insert("value", frame=frame)
    key(leaning, "location", {FRAME - 1: (-2.2, 0.2, 0.0), FRAME + 1: (-1.4, 0.2, 0.0)})

    bent = bent_column("Bent", -0.1, 0.3)
    bent.data.polygons.foreach_set("use_smooth", [True] * len(bent.data.polygons))

    stiff = column("Stiff", 0.9, 0.6)
    stiff.cycles.use_deform_motion = False
    stiff.shape_key_add(name="Basis")
    swell = stiff.shape_key_add(name="Swell")
    for point in swell.data:
        point.co.x *= 3.0
    for frame, value in ((FRAME, 0.0), (FRAME + 1, 1.0)):
        swell.value = value
        swell.keyframe_insert("value", frame=frame)

    flying = add_box("Velocity", (0.4, 0.4, 0.4), (1.9, 0.2, 0.5))
    velocity = flying.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
    per_frame = Vector((0.5, 0.0, 0.5)) * scene.render.fps
    for k, entry in enumerate(velocity.data):
        entry.vector = per_frame * (1.0 if k & 1 else 0.2)

    fewer = add_mesh("Fewer faces", [(x, 0, z) for z in (0, 0.5) for x in (0, 0.5)],
                     [(0, 1, 3, 2)])  # fmt: skip
    fewer.location = (-0.3, -1.2, 0.0)
    count = fewer.modifiers.new("Array", "ARRAY")
    count.relative_offset_displace = (0.0, 0.0, 1.2)
    fewer.modifiers.new("Wave", "SIMPLE_DEFORM").angle = 0.4
    for frame, copies in ((FRAME, 1), (FRAME + 1, 3)):
        count.count = copies
        count.keyframe_insert("count", frame=frame)
    scene.frame_set(FRAME)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    set_world()


def motion_strands() -> None:
    """Hair with children on a mesh that bones bend, in five steps; hair on one that a shape key
    bends, hair that passes as it is, and hair of which the deformation is switched off; hair curves
    that nodes bend; a point cloud with velocities."""
    scene = moving_scene(shutter=0.8)
    ground()
    bent = bent_column("Bent", -1.9, 0.3)
    bent.cycles.motion_steps = 2
    long = add_hair(bent, "Long", 60, 0.4)
    long.child_type, long.rendered_child_count = "INTERPOLATED", 6
    long.radius_scale, long.tip_radius = 0.03, 0.3

    def swelling(name: str, x: float) -> bpy.types.Object:
        ball = add_sphere(name, 0.25, (x, 0.3, 0.5), level=3)
        ball.shape_key_add(name="Basis")
        swell = ball.shape_key_add(name="Swell")
        for point in swell.data:
            point.co.x += 0.7 * point.co.z + 0.2
            point.co.z *= 1.5
        for frame, value in ((FRAME - 1, 0.0), (FRAME + 1, 1.0)):
            swell.value = value
            swell.keyframe_insert("value", frame=frame)
        fur = add_hair(ball, "Fur", 250, 0.2)
        fur.radius_scale, fur.tip_radius = 0.02, 0.5
        return ball

    swelling("Swelling", -0.9)
    swelling("Stiff", 0.1).cycles.use_deform_motion = False
    passing = add_sphere("Passing", 0.2, (0.0, -1.2, 0.2), level=3)
    key(passing, "location", {FRAME - 1: (-0.5, -1.2, 0.2), FRAME + 1: (0.1, -1.2, 0.2)})
    add_hair(passing, "Whole", 150, 0.15).radius_scale = 0.02

    bpy.ops.object.curves_random_add()
    wild = bpy.context.object
    wild.name, wild.matrix_world = (
        "Wild",
        Matrix.Translation((1.2, 0.4, 0.5)) @ Matrix.Scale(0.5, 4),
    )
    tree = node_tree(wild)
    bend, radius = chain(tree, "GeometryNodeSetPosition", "GeometryNodeSetCurveRadius")
    radius.inputs["Radius"].default_value = 0.012
    place, apart = (
        tree.nodes.new("GeometryNodeInputPosition"),
        tree.nodes.new("ShaderNodeSeparateXYZ"),
    )
    times, offset = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeCombineXYZ")
    times.operation = "MULTIPLY"
    for output, to in (
        (place.outputs[0], apart.inputs[0]), (apart.outputs["Z"], times.inputs[0]),
        (times.outputs[0], offset.inputs["X"]), (offset.outputs[0], bend.inputs["Offset"]),
    ):  # fmt: skip
        tree.links.new(output, to)
    key(times.inputs[1], "default_value", {FRAME - 1: -1.0, FRAME + 1: 1.0})

    cloud = add_sphere("Cloud", 0.4, (2.2, 0.2, 0.8), level=3)
    tree = node_tree(cloud)
    spread, radius, store = chain(
        tree, "GeometryNodeDistributePointsOnFaces", "GeometryNodeSetPointRadius",
        "GeometryNodeStoreNamedAttribute",
    )  # fmt: skip
    spread.inputs["Density"].default_value = 60.0
    radius.inputs["Radius"].default_value = 0.03
    store.data_type, store.domain = "FLOAT_VECTOR", "POINT"
    store.inputs["Name"].default_value = "velocity"
    place, fast = (
        tree.nodes.new("GeometryNodeInputPosition"),
        tree.nodes.new("ShaderNodeVectorMath"),
    )
    fast.operation = "SCALE"
    fast.inputs["Scale"].default_value = 0.8 * scene.render.fps
    tree.links.new(place.outputs[0], fast.inputs[0])
    tree.links.new(
        fast.outputs[0], next(i for i in store.inputs if i.name == "Value" and i.enabled)
    )
    scene.frame_set(FRAME)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    set_world()
    scene.cycles_curves.shape = "RIBBONS"


def motion_particles() -> None:
    """Particles in flight, some born and some dead within the shutter's time, and instances that
    geometry nodes move; the shutter closes on the frame."""
    scene = moving_scene(shutter=1.5, position="END")
    ground()
    emitter = add_box("Emitter", (0.6, 0.6, 0.1), (-1.4, 0.2, 0.1))
    pebble = wedge("Pebble", 0.25)
    pebble.hide_render = False
    pebble.location = (0.0, 6.0, -5.0)
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end = 60, 1.0, 14.0
    settings.lifetime, settings.lifetime_random = 6.0, 0.5
    settings.normal_factor, settings.factor_random = 4.0, 1.5
    settings.use_rotations, settings.angular_velocity_mode = True, "RAND"
    settings.angular_velocity_factor = 8.0
    settings.render_type, settings.instance_object = "OBJECT", pebble
    settings.particle_size, settings.size_random = 0.6, 0.4
    settings.use_dynamic_rotation = True

    swarm = add_mesh("Swarm", [(0.25 * x, 0.3 * y, 0.0) for x in range(7) for y in range(3)], [])
    swarm.location = (0.4, 0.0, 0.3)
    tree = node_tree(swarm)
    points, turn = chain(tree, "GeometryNodeInstanceOnPoints", "GeometryNodeRotateInstances")
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = wedge("Insect", 0.15)
    bpy.data.objects["Insect"].location = (0.0, 6.0, -5.0)
    info.inputs["As Instance"].default_value = True
    tree.links.new(info.outputs["Geometry"], points.inputs["Instance"])
    value = tree.nodes.new("ShaderNodeCombineXYZ")
    tree.links.new(value.outputs["Vector"], turn.inputs["Rotation"])
    angle = value.inputs["Z"]
    for frame, number in ((FRAME - 2, 0.0), (FRAME, 2.0)):
        angle.default_value = number
        angle.keyframe_insert("default_value", frame=frame)
    scene.frame_set(FRAME)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    set_world()
    bpy.ops.ptcache.bake_all(bake=True)  # into the file: physics goes from frame to frame


def motion_camera() -> None:
    """Cameras that pass and zoom (`Camera`), turn (`Orthographic`), and do both (`Panorama`)."""
    scene = moving_scene(shutter=0.6)
    ground()
    for k in range(5):
        add_box(f"Box {k}", (0.4, 0.4, 0.3 + 0.25 * k), (0.9 * (k - 2), 0.3 * k, 0.15 + 0.125 * k))
    add_sphere("Ball", 0.35, (0.3, -0.7, 0.35), level=4)
    straight = add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    key(straight, "location", {FRAME - 1: (-0.4, -5.6, 2.2), FRAME + 1: (0.6, -5.6, 2.2)})
    key(straight.data, "lens", {FRAME - 1: 28.0, FRAME + 1: 46.0})
    straight.cycles.motion_steps = 2

    flat = add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), ortho_scale=5.0)
    flat.name = "Orthographic"
    heading = flat.rotation_euler.z
    key(flat, "rotation_euler", {FRAME - 1: heading - 0.2, FRAME + 1: heading + 0.4}, 2)
    round_about = add_camera((0.2, -2.2, 1.1), (0.05, 0.2, 0.6))
    round_about.name = "Panorama"
    round_about.data.type, round_about.data.cycles.panorama_type = "PANO", "EQUIRECTANGULAR"
    round_about.cycles.motion_steps = 3
    key(round_about, "location", {FRAME - 1: (-0.2, -2.2, 1.1), FRAME + 1: (0.6, -2.4, 1.4)})
    heading = round_about.rotation_euler.z
    key(round_about, "rotation_euler", {FRAME - 1: heading - 0.3, FRAME + 1: heading + 0.3}, 2)
    scene.camera = straight
    scene.frame_set(FRAME)
    set_world()


def motion_rolling() -> None:
    """A rolling shutter: what passes leans, what turns bends."""
    scene = moving_scene(shutter=1.0)
    scene.cycles.rolling_shutter_type, scene.cycles.rolling_shutter_duration = "TOP", 0.1
    ground()
    post = add_box("Post", (0.3, 0.3, 1.6), (-1.0, 0.2, 0.8))
    key(post, "location", {FRAME - 1: (-2.0, 0.2, 0.8), FRAME + 1: (0.0, 0.2, 0.8)})
    fan = propeller("Fan", (1.1, 0.0, 0.9))
    fan.cycles.motion_steps = 5
    key(fan, "rotation_euler", {FRAME - 1: -3.0, FRAME + 1: 3.0}, 1)
    scene.frame_set(FRAME)
    add_camera((0.1, -5.6, 2.2), (0.05, 0.2, 0.6), lens=35.0)
    set_world()


SCENES: dict[str, Callable[[], None]] = {
    f.__name__: f
    for f in (
        motion_objects, motion_deforming, motion_strands, motion_particles, motion_camera,
        motion_rolling,
    )
}  # fmt: skip
