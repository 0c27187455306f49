"""Named arrays that materials ask for, against Blender's own."""

import contextlib
from dataclasses import replace

import bpy
import numpy as np
from test_export import grid
from test_strands import add_hair, curves_of, exported

NAMES = {
    "generated", "uv:", "uv:Second", "tangent:", "tangent:Second", "color:", "Bytes", "Floats",
    "number", "whole", "small", "flag", "vector", "pair", "by_edge", "absent",
}  # fmt: skip


def numbers(count, columns):
    return np.random.default_rng(count).random((count, columns), np.float32)


def fill(attribute, name, values):
    attribute.data.foreach_set(name, values.ravel())
    return values


def made(mesh):
    """A mesh with attributes of every kind, and what each of them should come out as."""
    verts, corners, faces = len(mesh.vertices), len(mesh.loops), len(mesh.polygons)
    add = mesh.attributes.new
    expected = {}
    for name in ("UVMap", "Second"):
        layer = mesh.uv_layers.new(name=name)
        values = numbers(corners, 2) if name == "Second" else numbers(corners, 2)[:, ::-1].copy()
        layer.data.foreach_set("uv", values.ravel())
        expected["uv:" if name == "UVMap" else f"uv:{name}"] = ("CORNER", values)
    mesh.uv_layers["UVMap"].active_render = True
    floats = numbers(verts, 4)
    color = mesh.color_attributes.new(name="Floats", type="FLOAT_COLOR", domain="POINT")
    expected["Floats"] = ("POINT", fill(color, "color", floats))
    color = mesh.color_attributes.new(name="Bytes", type="BYTE_COLOR", domain="CORNER")
    srgb = np.round(numbers(corners, 4) * 255).astype(np.float32) / 255
    color.data.foreach_set("color_srgb", srgb.ravel())
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    linear[:, 3] = srgb[:, 3]
    expected["Bytes"] = expected["color:"] = ("CORNER", linear)
    mesh.color_attributes.render_color_index = list(mesh.color_attributes.keys()).index("Bytes")
    expected["number"] = ("FACE", fill(add("number", "FLOAT", "FACE"), "value", numbers(faces, 1)))
    whole = np.arange(verts, dtype=np.int32).reshape(-1, 1) - 3
    expected["whole"] = ("POINT", fill(add("whole", "INT", "POINT"), "value", whole))
    small = (np.arange(corners) % 100 - 50).astype(np.int8).reshape(-1, 1)
    expected["small"] = ("CORNER", fill(add("small", "INT8", "CORNER"), "value", small))
    flag = (np.arange(faces) % 3 == 0).reshape(-1, 1)
    expected["flag"] = ("FACE", fill(add("flag", "BOOLEAN", "FACE"), "value", flag))
    vector = fill(add("vector", "FLOAT_VECTOR", "CORNER"), "vector", numbers(corners, 3))
    expected["vector"] = ("CORNER", vector)
    expected["pair"] = ("POINT", fill(add("pair", "FLOAT2", "POINT"), "vector", numbers(verts, 2)))
    add("by_edge", "FLOAT", "EDGE")
    return expected


def read(mesh, names=NAMES):
    from komorebi.export.mesh import MeshReader

    reader = MeshReader(mesh, "sheet", attributes=names)
    return reader, reader.data().attributes


def test_every_kind_and_domain():
    mesh = grid("sheet", 6)
    expected = made(mesh)
    reader, attributes = read(mesh)
    for name, (domain, values) in expected.items():
        assert attributes[name].domain == domain, name
        assert attributes[name].values.dtype == np.float32, name
        assert attributes[name].values.shape == values.shape, name
        assert np.allclose(attributes[name].values, values, atol=1e-6), name
    assert reader.problems == ['attribute "by_edge" is by edge']
    assert set(attributes) == NAMES - {"by_edge", "absent"}


def test_tangents_point_along_u():
    mesh = grid("sheet", 6)
    made(mesh)
    flat = np.array([v.co[:2] for v in mesh.vertices], np.float32)
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    turned = flat[corners] @ np.array([[0, 1], [1, 0]], np.float32)  # u along y, and mirrored
    mesh.uv_layers["UVMap"].data.foreach_set("uv", turned.ravel())
    tangents = read(mesh)[1]["tangent:"]
    assert tangents.domain == "CORNER"
    assert np.allclose(tangents.values, [0, 1, 0, -1], atol=1e-5)


def test_no_tangents_of_large_faces():
    bpy.ops.mesh.primitive_circle_add(vertices=7, fill_type="NGON", calc_uvs=True)
    reader, attributes = read(bpy.context.object.data, {"tangent:", "uv:"})
    assert set(attributes) == {"uv:"}
    assert len(reader.problems) == 1
    assert "more than four corners" in reader.problems[0]


def test_generated_coordinates_stay_where_the_mesh_was():
    """Modifiers that deform do not move them; texture space is the bounds, or what was set."""
    bpy.ops.mesh.primitive_uv_sphere_add(radius=2.0)
    obj = bpy.context.object
    mesh = obj.data
    positions = np.array([v.co for v in mesh.vertices], np.float32)
    bend = obj.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle = "BEND", 1.0
    obj.modifiers.new("More", "SUBSURF").levels = 0

    def evaluated():
        depsgraph = bpy.context.evaluated_depsgraph_get()
        return read(obj.evaluated_get(depsgraph).data, {"generated"})[1]["generated"]

    # Only an evaluation for renders keeps where vertices were.
    assert np.allclose(
        read(mesh, {"generated"})[1]["generated"].values, (positions + 2) / 4, atol=1e-6
    )
    assert evaluated().domain == "POINT"
    mesh.use_auto_texspace = False
    mesh.texspace_location = (1, 0, 0)
    mesh.texspace_size = (1, 2, 4)
    own = read(mesh, {"generated"})[1]["generated"].values
    wanted = (positions - [1, 0, 0]) / [2, 4, 8] + 0.5
    assert np.allclose(own, wanted, atol=1e-6)


class _Probe(bpy.types.RenderEngine):
    """Sees what a render does: meshes as they are evaluated for it."""

    bl_idname = "KOMOREBI_TEST_ATTRIBUTES"
    bl_label = "Attributes"
    seen = None

    def render(self, depsgraph):
        for obj in depsgraph.objects:
            if obj.type == "MESH":
                data = read(obj.data, {"generated"})[1]["generated"]
                _Probe.seen = (data.values, np.array([v.co for v in obj.data.vertices]))


def test_generated_coordinates_in_a_render():
    for obj in list(bpy.data.objects):
        if obj.type == "MESH":
            bpy.data.objects.remove(obj)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=2.0)
    obj = bpy.context.object
    positions = np.array([v.co for v in obj.data.vertices], np.float32)
    bend = obj.modifiers.new("Bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle = "BEND", 1.0
    bpy.utils.register_class(_Probe)
    try:
        bpy.context.scene.render.engine = _Probe.bl_idname
        bpy.ops.render.render()
    finally:
        bpy.context.scene.render.engine = "KOMOREBI"
        bpy.utils.unregister_class(_Probe)
    generated, moved = _Probe.seen
    assert not np.allclose(moved, positions, atol=0.1), "the modifier does something"
    assert np.allclose(generated, (positions + 2) / 4, atol=1e-5)


def test_keys_tell_attributes_apart():
    import komorebi_core as core
    from komorebi.export.mesh import MeshReader

    mesh = grid("sheet", 6)
    made(mesh)

    def key(names):
        return MeshReader(mesh, "sheet", attributes=names).key(core)

    plain, named = key(set()), key({"number"})
    assert plain.geometry == named.geometry
    assert (
        len({plain.shading, named.shading, key({"tangent:"}).shading, key({"pair"}).shading}) == 4
    )
    mesh.attributes["number"].data[3].value = 7.0
    assert key({"number"}).shading != named.shading
    assert key(set()).shading == plain.shading
    before = key({"tangent:"}).shading
    mesh.uv_layers["UVMap"].data[0].uv = (3, 4)
    assert key({"tangent:"}).shading != before


def test_objects_get_what_their_materials_ask_for():
    """Through the whole export, to the core's meshes."""
    from komorebi.export import instance
    from komorebi.export.wanted import Wanted
    from komorebi.scene_data import SceneData
    from komorebi.unchanged import Unchanged

    mesh = bpy.data.objects["Cube"].data
    mesh.attributes.new("number", "FLOAT", "FACE")
    mesh.attributes.new("by_edge", "FLOAT", "EDGE")
    copy = bpy.data.objects["Cube"].copy()
    copy.name = "Other"
    bpy.context.scene.collection.objects.link(copy)
    said = []

    class Engine:
        is_preview = False

        def test_break(self):
            return False

        def report(self, kinds, text):
            said.append(text)

    names = {"Cube": frozenset({"number", "by_edge"}), "Other": frozenset()}
    wanted = replace(Wanted(), attributes_of=lambda obj: names[obj.name])
    depsgraph = bpy.context.evaluated_depsgraph_get()
    data = SceneData({}, None)
    instance.export_instances(Engine(), depsgraph, data, wanted, Unchanged())
    assert sorted(list(m.attributes) for m in data.meshes) == [[], ["number"]]
    assert said == [
        'Komorebi: object "Cube": attribute "by_edge" is by edge: materials have 0 in its place'
    ]


@contextlib.contextmanager
def wanting(*names):
    """Every material asks for attributes of these names."""
    from komorebi.export.wanted import Wanted

    original = Wanted.by
    Wanted.by = staticmethod(
        lambda sources: replace(original(sources), attributes_of=lambda _: frozenset(names))
    )
    try:
        yield
    finally:
        Wanted.by = original


def test_hair_has_the_uvs_of_its_roots():
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=2.0)
    obj = bpy.context.object
    mesh = obj.data
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    places = np.array([v.co[:2] for v in mesh.vertices], np.float32)[corners]
    mesh.uv_layers.new(name="Second").data.foreach_set("uv", (3.0 * places).ravel())
    add_hair(obj, count=20)
    with wanting("uv:", "uv:Second", "absent"):
        hair = curves_of(exported())[obj.name]
    roots = hair.positions[hair.curve_offsets[:-1], :2]
    assert {name: a.domain for name, a in hair.attributes.items()} == {
        "uv:Second": "CURVE", "uv:": "CURVE"
    }  # fmt: skip
    assert np.allclose(hair.attributes["uv:Second"].values, 3.0 * roots, atol=1e-3)
    assert np.allclose(hair.attributes["uv:"].values, 0.5 + 0.5 * roots, atol=1e-3)


def test_hair_curves_have_attributes():
    bpy.ops.object.curves_random_add()
    thing = bpy.context.object
    new, points, curves = thing.data.attributes.new, len(thing.data.points), len(thing.data.curves)
    by_point = fill(new("key", "FLOAT", "POINT"), "value", numbers(points, 1))
    by_curve = fill(new("strand", "FLOAT_VECTOR", "CURVE"), "vector", numbers(curves, 3))
    with wanting("key", "strand", "absent"):
        fur = curves_of(exported())[thing.name]
    assert fur.attributes["key"].domain == "POINT"
    assert fur.attributes["strand"].domain == "CURVE"
    assert np.array_equal(fur.attributes["key"].values, by_point)
    assert np.array_equal(fur.attributes["strand"].values, by_curve)
