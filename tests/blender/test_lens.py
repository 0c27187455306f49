"""Lenses, panoramas, stereo: what is read from Blender, and which sentences end a render."""

import math

import bpy
import mathutils
import numpy as np
import support
from komorebi import compat
from komorebi.errors import RenderError
from komorebi.export import panorama

NUMBERS = {
    "EQUIRECTANGULAR": {"longitude_min": -1.0, "longitude_max": 2.0, "latitude_max": 0.5},
    "FISHEYE_EQUIDISTANT": {"fisheye_fov": 2.0},
    "FISHEYE_EQUISOLID": {"fisheye_lens": 8.0, "fisheye_fov": 2.5},
    "MIRRORBALL": {},
    "FISHEYE_LENS_POLYNOMIAL": {"fisheye_polynomial_k1": -0.05, "fisheye_polynomial_k4": 1e-6},
    "EQUIANGULAR_CUBEMAP_FACE": {},
    "CENTRAL_CYLINDRICAL": {
        "central_cylindrical_range_u_max": 2.0, "central_cylindrical_range_v_min": -3.0,
        "central_cylindrical_radius": 2.0,
    },
}  # fmt: skip


def make_panoramic(kind):
    """The scene's camera as a panorama; its settings, or None when this Blender lacks the kind."""
    camera = bpy.context.scene.camera
    camera.data.type = "PANO"
    settings = compat.panorama_settings(camera.data)
    assert settings is not None, "these tests need the Cycles add-on"
    known = {i.identifier for i in settings.bl_rna.properties["panorama_type"].enum_items}
    assert known <= set(NUMBERS), f"a kind of panorama that nobody has seen: {known}"
    if kind not in known:
        return None
    settings.panorama_type = kind
    for name, value in NUMBERS[kind].items():
        setattr(settings, name, value)
    return settings


def sentence_of(function, *arguments):
    try:
        function(*arguments)
    except (RenderError, RuntimeError) as error:
        return str(error)
    raise AssertionError("no error")


def close(a, b):
    return math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)


def test_every_panorama_renders():
    seen = 0
    for kind in NUMBERS:
        if make_panoramic(kind) is None:
            continue
        picture = support.exported_picture("Combined")
        assert np.isfinite(picture).all() and picture[..., :3].max() > 0.1, kind
        assert (picture[..., 3] == 1.0).all(), kind
        corner = picture[0, 0, :3]
        round_one = kind in {"FISHEYE_EQUIDISTANT", "MIRRORBALL"}
        assert (corner == 0.0).all() if round_one else True, (kind, corner)
        seen += 1
    assert seen >= 6


def test_numbers_of_panoramas():
    scene = bpy.context.scene
    scene.camera.data.shift_x = 0.25
    scene.camera.data.sensor_width = 30.0
    scene.render.pixel_aspect_x = 2.0
    make_panoramic("FISHEYE_EQUISOLID")
    data = support.exported().camera
    assert data.kind == "PANORAMA" and data.lens is None and data.stereo is None
    assert np.allclose(data.matrix, np.array(scene.camera.matrix_world))
    numbers = data.panorama
    assert numbers["kind"] == "FISHEYE_EQUISOLID" and close(numbers["shift_x"], 0.25)
    assert close(numbers["focal_length"], 8.0) and close(numbers["fov"], 2.5)
    assert close(numbers["sensor_width"], 30.0)
    assert close(numbers["sensor_height"], 30.0 * 48 / (2 * 64))
    make_panoramic("EQUIRECTANGULAR")
    numbers = support.exported().camera.panorama
    assert close(numbers["longitude_max"], 2.0) and close(numbers["latitude_min"], -math.pi / 2)
    make_panoramic("FISHEYE_LENS_POLYNOMIAL")
    assert close(support.exported().camera.panorama["k1"], -0.05)
    if make_panoramic("CENTRAL_CYLINDRICAL"):
        assert close(support.exported().camera.panorama["height_min"], -1.5)


def test_sensor_fits():
    data = bpy.context.scene.camera.data
    data.sensor_width, data.sensor_height = 36.0, 20.0
    for fit, size, expected in (
        ("AUTO", (200, 100), (36.0, 18.0)), ("AUTO", (100, 200), (18.0, 36.0)),
        ("HORIZONTAL", (100, 200), (36.0, 72.0)), ("VERTICAL", (200, 100), (40.0, 20.0)),
    ):  # fmt: skip
        data.sensor_fit = fit
        assert panorama.sensor_size(data, *size) == expected, (fit, size)


def test_a_border_is_a_part_of_the_panorama():
    scene = bpy.context.scene
    make_panoramic("FISHEYE_EQUIDISTANT")
    whole = support.exported_picture("Combined")
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.5, 1.0
    assert np.array_equal(support.exported_picture("Combined"), whole[24:, 16:48])


def test_depth_of_a_panorama_is_distance():
    scene = bpy.context.scene
    scene.view_layers[0].use_pass_z = True
    make_panoramic("EQUIRECTANGULAR")
    scene.camera.matrix_world = mathutils.Matrix.Translation((0, 0, 0))  # inside the cube
    scene.camera.data.clip_start = 1e-3
    depth = support.exported_picture("Depth")
    # The faces of the default cube are 1 m away, its corners √3.
    assert depth.min() >= 1.0 - 1e-6 and depth.max() <= math.sqrt(3.0) + 1e-6
    assert depth.max() > 1.4


def test_lens_of_a_perspective_camera():
    camera = bpy.context.scene.camera
    assert support.exported().camera.lens is None
    dof = camera.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_distance = True, 2.0, 7.0
    dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 6, 0.5, 1.5
    camera.data.lens = 40.0
    lens = support.exported().camera.lens
    assert close(lens["radius"], 0.01) and close(lens["focus_distance"], 7.0)
    assert lens["blades"] == 6 and close(lens["rotation"], 0.5) and close(lens["ratio"], 1.5)
    dof.aperture_blades = 2
    camera.data.type = "ORTHO"
    lens = support.exported().camera.lens
    assert lens["blades"] == 0 and close(lens["radius"], 0.25)


def test_focus_object_and_bone():
    scene = bpy.context.scene
    camera = scene.camera
    camera.matrix_world = mathutils.Matrix.Translation((0, 0, 10))  # looks down
    camera.data.dof.use_dof = True
    target = support.add_object("Target", None, (3, 4, 2.5))
    camera.data.dof.focus_object = target
    assert close(support.exported().camera.lens["focus_distance"], 7.5)
    armature = bpy.data.armatures.new("Bones")
    rig = support.add_object("Rig", armature, (0, 0, 1))
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 3), (0, 1, 3)
    bpy.ops.object.mode_set(mode="OBJECT")
    camera.data.dof.focus_object = rig
    assert close(support.exported().camera.lens["focus_distance"], 9.0)
    camera.data.dof.focus_subtarget = "Bone"
    assert close(support.exported().camera.lens["focus_distance"], 6.0)


def test_what_is_no_lens_ends_with_a_sentence():
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.focus_distance = True, 0.0
    assert 'Camera "Camera" focuses at distance 0' in sentence_of(bpy.ops.render.render)
    dof.focus_distance, dof.aperture_fstop = 1.0, 0.0  # the widest that Cycles takes
    assert support.exported().camera.lens["radius"] > 1000.0


def test_what_is_no_panorama_ends_with_a_sentence():
    settings = make_panoramic("FISHEYE_LENS_POLYNOMIAL")
    settings.fisheye_polynomial_k3 = math.nan
    assert 'camera "Camera": the panorama\'s polynomial must have finite' in sentence_of(
        bpy.ops.render.render
    )
    settings = make_panoramic("EQUIRECTANGULAR")
    settings.latitude_min, settings.latitude_max = 1.0, -1.0  # upside down, as Cycles
    assert np.isfinite(support.exported_picture("Combined")).all()
    original = compat.panorama_settings
    compat.panorama_settings = lambda _: None  # as without the Cycles add-on in old releases
    try:
        assert "Cycles add-on" in sentence_of(bpy.ops.render.render)
    finally:
        compat.panorama_settings = original


def test_custom_cameras_end_with_a_sentence():
    data = bpy.context.scene.camera.data
    if "CUSTOM" not in {i.identifier for i in data.bl_rna.properties["type"].enum_items}:
        return  # this release has none
    data.type = "CUSTOM"
    assert "Open Shading Language are not supported" in sentence_of(bpy.ops.render.render)


def views_of(function):
    with support.captured("driver.export_frame") as frames:
        function()
    return frames[-1][1].views


def test_spherical_stereo():
    scene = bpy.context.scene
    scene.render.use_multiview = True
    stereo = scene.camera.data.stereo
    stereo.interocular_distance, stereo.convergence_distance = 0.5, 3.0
    stereo.use_spherical_stereo, stereo.convergence_mode = True, "OFFAXIS"
    make_panoramic("EQUIRECTANGULAR")
    left, right = views_of(bpy.ops.render.render)
    assert np.allclose(left.camera.matrix, right.camera.matrix), "the pose is the middle's"
    assert close(left.camera.stereo["eye"], -0.25) and close(right.camera.stereo["eye"], 0.25)
    assert close(left.camera.stereo["convergence_distance"], 3.0)
    assert left.camera.panorama["shift_x"] == right.camera.panorama["shift_x"] == 0.0
    stereo.convergence_mode, stereo.use_pole_merge = "PARALLEL", True
    left, right = views_of(bpy.ops.render.render)
    assert "convergence_distance" not in left.camera.stereo
    assert close(left.camera.stereo["pole_merge_angle_to"], stereo.pole_merge_angle_to)
    stereo.use_spherical_stereo = False
    left, right = views_of(bpy.ops.render.render)
    assert left.camera.stereo is None
    assert not np.allclose(left.camera.matrix, right.camera.matrix)


def test_a_camera_for_each_view(folder):
    scene = bpy.context.scene
    render = scene.render
    render.use_multiview, render.views_format = True, "MULTIVIEW"
    scene.camera.name = "Shot_L"
    other = support.add_object("Shot_R", scene.camera.data.copy(), (0, 0, 30))
    third = support.add_object("Shot_top", scene.camera.data.copy(), (0, 0, 60))
    other.data.type = "PANO"
    view = render.views.new("top")
    view.camera_suffix, view.file_suffix = "_top", "_top"
    off = render.views.new("off")
    off.use = False
    views = views_of(bpy.ops.render.render)
    assert [v.name for v in views] == ["left", "right", "top"]
    assert np.allclose(views[1].camera.matrix, np.array(other.matrix_world))
    assert views[1].camera.kind == "PANORAMA" and views[2].camera.kind == "PERSPECTIVE"
    depth = views[2].camera.matrix @ np.array([0, 0, 0, 1.0])
    assert close(depth[3], third.location.z)


def test_views_reach_the_file(folder):
    scene = bpy.context.scene
    render = scene.render
    render.use_multiview = True
    scene.camera.data.stereo.interocular_distance = 1.0
    image = render.image_settings
    compat_media(image)
    image.file_format, image.color_mode = "PNG", "RGB"
    image.views_format = "INDIVIDUAL"
    render.filepath = str(folder / "eye")
    bpy.ops.render.render(write_still=True)
    left, right = (support.read(folder / f"eye_{side}.png") for side in "LR")
    assert left.max() > 0.1 and right.max() > 0.1 and not np.array_equal(left, right)
    image.views_format = "STEREO_3D"
    image.stereo_3d_format.display_mode = "SIDEBYSIDE"
    render.filepath = str(folder / "both.png")
    bpy.ops.render.render(write_still=True)
    both = support.read(folder / "both.png")
    assert np.array_equal(both, np.concatenate([left, right], axis=1))


def test_views_in_a_layered_file(folder):
    scene = bpy.context.scene
    scene.render.use_multiview = True
    image = scene.render.image_settings
    if "media_type" in image.bl_rna.properties:  # from 5.0 on
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format, image.views_format = "OPEN_EXR_MULTILAYER", "MULTIVIEW"
    scene.render.filepath = str(folder / "eyes.exr")
    bpy.ops.render.render(write_still=True)
    bytes_of = next(folder.glob("eyes*")).read_bytes()
    for side in (b"left", b"right"):
        # a channel of the one part, or from 5.0 on a part of its own
        channel, part = b"ViewLayer.Combined." + side + b".R", b"ViewLayer.Combined-" + side
        assert channel in bytes_of or part in bytes_of, side


def compat_media(image):
    if "media_type" in image.bl_rna.properties:  # from 5.0 on
        image.media_type = "IMAGE"
