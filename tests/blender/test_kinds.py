"""Kinds of geometry, as the dependency graph has them at the frame that is rendered."""

from pathlib import Path

import bpy
import numpy as np
import support

SCENES = Path(__file__).resolve().parents[2] / "blend_scenes"


def opened(name, frame=None):
    """The scene of that file, with our engine, small."""
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"), load_ui=False)
    scene = bpy.context.scene
    support.small(scene, size=(32, 18), samples=1)
    if frame is not None:
        scene.frame_set(frame)
    return scene


def matrices(data):
    """Object's name → matrices of its instances [instances, 4, 4]."""
    found = {}
    for group in data.instances:
        for index, matrix in zip(group.object_index, group.matrices, strict=True):
            found.setdefault(data.objects[index].name, []).append(matrix)
    return {name: np.array(rows) for name, rows in found.items()}


def spread(data, name):
    """Least and greatest coordinates of an object of one instance, in world space."""
    for group in data.instances:
        if data.objects[group.object_index[0]].name == name:
            mesh = data.meshes[group.mesh]
            if hasattr(mesh, "corner_verts"):
                at = mesh.positions @ group.matrices[0][:3, :3].T + group.matrices[0][:3, 3]
                return at.min(axis=0), at.max(axis=0), len(mesh.positions)
    raise AssertionError(f"{name} is not there")


def fresh(name, frame=None):
    opened(name, frame)
    return support.exported_whole()


def test_instancers():
    found = matrices(fresh("instancers"))
    assert len(found["On vertices"]) == 9 and len(found["On faces"]) == 4
    assert len(found["On the row"]) == 6, "one for each face of the array"
    assert "Faces" not in found and "Vertices" in found
    volumes = np.linalg.det(found["On faces"][:, :3, :3])
    assert volumes.max() > 1.2 * volumes.min() > 0, "scaled by the faces"
    stock = np.linalg.det(found["Stock"][:, :3, :3])
    assert len(stock) == 3 and (stock < 0).sum() == 1 and (stock > 0).sum() == 2


def test_particles_follow_their_flight():
    at_12 = matrices(fresh("particles", 12))
    assert len(at_12["Thing"]) > 100
    sizes = np.cbrt(np.abs(np.linalg.det(at_12["Thing"][:, :3, :3])))
    assert sizes.max() > 1.2 * sizes.min(), "sizes are random"
    turns = at_12["Thing"][:40, :3, 0] / np.linalg.norm(at_12["Thing"][:40, :3, 0], axis=1)[:, None]
    assert np.abs(turns.mean(axis=0)).max() < 0.8, "turned each in a way of its own"


def test_nested_nodes_are_the_same_realised():
    data = fresh("nested_nodes")
    found = matrices(data)
    instances = sum(len(rows) for name, rows in found.items() if name == "Base 0")
    assert instances == 2 * 9 * 5, "two copies of nine rings of five cones"
    low, high, vertices = spread(data, "Base 1")
    assert vertices == 9 * 5 * 6, "one mesh of all cones"
    assert (high > low).all()


def test_a_linked_collection_and_an_override():
    found = matrices(fresh("linked"))
    assert len(found["Stock"]) == 4
    assert len(found["On faces"]) == 4
    assert found["On faces"][:, 0, 3].mean() > 0.5, "where the override has moved it"


def test_deformed_at_its_frame():
    first, late = fresh("deforming", 1), fresh("deforming", 12)
    for name in ("Keys", "Bent"):
        (low, high, _), (low_late, high_late, _) = spread(first, name), spread(late, name)
        assert not np.allclose((low, high), (low_late, high_late), atol=0.05), name
    assert spread(late, "Subdivision")[2] == 6 * 4**2 + 2, "Simplify allows two levels of five"
    assert spread(late, "Multires")[2] == 6 * 4**2 + 2
    assert spread(late, "Skin")[2] > 200
    strands = [len(m.curve_offsets) - 1 for m in late.meshes if hasattr(m, "curve_offsets")]
    assert strands == [40 * 10], "half of twenty children for each of forty hairs"


def test_instances_without_size_show_nothing(folder):
    scene = bpy.context.scene
    scene.render.film_transparent = True
    plain = support.render(folder, "plain")
    cube = bpy.data.objects["Cube"]
    for k in range(4):
        copy = cube.copy()
        copy.location.x, copy.scale = 0.5 * k, (0, 0, 0)
        scene.collection.objects.link(copy)
    assert np.array_equal(plain, support.render(folder, "points"))


def test_instances_without_height_are_flat(folder):
    """As a mesh is that was flattened itself."""
    scene = bpy.context.scene
    scene.render.film_transparent = True
    cube = bpy.data.objects["Cube"]
    plain = support.render(folder, "plain")[:, :, 3]
    flat = cube.copy()
    flat.location, flat.scale = (0, 0, -1.5), (2, 2, 0)
    scene.collection.objects.link(flat)
    pixels = support.render(folder, "flat")
    assert np.isfinite(pixels).all()
    assert pixels[:, :, 3].sum() > 1.2 * plain.sum()
    flat.data, flat.scale = cube.data.copy(), (1, 1, 1)
    for vertex in flat.data.vertices:
        vertex.co = (2 * vertex.co.x, 2 * vertex.co.y, 0)
    truth = support.render(folder, "truth")
    assert np.abs(pixels[:, :, 3] - truth[:, :, 3]).max() < 1e-3


def test_adaptive_subdivision_is_named():
    scene = bpy.context.scene
    cube = bpy.data.objects["Cube"]
    modifier = cube.modifiers.new("Subdivision", "SUBSURF")
    modifier.render_levels = 3
    with support.warnings() as before:
        bpy.ops.render.render()
    if hasattr(scene.cycles, "feature_set"):  # up to 4.5
        scene.cycles.feature_set = "EXPERIMENTAL"
    holder = modifier if hasattr(modifier, "use_adaptive_subdivision") else cube.cycles
    holder.use_adaptive_subdivision = True
    with support.warnings() as after:
        data = support.exported_whole()
    assert not before
    assert after == [
        'object "Cube": adaptive subdivision is not rendered yet, it has the 3 levels of its modifier'
    ]
    assert data.meshes[0].primitive_count == 2 * 6 * 4**3


def test_overscan_is_named():
    scene = bpy.context.scene
    if not hasattr(scene.eevee, "use_overscan"):
        raise support.Skip("this release's EEVEE has no overscan")
    with support.warnings() as said:
        support.exported()
        assert not said
        scene.eevee.use_overscan = True
        support.exported()
    assert [s for s in said if "overscan" in s] == said and len(said) == 1, said
