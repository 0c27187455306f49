"""What one frame leaves to the next: meshes that nobody touched are neither read nor built again."""

import contextlib

import bpy
import numpy as np
import support


def grid(name, side):
    y, x = np.mgrid[0:side, 0:side].astype(np.float32)
    vertices = np.stack([x, y, 0.1 * np.sin(x) * np.cos(y)], -1).reshape(-1, 3)
    vertices[:, :2] -= side / 2
    at = np.arange(side * side).reshape(side, side)
    faces = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], -1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return support.add_object(name, mesh)


def two_grids(persistent):
    scene = support.fresh_scene(size=(16, 12), samples=1)
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    scene.render.use_persistent_data = persistent
    return scene, grid("A", 24), grid("B", 20)


@contextlib.contextmanager
def counted():
    """How many meshes were read at all, read whole, and how many trees were built."""
    from komorebi import cache

    class Counts:
        touched = whole = built = 0

    from komorebi.export.mesh import MeshReader

    counts, misses = Counts(), cache.misses
    key, data = MeshReader.key, MeshReader.data

    def counted_key(reader, core):
        counts.touched += 1
        return key(reader, core)

    def counted_data(reader):
        counts.whole += 1
        return data(reader)

    MeshReader.key, MeshReader.data = counted_key, counted_data
    try:
        yield counts
    finally:
        MeshReader.key, MeshReader.data = key, data
    counts.built = cache.misses - misses


def render():
    bpy.ops.render.render()


def test_nothing_is_read_that_is_unchanged():
    from komorebi import cache

    scene, a, _ = two_grids(persistent=True)
    cache.clear()
    with counted() as first:
        render()
    assert (first.touched, first.whole, first.built) == (2, 2, 2)
    a.location.x += 1
    scene.camera.location.z += 1
    with counted() as moved:
        render()
    assert (moved.touched, moved.whole, moved.built) == (0, 0, 0)
    a.data.vertices[5].co.z = 2
    a.data.update()
    with counted() as changed:
        render()
    assert (changed.touched, changed.whole, changed.built) == (1, 1, 1)


def test_without_persistent_data_contents_decide():
    from komorebi import cache

    _, a, _ = two_grids(persistent=False)
    cache.clear()
    render()
    with counted() as again:
        render()
    assert (again.touched, again.whole, again.built) == (2, 0, 0), "known before normals are read"
    a.data.vertices[5].co.z = 2
    a.data.update()
    with counted() as changed:
        render()
    assert (changed.touched, changed.whole, changed.built) == (2, 1, 1)


def test_layers_take_turns():
    """Blender evaluates again what only the other layer shows: contents tell that it is the same."""
    scene, a, b = two_grids(persistent=True)
    for name, obj in (("One", a), ("Two", b)):
        collection = bpy.data.collections.new(name)
        scene.collection.children.link(collection)
        scene.collection.objects.unlink(obj)
        collection.objects.link(obj)
    second = scene.view_layers.new("Second")
    scene.view_layers[0].layer_collection.children["Two"].exclude = True
    second.layer_collection.children["One"].exclude = True
    render()
    with counted() as still:
        render()
    assert (still.whole, still.built) == (0, 0)
    b.data.vertices[0].co.z = 3
    b.data.update()
    with counted() as changed:
        render()
    assert (changed.whole, changed.built) == (1, 1)


def test_an_animated_mesh_is_never_an_old_one(folder):
    """A deformed mesh, a hidden one and one that takes another's place, against fresh renders."""
    scene, a, b = two_grids(persistent=True)
    wave = a.modifiers.new("Wave", "WAVE")
    wave.height, wave.time_offset = 2.0, -30.0
    for frame, hidden in ((1, False), (2, True), (3, False)):
        b.hide_render = hidden
        b.keyframe_insert("hide_render", frame=frame)
    kept, fresh = [], []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        kept.append(support.render(folder, f"kept{frame}"))
    scene.render.use_persistent_data = False
    from komorebi import cache

    for frame in (1, 2, 3):
        cache.clear()
        scene.frame_set(frame)
        fresh.append(support.render(folder, f"fresh{frame}"))
    for one, other in zip(kept, fresh, strict=True):
        assert np.array_equal(one, other)
    assert not np.array_equal(kept[0], kept[1])


def test_other_normals_are_seen_through_both_ways(folder):
    for persistent in (True, False):
        _, a, _ = two_grids(persistent)
        smooth = support.render(folder, "smooth")
        a.data.polygons.foreach_set("use_smooth", [False] * len(a.data.polygons))
        a.data.update()
        assert not np.array_equal(smooth, support.render(folder, "flat"))


def test_a_pass_that_is_switched_on_later_has_its_values(folder):
    _, a, b = two_grids(persistent=True)
    for obj in (a, b):
        obj.data.uv_layers.new(name="UV")
    render()
    bpy.context.view_layer.use_pass_uv = True
    channels, _ = support.render_layers(folder)
    assert channels["ViewLayer.UV.A"].max() == 1.0


def test_a_better_tree_is_built_of_what_the_core_has(folder):
    from komorebi import core, mesh_cache

    native = core.load()
    positions = np.random.default_rng(1).random((600, 3)).astype(np.float32)
    verts, offsets = np.arange(600, dtype=np.int32), np.arange(0, 603, 3, dtype=np.int32)
    mesh = native.Mesh("m", positions, verts, offsets, vertex_normals=positions, builder="LINEAR")
    other = mesh.rebuilt("SAH")
    assert other.primitive_count == mesh.primitive_count == 200
    direct = native.Mesh("m", positions, verts, offsets, vertex_normals=positions, builder="SAH")
    assert other.node_count == direct.node_count and other.byte_count == direct.byte_count
    assert mesh_cache.digest(native, (positions,)) == mesh_cache.digest(native, (positions.copy(),))
