"""Motion blur: what is handed to the core, at which times, and that a picture shows it."""

import math

import bpy
import numpy as np
import support
from moving_things import animate, has_cycles, lean, moving, moving_scene, xs


def test_poses_stand_where_the_shutter_is():
    for position, middle in (("CENTER", 10.0), ("START", 10.25), ("END", 9.75)):
        scene, _ = moving_scene(position=position)
        (group,) = moving(support.exported())
        assert np.allclose(xs(group), [middle - 0.25, middle, middle + 0.25], atol=1e-5)
        assert np.array_equal(group.matrices[0], group.motion[0, 1])
        assert (scene.frame_current, scene.frame_subframe) == (10, 0.0), "the frame is back"
        assert math.isclose(bpy.data.objects["Cube"].matrix_world.translation.x, 10.0, abs_tol=1e-5)


def test_a_subframe_is_kept():
    scene, _ = moving_scene()
    scene.frame_set(10, subframe=0.5)
    with support.captured("driver.export_scene") as calls:
        bpy.ops.render.render()
    (group,) = moving(calls[-1][1])
    assert np.allclose(xs(group), [10.25, 10.5, 10.75], atol=1e-5)
    assert (scene.frame_current, scene.frame_subframe) == (10, 0.5)


def test_without_motion_blur_nothing_is_looked_at_twice():
    scene, cube = moving_scene(use_motion_blur=False)
    assert not moving(support.exported()) and support.exported().camera.shutter is None
    scene.render.use_motion_blur, scene.view_layers[0].use_motion_blur = True, False
    assert not moving(support.exported())
    scene.view_layers[0].use_motion_blur = True
    cube.animation_data_clear()
    data = support.exported()
    assert not moving(data) and len(data.instances) == 1, "what stands still has one pose"


def test_steps_are_cycles_own():
    if not has_cycles():
        raise support.Skip("Cycles' add-on is not there")
    _, cube = moving_scene()
    for steps, poses in ((1, 3), (2, 5), (3, 9), (7, 129), (9, 129)):
        cube.cycles.motion_steps = steps
        (group,) = moving(support.exported())
        assert group.motion.shape[1] == poses, (steps, group.motion.shape)
        assert np.allclose(np.diff(xs(group)), 0.5 / (poses - 1), atol=1e-4)
    cube.cycles.use_motion_blur = False
    assert not moving(support.exported())


def instanced(steps=1):
    """The cube in a collection that an empty instances twice the size, and the empty moves."""
    scene, cube = moving_scene()
    cube.animation_data_clear()
    cube.location = (0.0, 1.0, 0.0)
    collection = bpy.data.collections.new("Stock")
    collection.objects.link(cube)
    for owner in cube.users_collection:
        if owner != collection:
            owner.objects.unlink(cube)
    empty = support.add_object("Empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.scale = (2.0, 2.0, 2.0)
    animate(empty, "location", {0: (0.0, 0.0, 0.0), 20: (20.0, 0.0, 0.0)})
    if has_cycles():
        empty.cycles.motion_steps = steps
    scene.frame_set(10)
    return scene, cube, empty


def test_instances_move_with_their_instancer_and_by_its_settings():
    _, cube, empty = instanced(steps=2)
    (group,) = moving(support.exported())
    assert group.motion.shape[1] == (5 if has_cycles() else 3)
    assert np.allclose(xs(group)[[0, -1]], [9.75, 10.25], atol=1e-5)
    assert np.allclose(group.motion[0, 0, 1, [1, 3]], [2.0, 2.0])
    if has_cycles():
        for holder in (cube, empty):
            holder.cycles.use_motion_blur = False
            assert not moving(support.exported())
            holder.cycles.use_motion_blur = True


def test_some_of_a_meshs_instances_move():
    _, cube = moving_scene()
    for k in range(3):
        support.add_object(f"Still {k}", cube.data, (0.0, 3.0 * k, 0.0))
    data = support.exported()
    assert [len(group.matrices) for group in data.instances] == [1, 3]
    assert [group.motion is None for group in data.instances] == [False, True]
    names = [data.objects[i].name for group in data.instances for i in group.object_index]
    assert names[0] == "Cube" and sorted(names[1:]) == ["Still 0", "Still 1", "Still 2"]


def test_a_particle_that_is_born_within_the_time_is_left_out():
    scene, cube = moving_scene()
    cube.animation_data_clear()
    cube.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = cube.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end = 40, 1.0, 20.0
    settings.lifetime, settings.render_type = 100.0, "OBJECT"
    settings.instance_object = support.add_object("Bit", bpy.data.meshes.new("Bit"), (0, 0, 50))
    settings.instance_object.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    for frame in range(1, 11):  # physics goes from frame to frame
        scene.frame_set(frame)
    alive = sum(group.matrices.shape[0] for group in particles(support.exported()))
    scene.render.use_motion_blur = False
    born = sum(group.matrices.shape[0] for group in particles(support.exported()))
    assert 0 < alive < born, (alive, born)


def particles(data):
    return [group for group in data.instances if group.name == "Bit" and len(group.matrices) > 1]


def test_a_mesh_deforms():
    scene, cube = moving_scene()
    cube.animation_data_clear()
    lean(cube, {9: 0.0, 11: 1.0})
    cube.data.polygons.foreach_set("use_smooth", [True] * 6)
    scene.frame_set(10)
    mesh = support.exported_whole().meshes[0]
    assert mesh.motion_positions.shape == (2, 8, 3)
    heights = [mesh.motion_positions[0, 0, 2], mesh.positions[0, 2], mesh.motion_positions[1, 0, 2]]
    assert np.allclose(np.diff(heights), 0.125, atol=1e-5), heights
    assert np.array_equal(mesh.motion_positions[:, 1:], np.stack([mesh.positions[1:]] * 2))
    assert mesh.motion_normals.shape == (2, *mesh.vertex_normals.shape)
    assert abs(mesh.motion_normals - mesh.vertex_normals).max() > 0.01
    if has_cycles():
        cube.cycles.use_deform_motion = False
        assert support.exported_whole().meshes[0].motion_positions is None


def test_a_mesh_that_could_deform_and_does_not_is_still():
    scene, cube = moving_scene()
    lean(cube, {1: 0.5})
    scene.frame_set(10)
    data = support.exported_whole()
    assert data.meshes[0].motion_positions is None and len(moving(data)) == 1


def test_meshes_that_deform_are_known_again():
    from komorebi import cache

    scene, cube = moving_scene()
    lean(cube, {9: 0.0, 11: 1.0})
    scene.frame_set(10)
    scene.komorebi.samples = 1
    bpy.ops.render.render()
    before = cache.misses
    bpy.ops.render.render()
    assert cache.misses == before, "the same frame again builds nothing"
    scene.frame_set(11)
    bpy.ops.render.render()
    assert cache.misses == before + 1


def test_a_velocity_says_where_vertices_were():
    scene, cube = moving_scene()
    cube.animation_data_clear()
    speed = cube.data.attributes.new("velocity", "FLOAT_VECTOR", "POINT")
    for entry in speed.data:
        entry.vector = (0.0, 24.0, 0.0)  # metres a second: one a frame
    scene.render.fps, scene.render.fps_base = 24, 1.0
    mesh = support.exported_whole().meshes[0]
    assert np.allclose(mesh.motion_positions - mesh.positions, [[[0, -0.25, 0]], [[0, 0.25, 0]]])
    assert mesh.motion_normals is None


def test_faces_that_change_are_told_and_stay():
    scene, cube = moving_scene()
    cube.animation_data_clear()
    array = cube.modifiers.new("Array", "ARRAY")
    cube.modifiers.new("Bend", "SIMPLE_DEFORM").angle = 0.3
    for frame, count in ((9, 1), (11, 21)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    scene.frame_set(10)
    with support.warnings() as said:
        mesh = support.exported_whole().meshes[0]
    assert mesh.motion_positions is None
    assert len([s for s in said if 'object "Cube"' in s and "faces change" in s]) == 1, said


def test_a_camera_moves_and_zooms():
    scene, _ = moving_scene()
    camera = scene.camera
    animate(camera, "location", {9: (7.0, -7.0, 5.0), 11: (9.0, -7.0, 5.0)})
    animate(camera.data, "lens", {9: 40.0, 11: 60.0})
    scene.frame_set(10)
    motion = support.exported().camera.motion
    assert np.allclose(motion["matrices"][:, 0, 3], [7.75, 8.0, 8.25], atol=1e-5)
    assert np.allclose([motion["zoom_open"], motion["zoom_close"]], [50 / 47.5, 50 / 52.5])
    if has_cycles():
        camera.cycles.use_motion_blur = False
        assert support.exported().camera.motion is None
        camera.cycles.use_motion_blur, camera.cycles.motion_steps = True, 2
        assert len(support.exported().camera.motion["matrices"]) == 5


def test_a_marker_within_the_time_changes_no_camera():
    scene, _ = moving_scene()
    other = support.add_object("Other", bpy.data.cameras.new("Other"), (50.0, 0.0, 0.0))
    for frame, camera in ((9, scene.camera), (11, other)):
        scene.timeline_markers.new(f"m{frame}", frame=frame).camera = camera
    scene.frame_set(10)
    scene.render.motion_blur_shutter = 2.0
    name = scene.camera.name
    camera = support.exported().camera
    assert camera.name == name and camera.motion is None
    assert scene.camera.name == name, "and the scene has its own again"


def test_both_eyes_move():
    scene, _ = moving_scene()
    scene.render.use_multiview, scene.render.views_format = True, "STEREO_3D"
    animate(scene.camera, "location", {9: (7.0, -7.0, 5.0), 11: (9.0, -7.0, 5.0)})
    scene.frame_set(10)
    left, right = support.exported().cameras.values()
    between = right.motion["matrices"][:, :3, 3] - left.motion["matrices"][:, :3, 3]
    distance = scene.camera.data.stereo.interocular_distance
    assert np.allclose(np.linalg.norm(between, axis=1), distance, atol=1e-5)
    assert np.allclose(np.diff(left.motion["matrices"][:, 0, 3]), 0.25, atol=1e-5)


def test_the_shutter_opens_as_its_curve_says():
    scene, _ = moving_scene()
    assert support.exported().camera.shutter is None
    curve = scene.render.motion_blur_shutter_curve
    curve.curves[0].points[0].location = (0.0, 0.0)
    curve.update()
    weights = support.exported().camera.shutter["curve"]
    assert weights[0] == 0.0 and math.isclose(weights[-1], 1.0, abs_tol=1e-5)
    assert len(weights) == 256 and weights.dtype == np.float32
    if has_cycles():
        scene.cycles.rolling_shutter_type, scene.cycles.rolling_shutter_duration = "TOP", 0.25
        assert support.exported().camera.shutter["rolling_duration"] == 0.25


def test_frames_with_persistent_data_each_have_their_own_motion():
    scene, cube = moving_scene()
    lean(cube, {0: 0.0, 20: 1.0})
    scene.render.use_persistent_data = True
    scene.komorebi.samples = 1
    scene.frame_start, scene.frame_end = 9, 11
    with support.captured("driver.export_scene") as calls, support.folder() as out:
        scene.render.filepath = str(out / "f")
        bpy.ops.render.render(animation=True)
    assert len(calls) == 3
    for frame, (_, data) in zip((9, 10, 11), calls, strict=True):
        (group,) = moving(data)
        assert np.allclose(xs(group), [frame - 0.25, frame, frame + 0.25], atol=1e-5)
    scene.render.use_persistent_data = False


def test_a_failed_export_leaves_the_frame_where_it_was():
    scene, _ = moving_scene(position="START")
    support.spoil(scene.camera)
    try:
        bpy.ops.render.render()
        raised = False
    except RuntimeError as error:
        raised = "focuses" in str(error)
    assert raised and (scene.frame_current, scene.frame_subframe) == (10, 0.0)


def test_a_picture_shows_how_long_something_was_there(folder):
    """A quad of 2 × 2 m passes by 4 m under an orthographic camera of 8 m: coverage is a trapezium."""
    scene = support.fresh_scene(size=(64, 16), samples=64)
    for obj in list(scene.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    camera = scene.camera
    camera.location, camera.rotation_euler = (0.0, 0.0, 5.0), (0.0, 0.0, 0.0)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 8.0
    mesh = bpy.data.meshes.new("Quad")
    mesh.from_pydata([(-1, -9, 0), (1, -9, 0), (1, 9, 0), (-1, 9, 0)], [], [(0, 1, 2, 3)])
    quad = support.add_object("Quad", mesh)
    animate(quad, "location", {9: (-4.0, 0.0, 0.0), 11: (4.0, 0.0, 0.0)})
    scene.render.film_transparent = True
    scene.komorebi.pixel_filter = "BOX"
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    scene.frame_set(10)
    row = support.render(folder)[8, :, 3]
    at = (np.arange(64) + 0.5) / 8.0 - 4.0
    expected = np.clip((3.0 - abs(at)) / 4.0, 0.0, 0.5)
    assert abs(row - expected).max() < 0.05, abs(row - expected).max()
