"""Motion blur: what is handed to the core, at which times, and that a picture shows it."""

import math
from itertools import pairwise

import bpy
import numpy as np
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


def hairy(cube, count=40):
    """Hair on an object; its settings."""
    cube.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = cube.particle_systems[-1].settings
    settings.type, settings.count, settings.hair_step, settings.render_step = "HAIR", count, 3, 2
    return settings


def hair_of(data):
    (hair,) = (mesh for mesh in data.meshes if hasattr(mesh, "curve_offsets"))
    return hair


def test_hair_follows_the_mesh_that_it_grows_on():
    scene, cube = moving_scene()
    for vertex in cube.data.vertices:
        vertex.co.z = vertex.co.z if vertex.co.z > 0 else 0.9  # a plate, so that all of it leans
    cube.shape_key_add(name="Basis")
    key = cube.shape_key_add(name="Rise")
    for point in key.data:
        point.co.z += 1.0
    for frame, value in ((9, 0.0), (11, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for curve in curves_of(key):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    hairy(cube)
    scene.frame_set(10)
    with support.warnings() as said:
        data = support.exported_whole()
    assert not said, said
    assert len(moving(data)) == 2, "hair moves with its object"
    hair = hair_of(data)
    assert hair.motion_positions.shape == (2, 40 * 5, 3) and hair.motion_radii is None
    steps = hair.motion_positions - hair.positions
    assert np.allclose(steps, [[[0, 0, -0.125]], [[0, 0, 0.125]]], atol=1e-4), steps
    if has_cycles():
        cube.cycles.use_deform_motion = False
        assert hair_of(support.exported_whole()).motion_positions is None


def test_hair_that_only_goes_along_is_read_once():
    _, cube = moving_scene()
    hairy(cube, 64)
    with support.captured("export.moving_hair.export_hair") as calls:
        hair = hair_of(support.exported_whole())
    assert hair.motion_positions is None and hair.motion_radii is None
    assert [len(some.radii) for _, some in calls] == [4 * 5] * 3, "every sixteenth strand alone"


def test_hair_changes_its_width_and_length():
    scene, cube = moving_scene()
    settings = hairy(cube)
    animate(settings, "radius_scale", {9: 0.1, 11: 0.3})
    animate(settings, "hair_length", {9: 1.0, 11: 3.0})
    scene.frame_set(10)
    hair = hair_of(support.exported_whole())
    assert hair.motion_radii.shape == (2, 40 * 5)
    middle = hair.radii > 0.0
    share = hair.motion_radii[:, middle] / hair.radii[middle]
    assert np.allclose(share, [[0.875], [1.125]], atol=1e-3), share


def test_strands_that_change_in_number_are_told_and_stay():
    scene, cube = moving_scene()
    settings = hairy(cube)
    settings.child_type = "INTERPOLATED"
    for frame, number in ((9, 2), (11, 8)):
        settings.rendered_child_count = number
        settings.keyframe_insert("rendered_child_count", frame=frame)
    scene.frame_set(10)
    with support.warnings() as said:
        hair = hair_of(support.exported_whole())
    assert hair.motion_positions is None
    assert len([s for s in said if 'object "Cube"' in s and "number of its strands" in s]) == 1, (
        said
    )


def node_tree(*kinds):
    """Geometry nodes of these kinds between input and output, and the nodes."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    if hasattr(tree, "interface"):  # from 4.0
        for way in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", *kinds, "NodeGroupOutput")]
    for before, after in pairwise(nodes):
        tree.links.new(before.outputs[0], after.inputs[0])
    return tree, nodes[1:-1]


def test_hair_curves_that_nodes_bend():
    scene, _ = moving_scene()
    bpy.ops.object.curves_random_add()
    wild = bpy.context.object
    tree, (move,) = node_tree("GeometryNodeSetPosition")
    wild.modifiers.new("Nodes", "NODES").node_group = tree
    animate(move.inputs["Offset"], "default_value", {9: (0.0, 0.0, 0.0), 11: (4.0, 0.0, 0.0)})
    scene.frame_set(10)
    with support.warnings() as said:
        data = support.exported_whole()
    assert not said, said
    curves = hair_of(data)
    steps = curves.motion_positions - curves.positions
    assert np.allclose(steps, [[[-0.5, 0, 0]], [[0.5, 0, 0]]], atol=1e-5), steps
    scene.render.use_motion_blur = False
    scene.view_layers[0].use_pass_vector = True
    curves = hair_of(support.exported_whole())
    assert curves.motion_positions is None
    steps = curves.step_positions - curves.positions
    assert np.allclose(steps, [[[-2, 0, 0]], [[2, 0, 0]]], atol=1e-5), steps


def test_points_have_a_velocity():
    scene, cube = moving_scene()
    cube.animation_data_clear()
    tree, (_, store) = node_tree("GeometryNodeMeshToPoints", "GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT_VECTOR", "POINT"
    store.inputs["Name"].default_value = "velocity"
    value = next(i for i in store.inputs if i.name == "Value" and i.enabled)
    value.default_value = (0.0, 24.0, 0.0)  # metres a second: one a frame
    scene.render.fps, scene.render.fps_base = 24, 1.0
    cube.modifiers.new("Nodes", "NODES").node_group = tree
    cloud = next(m for m in support.exported_whole().meshes if hasattr(m, "radii"))
    steps = cloud.motion_positions - cloud.positions
    assert np.allclose(steps, [[[0, -0.25, 0]], [[0, 0.25, 0]]], atol=1e-5), steps
    assert cloud.motion_radii is None


def test_strands_that_deform_are_known_again():
    from komorebi import cache

    scene, cube = moving_scene()
    lean(cube, {9: 0.0, 11: 1.0})
    hairy(cube)
    scene.frame_set(10)
    scene.komorebi.samples = 1
    bpy.ops.render.render()
    before = cache.misses
    bpy.ops.render.render()
    assert cache.misses == before, "the same frame again builds nothing"
    scene.frame_set(11)
    bpy.ops.render.render()
    assert cache.misses == before + 2


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
