"""How vertices are joined: recognised where it has stayed, told where it has not."""

import bpy
import numpy as np
import support


def meshes():
    """Of triangles alone, of quads, and of faces of all kinds."""
    from komorebi.compat import GENERIC_ATTRIBUTES

    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4)
    yield bpy.context.object.data
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=300, y_subdivisions=300)
    yield bpy.context.object.data
    bpy.ops.mesh.primitive_cylinder_add(vertices=9)
    yield bpy.context.object.data
    assert GENERIC_ATTRIBUTES == (bpy.app.version >= (3, 6, 0))


def test_a_moved_vertex_leaves_it_and_a_turned_corner_does_not():
    from komorebi.compat import Topology

    for mesh in meshes():
        known = Topology.of(mesh)
        mesh.vertices[0].co.z += 0.5
        assert Topology.of(mesh, known) is known, mesh
        assert Topology.of(mesh, None) is not known
        corner = mesh.loops[len(mesh.loops) - 2]  # not one that is looked at alone
        before, corner.vertex_index = corner.vertex_index, 0
        other = Topology.of(mesh, known)
        assert other is not known, mesh
        assert not known.equals(other)
        assert other.verts[-2] == 0
        corner.vertex_index = before
        assert Topology.of(mesh, known) is known


def test_other_faces_of_as_many_corners_are_told():
    from komorebi.compat import Topology

    def made(faces):
        mesh = bpy.data.meshes.new("Made")
        mesh.from_pydata([(np.cos(k), np.sin(k), 0.0) for k in range(7)], [], faces)
        return mesh

    known = Topology.of(made([(0, 1, 2), (3, 4, 5, 6)]))
    same, other = made([(0, 1, 2), (3, 4, 5, 6)]), made([(0, 1, 2, 3), (4, 5, 6)])
    assert Topology.of(same, known) is known
    found = Topology.of(other, known)
    assert found is not known
    assert np.array_equal(found.offsets, [0, 4, 7])
    assert Topology.of(made([(0, 1, 2)]), known) is not known


def test_a_deforming_mesh_is_recognised_from_its_second_change():
    """And none is remembered that has not changed."""
    from komorebi import compat

    scene = support.fresh_scene(size=(8, 6), samples=1)
    scene.render.use_persistent_data = True
    bpy.ops.mesh.primitive_monkey_add()
    mesh = bpy.context.object.data
    of, asked = compat.Topology.of, []

    def noted(read, known=None):
        found = of(read, known)
        asked.append((len(read.vertices), known is not None, found is known))
        return found

    compat.Topology.of = noted
    try:
        for step in range(4):
            asked.clear()
            bpy.ops.render.render()
            (monkey,) = (one for one in asked if one[0] == len(mesh.vertices))
            assert monkey[1:] == (step >= 2, step >= 2), (step, asked)
            mesh.vertices[0].co.x += 0.1
            mesh.update()
    finally:
        compat.Topology.of = of
