"""Blender's scene as arrays: what is there, how often, and how it is triangulated."""

import bpy
import numpy as np
import support


def counts(data):
    """Name of the object → number of its instances."""
    result = {}
    for group in data.instances:
        for index in group.object_index:
            name = data.objects[index].name
            result[name] = result.get(name, 0) + 1
    return result


def grid(name, side, size=2.0):
    coordinates = np.linspace(-size, size, side)
    verts = [(x, y, 0) for y in coordinates for x in coordinates]
    faces = [
        (y * side + x, y * side + x + 1, (y + 1) * side + x + 1, (y + 1) * side + x)
        for y in range(side - 1) for x in range(side - 1)
    ]  # fmt: skip
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(verts, [], faces)
    return mesh


def triangles_of_core(data):
    import komorebi_core as core

    return core.Mesh(
        data.name, data.positions, data.corner_verts, data.face_offsets,
        tri2corner=data.tri2corner, tri2face=data.tri2face, corner_normals=data.corner_normals,
        vertex_normals=data.vertex_normals, smooth_faces=data.smooth_faces,
        face_materials=data.face_materials,
    ).tri2corner()  # fmt: skip


def loop_triangles(mesh):
    mesh.calc_loop_triangles()
    result = np.empty(len(mesh.loop_triangles) * 3, np.int32)
    mesh.loop_triangles.foreach_get("loops", result)
    return result.reshape(-1, 3)


def test_dtypes_and_sharing():
    copy = bpy.data.objects["Cube"].copy()
    bpy.context.scene.collection.objects.link(copy)
    data = support.exported()
    assert len(data.meshes) == 1
    assert len(data.instances) == 1
    assert counts(data) == {"Cube": 1, "Cube.001": 1}
    assert [lamp.name for lamp in data.lamps] == ["Light"]


def test_arrays_are_what_the_core_wants():
    from komorebi.export.mesh import MeshReader

    bpy.data.objects["Cube"].data.polygons[0].use_smooth = True
    mesh = MeshReader(bpy.data.meshes["Cube"], "Cube").data()
    assert mesh.positions.dtype == np.float32
    assert mesh.positions.shape == (8, 3)
    assert mesh.corner_verts.dtype == np.int32
    assert mesh.corner_verts.shape == (24,)
    assert mesh.face_offsets.dtype == np.int32
    assert mesh.face_offsets[-1] == 24
    assert mesh.vertex_normals.dtype == np.float32
    assert mesh.vertex_normals.shape == (8, 3)
    assert mesh.corner_normals is None, "no corner differs from its vertex"
    assert mesh.smooth_faces.dtype == np.bool_
    assert mesh.smooth_faces.sum() == 1
    assert mesh.tri2corner is None
    assert mesh.face_materials is None


def test_same_arrays_through_every_route():
    """The fast ways of `compat` against the plain properties of vertices, loops and polygons."""
    from komorebi.export.mesh import MeshReader

    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object.data
    for index, polygon in enumerate(monkey.polygons):
        polygon.use_smooth = index % 3 == 0
        polygon.material_index = index % 2
    data = MeshReader(monkey, "Monkey").data()
    assert np.array_equal(data.positions, [v.co[:] for v in monkey.vertices])
    assert np.array_equal(data.corner_verts, [c.vertex_index for c in monkey.loops])
    assert np.array_equal(data.face_offsets[:-1], [p.loop_start for p in monkey.polygons])
    assert np.array_equal(np.diff(data.face_offsets), [p.loop_total for p in monkey.polygons])
    assert np.array_equal(data.smooth_faces, [p.use_smooth for p in monkey.polygons])
    assert np.array_equal(data.face_materials, [p.material_index for p in monkey.polygons])
    assert np.array_equal(data.vertex_normals, [n.vector[:] for n in monkey.vertex_normals])
    assert np.allclose(np.linalg.norm(data.vertex_normals, axis=1), 1, atol=1e-4)


def test_quads_are_split_as_blender_does():
    bpy.ops.mesh.primitive_monkey_add()
    mesh = bpy.context.object.data
    rng = np.random.default_rng(3)
    for vertex in mesh.vertices:  # bent and concave quads
        vertex.co = np.array(vertex.co) + rng.normal(0, 0.08, 3)
    from komorebi.export.mesh import MeshReader

    data = MeshReader(mesh, "Monkey").data()
    assert data.tri2corner is None
    assert np.array_equal(triangles_of_core(data), loop_triangles(mesh))


def test_ngons_come_from_blender():
    from komorebi.export.mesh import MeshReader

    mesh = bpy.data.meshes.new("Ngons")
    angles = np.linspace(0, 2 * np.pi, 10, endpoint=False)
    star = [(np.cos(a) * r, np.sin(a) * r, 0) for a, r in zip(angles, [1, 0.4] * 5, strict=True)]
    mesh.from_pydata([*star, (0, 0, 1)], [], [tuple(range(10)), (0, 1, 10), (2, 3, 4, 10)])
    data = MeshReader(mesh, "Ngons").data()
    assert np.array_equal(triangles_of_core(data), loop_triangles(mesh))
    assert len(data.tri2face) == 8 + 1 + 2


def test_collection_instances():
    inside = bpy.data.collections.new("Inside")
    inside.objects.link(bpy.data.objects["Cube"])
    for x in range(3):
        empty = support.add_object("Empty", None, (x * 3, 5, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", inside
    assert counts(support.exported()) == {"Cube": 4}


def test_vertex_and_face_instances_hide_the_instancer():
    cube = bpy.data.objects["Cube"]
    parent = support.add_object("Grid", grid("Grid", 5))
    cube.parent = parent
    parent.instance_type = "VERTS"
    parent.show_instancer_for_render = False
    assert counts(support.exported()) == {"Cube": 25}
    parent.instance_type = "FACES"
    parent.show_instancer_for_render = True
    assert counts(support.exported()) == {"Cube": 16, "Grid": 1}


def test_particles():
    plane = support.add_object("Plane", grid("Plane", 3))
    plane.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = plane.particle_systems[0].settings
    settings.type, settings.count = "HAIR", 40
    settings.render_type, settings.instance_object = "OBJECT", bpy.data.objects["Cube"]
    assert counts(support.exported()) == {"Cube": 41, "Plane": 1}


def test_geometry_nodes_instances():
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    if hasattr(tree, "interface"):
        tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    new, link = tree.nodes.new, tree.links.new
    start, end = new("NodeGroupInput"), new("NodeGroupOutput")
    scatter, shape = new("GeometryNodeInstanceOnPoints"), new("GeometryNodeMeshIcoSphere")
    link(start.outputs[0], scatter.inputs["Points"])
    link(shape.outputs["Mesh"], scatter.inputs["Instance"])
    link(scatter.outputs["Instances"], end.inputs[0])
    plane = support.add_object("Plane", grid("Plane", 6))
    plane.modifiers.new("Nodes", "NODES").node_group = tree
    data = support.exported()
    assert counts(data) == {"Cube": 1, "Plane": 36}
    assert len(data.meshes) == 2, "36 spheres are one mesh"


def test_modifiers_count_at_render_level():
    cube = bpy.data.objects["Cube"]
    modifier = cube.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 1, 3
    assert len(faces_of("Cube")) == 6 * 4**3


def faces_of(name):
    """Face sizes of the first mesh that reaches the core."""
    with support.captured("native_scene._native_mesh") as calls:
        support.exported()
    mesh = next(args[1] for args, _ in calls if args[1].name == name)
    return np.diff(mesh.face_offsets)


def test_edit_mode_is_seen():
    cube = bpy.data.objects["Cube"]
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    assert len(faces_of("Cube")) == 24


def test_hidden_in_renders_and_excluded():
    cube = bpy.data.objects["Cube"]
    cube.hide_render = True
    assert counts(support.exported()) == {}
    cube.hide_render = False
    cube.hide_viewport = True  # of no concern to a render
    assert counts(support.exported()) in ({"Cube": 1}, {})


def test_curves_text_surfaces_and_metaballs():
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.curve.primitive_bezier_circle_add()
    bpy.context.object.data.bevel_depth = 0.1
    bpy.ops.object.text_add()
    bpy.ops.surface.primitive_nurbs_surface_sphere_add()
    bpy.ops.object.metaball_add()
    bpy.ops.object.metaball_add(location=(1, 0, 0))
    bpy.ops.curve.primitive_bezier_curve_add()  # a line without surface
    found = counts(support.exported())
    circle = next(name for name in found if name.endswith("zierCircle"))  # "Bézier" from 4.5 on
    assert found == {circle: 1, "Text": 1, "SurfSphere": 1, "Mball": 1}, found


def test_instances_of_text_and_curves():
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.object.text_add()
    text = bpy.context.object
    parent = support.add_object("Grid", grid("Grid", 3))
    text.parent = parent
    parent.instance_type = "VERTS"
    parent.show_instancer_for_render = False
    assert counts(support.exported()) == {"Text": 9}


def test_text_is_the_surface_that_to_mesh_makes():
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.object.text_add()
    text = bpy.context.object
    text.data.extrude = 0.1
    mesh = text.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    assert len(faces_of("Text")) == len(mesh.polygons) > 0
    text.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh_clear()


def test_visibility_reaches_the_core():
    from komorebi import scene_data as sd

    cube = bpy.data.objects["Cube"]
    plain = support.exported().instances[0]
    assert plain.mask is None
    assert plain.flags is None
    cube.visible_camera = False
    cube.is_holdout = True
    group = support.exported().instances[0]
    assert group.mask[0] == sd.RAY_ALL & ~sd.RAY_CAMERA
    assert group.flags[0] == sd.FLAG_HOLDOUT


def test_mirrored_and_far_matrices():
    cube = bpy.data.objects["Cube"]
    cube.scale, cube.location = (-1, 2, 3), (1e4, -5, 2)
    matrix = support.exported().instances[0].matrices[0]
    assert np.allclose(matrix, np.array(cube.matrix_world)), matrix
    assert np.linalg.det(matrix[:3, :3]) < 0


def test_face_corners_anywhere():
    """Releases before 3.6 allow gaps: the order of faces wins."""
    from komorebi.compat import face_order

    offsets, order = face_order(np.array([7, 0, 4], np.int32), np.array([3, 4, 3], np.int32))
    assert offsets.tolist() == [0, 3, 7, 10]
    assert order.tolist() == [7, 8, 9, 0, 1, 2, 3, 4, 5, 6]
    assert order.dtype == offsets.dtype == np.int32


def test_structures_are_what_properties_say():
    """Of old releases: memory that is looked at, against what Blender reads item by item."""
    from komorebi.compat import GENERIC_ATTRIBUTES, structures

    if GENERIC_ATTRIBUTES:
        raise support.Skip("corners and faces are attributes")
    mesh = grid("faces", 6)
    mesh.polygons.foreach_set("use_smooth", [i % 3 == 0 for i in range(25)])
    mesh.polygons.foreach_set("material_index", [i % 4 for i in range(25)])
    for obj in (support.add_object("faces", mesh), bpy.data.objects["Cube"]):
        if obj.name == "faces":
            obj.modifiers.new("", "SOLIDIFY")
        mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
        corners, faces = structures.corners(mesh), structures.faces(mesh)
        for found, items, name in (
            (corners["vertex"], mesh.loops, "vertex_index"),
            (corners["edge"], mesh.loops, "edge_index"),
            (faces["start"], mesh.polygons, "loop_start"),
            (faces["total"], mesh.polygons, "loop_total"),
            (faces["flag"] & structures.SMOOTH, mesh.polygons, "use_smooth"),
        ):
            assert found.tolist() == [getattr(item, name) for item in items], name
    single = bpy.data.meshes.new("single")
    single.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    assert structures.faces(single) is None  # foreach_get is as good
    assert structures.faces(bpy.data.meshes.new("empty")) is None
