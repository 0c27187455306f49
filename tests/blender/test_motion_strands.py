"""Motion blur of hair, hair curves and points that change their shape: what the core is given."""

from itertools import pairwise

import bpy
import numpy as np
import support
from moving_things import animate, curves_of, has_cycles, lean, moving, moving_scene


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
