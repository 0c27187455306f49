"""The pass Vector beside Cycles' of the same scene: camera, objects, instances, deforming meshes."""

import bpy
import numpy as np
import support
from beside_cycles import inside, render_both, stacked

IS_OLD = bpy.app.version < (4, 0, 0)


def key(owner, path, values):
    for frame, value in enumerate(values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def scene_of(prepare):
    """A camera that moves and turns before a turning cube, its instance, and a ball that keys bend."""
    scene = support.fresh_scene(size=(96, 64), samples=16)
    camera, cube = scene.camera, scene.objects["Cube"]
    key(cube, "location", ((0, 0, 0), (0.5, 0, 0.2), (0.7, 0.4, 0.4)))
    key(cube, "rotation_euler", ((0, 0, 0), (0.2, 0, 0.3), (0.2, 0.5, 0.8)))
    bpy.ops.mesh.primitive_uv_sphere_add(location=(-1, 2, 0.5))
    ball = bpy.context.object
    ball.shape_key_add(name="Basis")
    bend = ball.shape_key_add(name="Bend")
    for point in bend.data:
        point.co.z *= 2
        point.co.x += 0.5
    key(bend, "value", (0.0, 0.3, 1.0))
    stock = bpy.data.collections.new("Stock")
    inner = bpy.data.objects.new("Inner", cube.data)
    inner.scale = (0.4, 0.4, 0.4)
    stock.objects.link(inner)
    empty = support.add_object("Empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", stock
    key(empty, "location", ((2, -2, 0), (2.2, -2, 0.4), (2.4, -2.3, 0.6)))
    bpy.ops.mesh.primitive_plane_add(size=12, location=(0, 0, -1))
    x, y, z = camera.location
    key(camera, "location", ((x + 0.3, y, z), (x, y, z), (x, y + 0.4, z + 0.1)))
    x, y, z = camera.rotation_euler
    key(camera, "rotation_euler", ((x + 0.03, y, z), (x, y, z), (x, y, z - 0.05)))
    prepare(scene)
    scene.frame_set(1)
    layer = bpy.context.view_layer
    layer.use_pass_vector = layer.use_pass_z = layer.use_pass_cryptomatte_object = True
    return scene


def compared(folder, prepare):
    ours, theirs, _, _ = render_both(scene_of(prepare), folder, filter_width=0.01)
    whole = inside(ours) & inside(theirs)
    mine, other = (stacked(layers, "Vector", "XYZW") for layers in (ours, theirs))
    assert whole.mean() > 0.03 and np.abs(other[whole]).max() > 0.5
    difference = np.abs(mine - other)[whole]
    assert np.median(difference) < 1e-3 and np.percentile(difference, 98) < 0.02, (
        np.median(difference), np.percentile(difference, 98)
    )  # fmt: skip
    assert np.median(np.abs(mine[whole])) > 0.05
    assert not mine[ours["CryptoObject00.g"] == 0.0].any(), "the sky does not move"


def panorama(kind):
    def prepare(scene):
        camera = scene.camera.data
        camera.type = "PANO"
        holder = camera if hasattr(camera, "panorama_type") else camera.cycles
        holder.panorama_type = kind

    return prepare


def test_perspective(folder):
    compared(folder, lambda scene: None)


def test_shift_and_oblong_pixels(folder):
    def prepare(scene):
        scene.camera.data.shift_x, scene.render.pixel_aspect_x = 0.1, 1.5

    compared(folder, prepare)


def test_zoom(folder):
    if IS_OLD:
        raise support.Skip("Cycles of 3.4 forgets the zoom")
    compared(folder, lambda scene: key(scene.camera.data, "lens", (40.0, 50.0, 65.0)))


def test_orthographic(folder):
    if not IS_OLD:
        raise support.Skip("Cycles of later releases takes a perspective matrix where it moves")

    def prepare(scene):
        scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 9.0

    compared(folder, prepare)


def test_panoramas(folder):
    for kind in ("EQUIRECTANGULAR", "MIRRORBALL"):
        compared(folder, panorama(kind))
    if not IS_OLD:  # Cycles of 3.4 mirrors them
        for kind in ("FISHEYE_EQUIDISTANT", "FISHEYE_EQUISOLID"):
            compared(folder, panorama(kind))


def test_motion_blur_leaves_it_empty_as_cycles_does(folder):
    scene = scene_of(lambda scene: None)
    scene.render.use_motion_blur = True
    ours, theirs, _, _ = render_both(scene, folder)
    assert not stacked(ours, "Vector", "XYZW").any()
    assert not stacked(theirs, "Vector", "XYZW").any()


def test_the_picture_is_that_without_the_pass(folder):
    scene = scene_of(lambda scene: None)
    scene.render.engine = "KOMOREBI"
    with_vector = support.render(folder, "with")
    bpy.context.view_layer.use_pass_vector = False
    assert np.array_equal(support.render(folder, "without"), with_vector)
