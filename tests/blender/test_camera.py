"""The projection against Blender's own, over a table of cameras."""

import itertools
import math

import bpy
import mathutils
import numpy as np
import support
from bpy_extras.object_utils import world_to_camera_view
from komorebi.export import camera as export

PIXELS = 1e-2
POINTS = [(0, 0, -5), (1, 0.5, -3), (-0.7, 0.2, -8), (0.1, -0.9, -4), (2, 1, -20)]

FITS = ("AUTO", "HORIZONTAL", "VERTICAL")
SIZES = ((1920, 1080), (1080, 1920), (2048, 2048), (333, 777))
SHIFTS = ((0, 0), (0.15, 0.12), (-0.3, 0.7))
ASPECTS = ((1, 1), (2, 1), (1, 1.5))


def cameras():
    for kind, fit, size, shift, aspect in itertools.product(
        ("PERSP", "ORTHO"), FITS, SIZES, SHIFTS, ASPECTS
    ):
        scene = bpy.context.scene
        camera = scene.camera
        data = camera.data
        data.type, data.sensor_fit = kind, fit
        data.lens, data.ortho_scale, data.sensor_width, data.sensor_height = 35, 6.5, 36, 22
        data.shift_x, data.shift_y = shift
        data.clip_start, data.clip_end = 0.1, 250
        render = scene.render
        render.resolution_x, render.resolution_y = size
        render.pixel_aspect_x, render.pixel_aspect_y = aspect
        yield scene, camera


def ours(scene, camera):
    render = scene.render
    return export.projection(
        export.read_lens(camera), render.resolution_x, render.resolution_y,
        render.pixel_aspect_x, render.pixel_aspect_y,
    )  # fmt: skip


def to_pixels(clip_from_world, point, size):
    clip = clip_from_world @ np.array([*point, 1.0])
    return (clip[:2] / clip[3] * 0.5 + 0.5) * np.array(size)


def test_equals_calc_matrix_camera():
    count = 0
    for scene, camera in cameras():
        depsgraph = bpy.context.evaluated_depsgraph_get()  # with the camera as it is now
        render = scene.render
        size = (render.resolution_x, render.resolution_y)
        blender = np.array(camera.calc_matrix_camera(
            depsgraph, x=size[0], y=size[1],
            scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y,
        ))  # fmt: skip
        mine = ours(scene, camera)
        for point in POINTS:
            a, b = to_pixels(mine, point, size), to_pixels(blender, point, size)
            assert np.abs(a - b).max() < PIXELS, (camera.data.type, size, a, b)
        assert np.allclose(mine, blender, rtol=2e-5, atol=2e-5)
        count += 1
    assert count == 216


def test_equals_world_to_camera_view():
    bpy.context.scene.camera.rotation_euler = (1.1, 0.2, 0.7)
    bpy.context.scene.camera.scale = (2.0, 0.5, 3.0)  # a camera's scale counts for nothing
    for scene, camera in cameras():
        render = scene.render
        if (render.pixel_aspect_x, render.pixel_aspect_y) != (1, 1) and camera.data.type == "ORTHO":
            continue  # world_to_camera_view leaves the aspect out there
        bpy.context.view_layer.update()
        view = export.camera_from_world(np.array(camera.matrix_world))
        size = (render.resolution_x, render.resolution_y)
        world_from_camera = mathutils.Matrix(np.linalg.inv(view))
        for point in POINTS:
            world = world_from_camera @ mathutils.Vector(point)
            expected = world_to_camera_view(scene, camera, world)
            expected = np.array(expected[:2]) * np.array(size)
            actual = to_pixels(ours(scene, camera) @ view, world, size)
            # world_to_camera_view is in single precision, half of the tolerance is its own.
            assert np.abs(actual - expected).max() < PIXELS * max(1, max(size) / 1024), (
                camera.data.type, camera.data.sensor_fit, size, actual, expected)  # fmt: skip


def test_equals_a_pinhole_in_doubles():
    """By hand: x = f X / Z on the sensor, for the camera that everybody knows."""
    scene = bpy.context.scene
    camera = scene.camera
    camera.data.lens, camera.data.sensor_width = 50, 36
    scene.render.resolution_x, scene.render.resolution_y = 2000, 1000
    for x, y, z in POINTS:
        pixel = 2000 / 36  # pixels a mm
        expected = (1000 + 50 * x / -z * pixel, 500 + 50 * y / -z * pixel)
        actual = to_pixels(ours(scene, camera), (x, y, z), (2000, 1000))
        assert math.dist(actual, expected) < 1e-3, (actual, expected)


def test_view_matrix_undoes_the_pose_in_doubles():
    pose = mathutils.Euler((0.3, -0.4, 2.0)).to_matrix().to_4x4()
    pose.translation = (1e5, -3e4, 12)
    view = export.camera_from_world(np.array(pose))
    assert np.abs(view @ np.array(pose) - np.eye(4)).max() < 1e-5
    assert view.dtype == np.float64


def test_marker_switches_the_camera(folder):
    scene = bpy.context.scene
    other = support.add_object("Other", bpy.data.cameras.new("Other"), (0, 0, 40))
    marker = scene.timeline_markers.new("cut", frame=5)
    marker.camera = other
    scene.frame_set(1)
    scene.camera = bpy.data.objects["Camera"]
    scene.frame_set(5)
    data = support.exported()
    center = data.camera.matrix @ np.array([0, 0, 0, 1.0])
    assert abs(center[3] - 40) < 1e-3, "the marker's camera looks straight down from 40 m"
