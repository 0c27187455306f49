"""Every way in which Blender makes copies, and what deforms meshes from frame to frame."""

from __future__ import annotations

import random
from collections.abc import Callable

import bpy
from common import (
    FOLDER,
    add_box,
    add_camera,
    add_mesh,
    add_sphere,
    empty_scene,
    link,
    save,
    set_world,
)
from features import copies, ground, hidden
from mathutils import Matrix, Vector
from strands import chain, node_tree

Object = bpy.types.Object


def wedge(name: str, size: float = 0.3) -> Object:
    """A body without any symmetry, so that every turn and mirror image shows."""
    corners = [(0, 0, 0), (1.6, 0, 0), (0, 1, 0), (0.2, 0.1, 1.2), (0.9, 0.3, 0.4)]
    faces = [(0, 2, 1), (0, 3, 2), (0, 1, 4), (0, 4, 3), (1, 2, 4), (2, 3, 4)]
    return add_mesh(name, [Vector(c) * size for c in corners], faces)


def tilted_grid(name: str, place: Matrix, side: int = 3) -> Object:
    """Faces of several sizes and directions."""
    rng = random.Random(5)
    spots = [
        (x * 0.45 + rng.uniform(-0.1, 0.1), y * 0.45 + rng.uniform(-0.1, 0.1), rng.uniform(0, 0.3))
        for y in range(side) for x in range(side)
    ]  # fmt: skip
    faces = [
        (y * side + x, y * side + x + 1, (y + 1) * side + x + 1, (y + 1) * side + x)
        for y in range(side - 1) for x in range(side - 1)
    ]  # fmt: skip
    grid = add_mesh(name, spots, faces)
    grid.matrix_world = place
    return grid


def instancers() -> None:
    """Copies on vertices (turned by the normal), on faces (with scale) and on faces of an array
    modifier; instances that are mirrored and sheared."""
    empty_scene(320, 180)
    ground()
    vertices = tilted_grid("Vertices", Matrix.Translation((-2.6, 0.0, 0.1)))
    vertices.instance_type, vertices.use_instance_vertices_rotation = "VERTS", True
    on_vertices = wedge("On vertices", 0.2)
    on_vertices.parent, on_vertices.scale = vertices, (0.8, 1.3, 1.0)
    stretch = Matrix.Diagonal((1.2, 0.7, 1.0, 1.0))
    faces = tilted_grid("Faces", Matrix.Translation((-1.0, 0.0, 0.1)) @ stretch)
    faces.instance_type, faces.use_instance_faces_scale = "FACES", True
    faces.instance_faces_scale, faces.show_instancer_for_render = 1.6, False
    wedge("On faces", 0.5).parent = faces
    row = tilted_grid("Row", Matrix.Translation((-2.2, 1.6, 0.1)), side=2)
    array = row.modifiers.new("Array", "ARRAY")
    array.count, array.relative_offset_displace = 6, (1.4, 0.0, 0.3)
    row.instance_type = "FACES"
    wedge("On the row", 0.3).parent = row
    stock = bpy.data.collections.new("Stock")
    hidden(wedge("Stock", 0.6), stock)
    for k, change in enumerate((
        Matrix.Scale(-1.0, 4, (1.0, 0.0, 0.0)),
        Matrix.Shear("XY", 4, (0.8, -0.3)),
        Matrix.Diagonal((-1.0, 1.0, -1.0, 1.0)) @ Matrix.Shear("XZ", 4, (0.5, 0.5)),
    )):  # fmt: skip
        lift = Matrix.Translation(
            (0.4 + 0.9 * (k % 3), -0.9 + 1.3 * (k // 3), 0.6 if k == 2 else 0.05)
        )
        # An object's own place cannot be sheared; its child's can.
        shear = add_mesh("Sheared", [], [])
        shear.matrix_world = lift
        inner = copies("Changed", stock, Matrix())
        inner.parent, inner.matrix_parent_inverse = shear, change
    add_camera((0.0, -4.6, 2.4), (0.0, 0.2, 0.25), lens=35.0)
    set_world()


def particles() -> None:
    """Particles as an object and as a collection (one by one, with counts), turned and of many
    sizes; and particles that fall, at a frame of their flight."""
    scene = empty_scene(320, 180)
    ground()
    stock = bpy.data.collections.new("Stock")
    thing = hidden(wedge("Thing", 0.25), stock)
    other = hidden(add_box("Other", (0.1, 0.2, 0.4)), stock)
    other.rotation_euler = (0.3, 0.2, 0.1)

    def system(name: str, x: float, kind: str, count: int) -> bpy.types.ParticleSettings:
        ball = add_sphere(name, 0.6, (x, 0.0, 0.7), level=3)
        ball.modifiers.new(name, "PARTICLE_SYSTEM")
        settings = ball.particle_systems[-1].settings
        settings.count, settings.render_type = count, kind
        settings.use_rotations, settings.rotation_mode = True, "NOR_TAN"
        settings.rotation_factor_random, settings.phase_factor_random = 0.3, 1.0
        settings.particle_size, settings.size_random = 0.8, 0.5
        settings.frame_start = settings.frame_end = 1
        settings.lifetime, settings.physics_type = 100, "NO"
        return settings

    one = system("One", -1.7, "OBJECT", 40)
    one.instance_object, one.use_rotation_instance, one.use_scale_instance = thing, True, True
    many = system("Many", 0.0, "COLLECTION", 40)
    many.instance_collection, many.use_collection_pick_random = stock, True
    fall = system("Fall", 1.7, "COLLECTION", 60)
    fall.instance_collection, fall.use_whole_collection = stock, True
    fall.physics_type, fall.normal_factor, fall.frame_end = "NEWTON", 1.5, 8
    scene.frame_start, scene.frame_end = 1, 12
    add_camera((0.0, -4.8, 2.2), (0.1, 0.0, 0.6), lens=35.0)
    set_world()
    scene.frame_set(12)
    bpy.ops.ptcache.bake_all(bake=True)  # into the file: physics goes from frame to frame


def nested_nodes() -> None:
    """Geometry nodes: instances in instances, the same realised, and sizes by an attribute."""
    empty_scene(320, 180)
    ground()
    for k, real in enumerate((False, True)):
        base = tilted_grid(f"Base {k}", Matrix.Translation((-2.3 + 2.6 * k, 0.0, 0.2)))
        base.data.attributes.new("Size", "FLOAT", "POINT").data.foreach_set(
            "value", [0.3 + 0.1 * i for i in range(9)]
        )
        tree = node_tree(base)
        last = ("GeometryNodeRealizeInstances",) if real else ()
        _, outer, *_ = chain(
            tree, "GeometryNodeMeshToPoints", "GeometryNodeInstanceOnPoints", *last
        )
        ring, cone, inner = (
            tree.nodes.new(f"GeometryNode{name}")
            for name in ("MeshCircle", "MeshCone", "InstanceOnPoints")
        )
        ring.inputs["Vertices"].default_value, ring.inputs["Radius"].default_value = 5, 0.35
        for name, value in (("Vertices", 5), ("Radius Bottom", 0.14), ("Depth", 0.5)):
            cone.inputs[name].default_value = value
        inner.inputs["Rotation"].default_value = (0.6, 0.2, 0.0)
        inner.inputs["Scale"].default_value = (1.0, -0.6, 1.0)
        tree.links.new(ring.outputs[0], inner.inputs["Points"])
        tree.links.new(cone.outputs[0], inner.inputs["Instance"])
        tree.links.new(inner.outputs[0], outer.inputs["Instance"])
        size = tree.nodes.new("GeometryNodeInputNamedAttribute")
        size.data_type = "FLOAT"
        size.inputs["Name"].default_value = "Size"
        tree.links.new(size.outputs[1], outer.inputs["Scale"])
        outer.inputs["Rotation"].default_value = (0.0, 0.3, 0.4)
        base.scale = (1.1, 1.1, 1.4)
    stock = bpy.data.collections.new("Stock")  # instances of what makes instances
    hidden(bpy.data.objects["Base 0"], stock)
    for x, scale in ((-1.9, 1.0), (2.2, -0.8)):
        turn = Matrix.Rotation(0.4 * x, 4, "Z") @ Matrix.Scale(scale, 4, (1.0, 0.0, 0.0))
        back = Matrix.Translation((2.3, 0.0, 0.0))  # from where the base stands to the middle
        copies("Again", stock, Matrix.Translation((x, -0.3, 0.0)) @ turn @ back)
    add_camera((0.3, -5.4, 2.6), (0.3, 0.2, 0.35), lens=35.0)
    set_world()


def linked() -> None:
    """Instances of a collection of another file (`instancers`), and a library override of an
    object of it, moved."""
    empty_scene(320, 180)
    ground()
    library = FOLDER / "instancers.blend"
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.collections, wanted.objects = ["Stock"], ["Faces", "On faces"]
    (stock,) = wanted.collections
    for k in range(4):
        turn = Matrix.Rotation(k, 4, "Z") @ Matrix.Scale(1.0 - 0.1 * k, 4)
        copies("Copy", stock, Matrix.Translation((-1.8 + 0.8 * k, 0.3 * k, 0.1)) @ turn)
    for thing in wanted.objects:
        own = thing.override_create(remap_local_usages=True)
        link(own)
    faces = next(o for o in bpy.data.objects if o.name == "Faces" and o.library is None)
    child = next(o for o in bpy.data.objects if o.name == "On faces" and o.library is None)
    child.parent = faces
    faces.location = (0.8, -0.2, 0.3)
    add_camera((0.2, -4.2, 2.2), (0.2, 0.0, 0.3), lens=35.0)
    set_world()
    save("linked")
    bpy.ops.file.make_paths_relative()


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (instancers, particles, nested_nodes, linked)
}
