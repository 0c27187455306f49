"""Hair of particle systems, hair curves and point clouds as arrays: how many, where, how thick."""

import bpy
import numpy as np
import support


def add_hair(thing, count=12, length=0.5):
    thing.modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = thing.particle_systems[-1].settings
    settings.type, settings.count, settings.hair_length = "HAIR", count, length
    settings.hair_step, settings.render_step = 3, 2
    return settings


def curves_of(data):
    """Name → the CurveData of that object."""
    from komorebi.scene_data import CurveData

    return {mesh.name: mesh for mesh in data.meshes if isinstance(mesh, CurveData)}


def exported():
    """support.exported() with the meshes that the core has been given since, none of them known."""
    from komorebi import cache, native_scene

    cache.clear()

    given, original = [], native_scene.load

    def load(core, data, *rest):
        given.append(list(data.meshes))
        return original(core, data, *rest)

    native_scene.load = load
    try:
        data = support.exported()
    finally:
        native_scene.load = original
    data.meshes = given[-1]
    return data


def exported_without_warnings():
    with support.warnings() as sentences:
        data = exported()
    assert not sentences, sentences
    return data


def test_straight_hair_stands_on_the_emitter():
    cube = bpy.data.objects["Cube"]
    cube.location, cube.scale = (5.0, -3.0, 2.0), (1.0, 2.0, 0.5)
    settings = add_hair(cube)
    settings.root_radius, settings.tip_radius, settings.radius_scale = 0.8, 0.2, 0.1
    settings.use_close_tip = False
    hair = curves_of(exported_without_warnings())["Cube"]
    keys = (1 << 2) + 1
    assert list(hair.curve_offsets) == list(range(0, 12 * keys + 1, keys))
    positions = hair.positions.reshape(12, keys, 3)
    # Roots lie on the cube, whatever its place and scale, and hair grows out of it.
    assert np.allclose(np.abs(positions[:, 0]).max(axis=1), 1.0, atol=1e-4)
    assert (np.abs(positions[:, -1]).max(axis=1) > 1.05).all()
    # Half of each diameter times the scale, from root to tip along the length.
    radii = hair.radii.reshape(12, keys)
    assert np.allclose(radii[:, 0], 0.5 * 0.8 * 0.1)
    assert np.allclose(radii[:, -1], 0.5 * 0.2 * 0.1)
    assert np.allclose(radii[:, 2], 0.5 * 0.5 * 0.1, rtol=2e-2)
    assert (hair.shape, hair.subdivisions) == ("RIBBONS", 2)


def test_the_shape_of_radii():
    settings = add_hair(bpy.data.objects["Cube"])
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 0.0, 1.0
    settings.shape, settings.use_close_tip = 0.5, True
    radii = curves_of(exported())["Cube"].radii.reshape(12, -1)
    along = np.linspace(0.0, 1.0, radii.shape[1])
    assert np.allclose(radii[:, :-1], 0.5 * (1.0 - along[:-1]) ** 2.0, atol=0.02)
    assert (radii[:, -1] == 0.0).all()
    settings.shape, settings.use_close_tip, settings.tip_radius = -0.5, False, 0.1
    radii = curves_of(exported())["Cube"].radii.reshape(12, -1)
    assert np.allclose(radii, 0.5 * (0.9 * (1.0 - along) ** 0.5 + 0.1), atol=0.02)


def test_children_stand_in_for_their_parents():
    settings = add_hair(bpy.data.objects["Cube"], count=10)
    settings.child_type, settings.rendered_child_count = "SIMPLE", 7
    hair = curves_of(exported())["Cube"]
    assert len(hair.curve_offsets) == 10 * 7 + 1
    assert np.isfinite(hair.positions).all()


def test_systems_of_one_object_are_one_set():
    cube = bpy.data.objects["Cube"]
    add_hair(cube, count=10)
    add_hair(cube, count=4).render_step = 4
    hair = curves_of(exported())["Cube"]
    assert list(np.diff(hair.curve_offsets)) == [5] * 10 + [17] * 4
    cube.modifiers[0].show_render = False
    hair = curves_of(exported())["Cube"]
    assert list(np.diff(hair.curve_offsets)) == [17] * 4


def test_an_emitter_that_is_not_shown_keeps_its_hair():
    cube = bpy.data.objects["Cube"]
    add_hair(cube)
    cube.show_instancer_for_render = False
    data = exported_without_warnings()
    assert len(data.meshes) == 1 and set(curves_of(data)) == {"Cube"}
    bpy.context.view_layer.use_strand = False
    assert not exported().meshes


def test_instanced_hair_is_there_once():
    cube = bpy.data.objects["Cube"]
    cube.location = (0.0, 0.0, 0.0)
    add_hair(cube)
    plain = curves_of(exported())["Cube"]
    stock = bpy.data.collections.new("Stock")
    stock.objects.link(cube)
    for collection in cube.users_collection:
        if collection != stock:
            collection.objects.unlink(cube)
    for k in range(3):
        empty = support.add_object(f"Copy {k}", None, (3.0 * k + 1.0, 0.0, 0.0))
        empty.instance_type, empty.instance_collection = "COLLECTION", stock
    data = exported_without_warnings()
    hair = curves_of(data)["Cube"]
    assert len(data.meshes) == 2
    group = next(g for g in data.instances if data.meshes[g.mesh] is hair)
    assert sorted(group.matrices[:, 0, 3]) == [1.0, 4.0, 7.0]
    assert np.allclose(hair.positions, plain.positions, atol=1e-5)


def test_hair_follows_a_mesh_that_deforms():
    cube = bpy.data.objects["Cube"]
    key = cube.shape_key_add(name="Basis")
    key = cube.shape_key_add(name="Up")
    for point in key.data:
        point.co.z += 4.0
    add_hair(cube)
    key.value = 1.0
    positions = curves_of(exported())["Cube"].positions.reshape(12, -1, 3)
    assert (positions[:, 0, 2] > 2.9).all()


def test_hair_curves():
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.object.curves_random_add()
    thing = bpy.context.object
    hair = curves_of(exported_without_warnings())[thing.name]
    assert len(hair.curve_offsets) == len(thing.data.curves) + 1
    assert hair.curve_offsets[-1] == len(thing.data.points) == len(hair.radii)
    point = thing.data.points[17]
    assert np.allclose(hair.positions[17], point.position)
    assert np.isclose(hair.radii[17], point.radius)


def test_point_clouds_of_geometry_nodes():
    from komorebi.scene_data import PointData

    cube = bpy.data.objects["Cube"]
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        for way in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    names = ("NodeGroupInput", "GeometryNodeMeshToPoints", "NodeGroupOutput")
    begin, points, end = (tree.nodes.new(name) for name in names)
    tree.links.new(begin.outputs[0], points.inputs["Mesh"])
    tree.links.new(points.outputs[0], end.inputs[0])
    points.inputs["Radius"].default_value = 0.25
    cube.modifiers.new("Points", "NODES").node_group = tree
    data = exported_without_warnings()
    (cloud,) = data.meshes
    assert isinstance(cloud, PointData)
    assert np.allclose(np.abs(cloud.positions), 1.0) and len(cloud.positions) == 8
    assert np.allclose(cloud.radii, 0.25)


def test_the_shape_is_cycles_setting():
    add_hair(bpy.data.objects["Cube"])
    settings = getattr(bpy.context.scene, "cycles_curves", None)
    if settings is None:
        raise support.Skip("Cycles is off")
    settings.shape, settings.subdivisions = "THICK", 3
    hair = curves_of(exported())["Cube"]
    assert (hair.shape, hair.subdivisions) == ("THICK", 3)
    if bpy.app.version >= (5, 0, 0):
        settings.shape = "THICK_LINEAR"
        assert curves_of(exported())["Cube"].shape == "THICK_LINEAR"


def test_poly_curves_are_straight_from_5_0_on():
    data = bpy.data.hair_curves.new("Wire")
    if not hasattr(data, "set_types"):
        raise support.Skip("curves have no types that a script can set in this release")
    data.add_curves([3, 2])
    data.attributes["position"].data.foreach_set("vector", np.arange(15, dtype=np.float32))
    support.add_object("Wire", data)
    for kind in ("CATMULL_ROM", "POLY"):
        data.set_types(type=kind)
        straight = kind == "POLY" and bpy.app.version >= (5, 0, 0)
        assert curves_of(exported())["Wire"].shape == ("THICK_LINEAR" if straight else "RIBBONS")


def test_hair_is_in_the_picture():
    cube = bpy.data.objects["Cube"]
    bald = support.exported_picture("Combined")
    add_hair(cube, count=400, length=2.0).radius_scale = 0.2
    hairy = support.exported_picture("Combined")
    assert (np.abs(hairy - bald) > 0.02).mean() > 0.2
