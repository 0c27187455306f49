"""Pictures end to end: what lands in Blender's files."""

import bpy
import numpy as np
import support


def letter_f():
    """An F of three boxes, facing an orthographic camera: no symmetry to hide a flip."""
    for name in ("Cube", "Light"):
        bpy.data.objects.remove(bpy.data.objects[name])
    for center, size in (((-1, 0), (0.6, 4)), ((0.3, 1.7), (2, 0.6)), ((0, 0), (1.4, 0.6))):
        x, y = np.array(size) / 2
        mesh = bpy.data.meshes.new("Bar")
        corners = [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)]
        mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
        support.add_object("Bar", mesh, (*center, 0))
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", 6
    camera.location, camera.rotation_euler = (0, 0, 5), (0, 0, 0)


def test_orientation(folder):
    letter_f()
    scene = bpy.context.scene
    support.small(scene, size=(60, 60))
    scene.render.film_transparent = True
    alpha = support.render(folder)[:, :, 3]

    def at(x, y):  # world → pixel, 10 pixels a metre, row 0 at the bottom
        return alpha[int(30 + 10 * y), int(30 + 10 * x)]

    assert at(-1, -1.5) == 1 and at(-1, 1.7) == 1, "the stem"
    assert at(1, 1.7) == 1 and at(1, -1.7) == 0, "the long bar is at the top right"
    assert at(0.5, 0) == 1 and at(1, 0) == 0 and at(0.5, 0.9) == 0, "the short bar"
    assert at(-2, 0) == 0


def test_film_alpha(folder):
    scene = bpy.context.scene
    solid = support.render(folder, "solid")
    assert (solid[:, :, 3] == 1).all()
    scene.render.film_transparent = True
    clear = support.render(folder, "clear")
    alpha = clear[:, :, 3]
    assert alpha[0, 0] == 0
    assert alpha[24, 32] == 1
    edges = (alpha > 0) & (alpha < 1)
    assert edges.any()
    assert (clear[alpha == 0] == 0).all(), "alpha is premultiplied"
    assert np.allclose(clear[:, :, :3], alpha[:, :, None], atol=1e-6), "a lone cube's AO is 1"


def test_border_and_crop_equal_the_whole(folder):
    scene = bpy.context.scene
    support.small(scene, size=(97, 61), samples=8)
    bpy.ops.mesh.primitive_uv_sphere_add(location=(1.2, -0.6, 0.4))
    scene.komorebi.method = "WORLD_LIGHT"
    whole = support.render(folder, "whole")
    render = scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x = 0.31, 0.77
    render.border_min_y, render.border_max_y = 0.2, 0.9
    x0, x1, y0, y1 = int(0.31 * 97), int(0.77 * 97), int(0.2 * 61), int(0.9 * 61)
    border = support.render(folder, "border")
    assert border.shape == whole.shape
    assert (border[y0:y1, x0:x1] == whole[y0:y1, x0:x1]).all()
    outside = np.ones(whole.shape[:2], bool)
    outside[y0:y1, x0:x1] = False
    assert (border[outside] == 0).all()
    render.use_crop_to_border = True
    crop = support.render(folder, "crop")
    assert crop.shape == (y1 - y0, x1 - x0, 4)
    assert (crop == whole[y0:y1, x0:x1]).all(), "to the last bit"


def test_same_picture_for_any_number_of_threads(folder):
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 1.5))
    first = support.render(folder, "auto")
    scene.render.threads_mode = "FIXED"
    for threads in (1, 3):
        scene.render.threads = threads
        with support.captured("driver.export_settings") as calls:
            assert (support.render(folder, f"threads{threads}") == first).all(), threads
        assert calls[0][1]["threads"] == threads


def test_seed_and_animated_seed(folder):
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_plane_add(size=20, location=(0, 0, -1))
    scene.frame_set(1)
    first = support.render(folder, "a")
    scene.frame_set(2)
    assert (support.render(folder, "b") == first).all()
    scene.komorebi.use_animated_seed = True
    animated = support.render(folder, "c")
    assert (animated != first).any()
    assert (support.render(folder, "d") == animated).all()
    scene.komorebi.use_animated_seed = False
    scene.komorebi.seed = 7
    assert (support.render(folder, "e") != first).any()


def test_pixel_aspect_and_percentage(folder):
    letter_f()
    scene = bpy.context.scene
    support.small(scene, size=(120, 120))
    scene.render.film_transparent = True
    scene.render.resolution_percentage = 50
    scene.render.pixel_aspect_x = 2
    scene.camera.data.sensor_fit = "HORIZONTAL"
    alpha = support.render(folder)[:, :, 3]
    assert alpha.shape == (60, 60)
    # 10 pixels a metre across, pixels twice as wide as high: 20 a metre upwards.
    assert alpha[30, 20] == 1
    assert alpha[30 - 30, 20] == 1
    assert alpha[30, 40] == 0


def test_depth_and_normal(folder):
    scene = bpy.context.scene
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = True
    camera = scene.camera
    camera.location, camera.rotation_euler = (0, 0, 8), (0, 0, 0)
    planes = passes_of_a_render(folder)
    depth, normal = planes["Depth"][:, :, 0], planes["Normal"]
    assert depth.shape == (48, 64)
    assert normal.shape == (48, 64, 3)
    assert depth[0, 0] == np.float32(1e10), "background as in Cycles"
    top = depth[18:30, 26:38]
    assert np.allclose(top, 7.0, atol=1e-5), "along the axis, not along the ray"
    assert np.allclose(normal[24, 32], (0, 0, 1), atol=1e-6)
    assert (normal[0, 0] == 0).all()


def passes_of_a_render(folder):
    """Reads every pass back from Blender's render result, after it was written there."""
    from komorebi import compat

    planes, original = {}, compat.set_rect

    def set_rect(render_pass, pixels):
        original(render_pass, pixels)
        back = np.empty(pixels.size, np.float32)
        flat = compat.FLAT_RECTS
        target = back if flat else back.reshape(-1, pixels.shape[2])
        render_pass.rect.foreach_get(target)
        planes[render_pass.name] = back.reshape(pixels.shape)

    compat.set_rect = set_rect
    try:
        support.render(folder)
    finally:
        compat.set_rect = original
    return planes


def test_view_layers_are_rendered_each(folder):
    scene = bpy.context.scene
    empty = scene.view_layers.new("Empty")
    for child in empty.layer_collection.children:
        child.exclude = True
    scene.render.film_transparent = True
    with support.captured("driver.export_scene") as calls:
        pixels = support.render(folder)
    assert [len(data.meshes) for _, data in calls] == [1, 0]
    assert pixels[24, 32, 3] == 1, "the first layer is what is saved"


def test_ortho_and_persp_show_the_same_center(folder):
    scene = bpy.context.scene
    scene.render.film_transparent = True
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = 7
    alpha = support.render(folder)[:, :, 3]
    assert alpha[24, 32] == 1
    assert alpha[0, 0] == 0


def test_clip_distances_cut_the_scene(folder):
    scene = bpy.context.scene
    scene.render.film_transparent = True
    scene.camera.data.clip_end = 5
    assert support.render(folder, "far")[24, 32, 3] == 0
    scene.camera.data.clip_end, scene.camera.data.clip_start = 100, 30
    assert support.render(folder, "near")[24, 32, 3] == 0


def test_noise_threshold_stops_where_it_is_calm():
    """The sky needs the least samples; the pass says how many there were, as Cycles' does."""
    scene = bpy.context.scene
    support.small(scene, size=(96, 64), samples=128)
    bpy.ops.mesh.primitive_plane_add(size=40, location=(0, 0, -1))
    scene.camera.rotation_euler.x += 0.35  # the horizon comes into sight
    scene.view_layers[0].komorebi.pass_debug_sample_count = True
    name = "Debug Sample Count"
    assert (support.exported_picture(name) == 1.0).all(), "without a threshold all have all"
    scene.komorebi.use_adaptive_sampling = True
    scene.komorebi.adaptive_threshold = 0.005
    scene.komorebi.adaptive_min_samples = 8
    fraction = support.exported_picture(name)
    assert fraction.shape == (64, 96, 1)
    assert 0.0 < fraction.min() < 0.5
    assert fraction.min() < fraction.max() <= 1.0
    scene.komorebi.sample_offset = 4
    assert (support.exported_picture(name) == 1.0).all(), "parts of a picture stop nowhere"


def test_time_limit_ends_after_whole_passes():
    scene = bpy.context.scene
    support.small(scene, size=(64, 48), samples=1 << 16)
    scene.komorebi.time_limit = 0.2
    scene.view_layers[0].komorebi.pass_debug_sample_count = True
    fraction = support.exported_picture("Debug Sample Count")
    assert 0.0 < fraction.min() == fraction.max() < 0.5
