"""Things in motion, for the tests of motion blur."""

import bpy
import support


def moving_scene(frame=10, **blur):
    """The startup scene with its cube passing along x by a metre a frame."""
    scene = support.fresh_scene()
    scene.frame_start, scene.frame_end = 1, 20
    cube = bpy.data.objects["Cube"]
    animate(cube, "location", {0: (0.0, 0.0, 0.0), 20: (20.0, 0.0, 0.0)})
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    for name, value in blur.items():
        set_position(scene, value) if name == "position" else setattr(scene.render, name, value)
    scene.frame_set(frame)
    return scene, cube


def set_position(scene, value):
    holder = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    holder.motion_blur_position = value


def curves_of(owner):
    animation = owner.id_data.animation_data
    if not hasattr(animation, "action_slot"):  # up to 4.3
        return animation.action.fcurves
    strip = animation.action.layers[0].strips[0]
    return strip.channelbag(animation.action_slot).fcurves


def animate(owner, path, values):
    for frame, value in values.items():
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)
    for curve in curves_of(owner):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def moving(data):
    return [group for group in data.instances if group.motion is not None]


def xs(group):
    """The x of the first instance at each time."""
    return group.motion[0, :, 0, 3]


def has_cycles():
    return hasattr(bpy.context.scene, "cycles")


def lean(cube, frames, reach=1.0):
    """A shape key that moves the cube's first vertex along z."""
    cube.shape_key_add(name="Basis")
    key = cube.shape_key_add(name="Lean")
    key.data[0].co.z += reach
    for frame, value in frames.items():
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for curve in curves_of(key):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
