"""Hair of particle systems, hair curves and point clouds."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import bpy
from common import add_camera, add_mesh, add_sphere, empty_scene, link, set_world
from features import copies, ground, hidden
from mathutils import Matrix, Vector


def add_hair(thing: bpy.types.Object, name: str, count: int, length: float) -> bpy.types.Any:
    """A particle system of hair on `thing`; its settings."""
    thing.modifiers.new(name, "PARTICLE_SYSTEM")
    settings = thing.particle_systems[-1].settings
    settings.type, settings.count, settings.hair_length, settings.hair_step = (
        "HAIR",
        count,
        length,
        4,
    )
    settings.render_step = settings.display_step = 3
    return settings


def hair_particles() -> None:
    """Two systems on one ball, one with children; a collection with hair, instanced; a stretched
    emitter that is not shown itself, of B-splines; and hair on a mesh that an armature bends."""
    scene = empty_scene(320, 180)
    ground()
    ball = add_sphere("Ball", 0.5, (-1.3, 0.0, 0.5), level=3)
    coarse = add_hair(ball, "Coarse", 60, 0.5)
    coarse.root_radius, coarse.tip_radius, coarse.radius_scale = 1.0, 0.3, 0.06
    coarse.factor_random = 0.15
    fine = add_hair(ball, "Fine", 60, 0.25)
    fine.child_type, fine.rendered_child_count = "INTERPOLATED", 20
    fine.root_radius, fine.tip_radius, fine.radius_scale, fine.shape = 1.0, 0.0, 0.02, 0.4
    stock = bpy.data.collections.new("Stock")
    tuft = hidden(add_sphere("Tuft", 0.2, (0.0, 0.0, 0.2), level=2), stock)
    simple = add_hair(tuft, "Simple", 30, 0.3)
    simple.child_type, simple.rendered_child_count = "SIMPLE", 10
    simple.child_radius, simple.radius_scale, simple.use_close_tip = 0.1, 0.03, True
    for k in range(4):
        turn = Matrix.Rotation(0.9 * k, 4, "Z") @ Matrix.Scale(0.7 + 0.2 * k, 4)
        copies("Tufts", stock, Matrix.Translation((-0.4 + 0.6 * k, -0.9 + 0.2 * k, 0.0)) @ turn)
    stretch = Matrix.Diagonal((2.0, 0.5, 1.4, 1.0)) @ Matrix.Rotation(0.5, 4, "X")
    copies("Stretched", stock, Matrix.Translation((1.8, -1.2, 0.0)) @ stretch)
    patch = add_mesh("Patch", [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)])
    patch.matrix_world = Matrix.Translation((1.5, 0.4, 0.3)) @ Matrix.Diagonal((0.6, 0.3, 1.0, 1.0))
    patch.show_instancer_for_render = False
    curly = add_hair(patch, "Curly", 120, 0.6)
    curly.use_hair_bspline, curly.radius_scale, curly.brownian_factor = True, 0.04, 0.08
    bent = add_mesh(
        "Bent",
        [(x, y, z) for z in (0.0, 0.5, 1.0) for x, y in ((0, 0), (0.4, 0), (0.4, 0.4), (0, 0.4))],
        [(4 * r + a, 4 * r + (a + 1) % 4, 4 * r + 4 + (a + 1) % 4, 4 * r + 4 + a)
         for r in range(2) for a in range(4)],
    )  # fmt: skip
    bent.location = (0.1, 1.2, 0.0)
    bones = link(bpy.data.objects.new("Bones", bpy.data.armatures.new("Bones")))
    bones.location = (0.3, 1.4, 0.0)
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    bone = bones.data.edit_bones.new("Tip")
    bone.head, bone.tail = (0.0, 0.0, 0.4), (0.0, 0.0, 1.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    bones.pose.bones["Tip"].rotation_mode = "XYZ"
    bones.pose.bones["Tip"].rotation_euler = (0.0, 0.0, 0.7)
    group = bent.vertex_groups.new(name="Tip")
    group.add(list(range(4, 12)), 1.0, "REPLACE")
    bend = bent.modifiers.new("Armature", "ARMATURE")
    bend.object = bones
    short = add_hair(bent, "Short", 150, 0.15)
    short.radius_scale = 0.02
    add_camera((0.4, -4.6, 2.0), (0.1, 0.2, 0.45), lens=40.0)
    set_world()
    scene.cycles_curves.shape = "RIBBONS"


def node_tree(thing: bpy.types.Object) -> bpy.types.NodeTree:
    """Empty geometry nodes on `thing`, with one geometry in and one out."""
    tree = bpy.data.node_groups.new(thing.name, "GeometryNodeTree")
    tree.inputs.new("NodeSocketGeometry", "Geometry")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    thing.modifiers.new("Nodes", "NODES").node_group = tree
    return tree


def chain(tree: bpy.types.NodeTree, *kinds: str) -> list[bpy.types.Node]:
    """Nodes of these kinds between input and output, each first output into the first input."""
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", *kinds, "NodeGroupOutput")]
    for before, after in pairwise(nodes):
        tree.links.new(before.outputs[0], after.inputs[0])
    return nodes[1:-1]


def hair_curves() -> None:
    """A hair curves object whose nodes set the radius; and a mesh whose geometry nodes make curves
    beside its own faces, which Blender hands on as legacy curves: no engine draws them."""
    empty_scene(320, 180)
    ground()
    bpy.ops.object.curves_random_add()
    wild = bpy.context.object
    wild.matrix_world = Matrix.Translation((-1.1, 0.0, 0.9)) @ Matrix.Scale(0.9, 4)
    (radius,) = chain(node_tree(wild), "GeometryNodeSetCurveRadius")
    radius.inputs["Radius"].default_value = 0.006
    ball = add_sphere("Ball", 0.5, (1.2, 0.0, 0.7), level=3)
    tree = node_tree(ball)
    spread, put, _real, radius, join = chain(
        tree, "GeometryNodeDistributePointsOnFaces", "GeometryNodeInstanceOnPoints",
        "GeometryNodeRealizeInstances", "GeometryNodeSetCurveRadius", "GeometryNodeJoinGeometry",
    )  # fmt: skip
    spread.inputs["Density"].default_value = 150.0
    line = tree.nodes.new("GeometryNodeCurveSpiral")
    for name, value in (
        ("Resolution", 12), ("Rotations", 1.0), ("Start Radius", 0.02), ("End Radius", 0.06),
        ("Height", 0.4),
    ):  # fmt: skip
        line.inputs[name].default_value = value
    tree.links.new(line.outputs[0], put.inputs["Instance"])
    tree.links.new(spread.outputs["Rotation"], put.inputs["Rotation"])
    radius.inputs["Radius"].default_value = 0.008
    tree.links.new(tree.nodes["Group Input"].outputs[0], join.inputs[0])
    add_camera((0.2, -5.2, 2.2), (0.1, 0.0, 0.65), lens=40.0)
    set_world()


def point_cloud() -> None:
    """Spheres of many sizes by geometry nodes, one object's of them instanced and stretched."""
    empty_scene(320, 180)
    ground()
    stock = bpy.data.collections.new("Stock")
    places = [
        (add_sphere("Cloud", 0.8, (-1.2, 0.0, 1.0), level=3), 60.0, 0.02, 0.12),
        (hidden(add_sphere("Small", 0.4, (0.0, 0.0, 0.5), level=3), stock), 200.0, 0.01, 0.05),
    ]
    for thing, density, least, most in places:
        tree = node_tree(thing)
        spread, radius = chain(
            tree, "GeometryNodeDistributePointsOnFaces", "GeometryNodeSetPointRadius"
        )
        spread.inputs["Density"].default_value = density
        size = tree.nodes.new("FunctionNodeRandomValue")
        size.inputs[2].default_value, size.inputs[3].default_value = least, most
        tree.links.new(size.outputs[1], radius.inputs["Radius"])
    copies("Turned", stock, Matrix.Translation(Vector((0.6, 0.0, 0.1))))
    stretch = Matrix.Diagonal((0.6, 1.0, 1.6, 1.0))
    copies("Stretched", stock, Matrix.Translation(Vector((1.6, 0.3, 0.1))) @ stretch)
    add_camera((0.2, -5.2, 2.2), (0.1, 0.0, 0.7), lens=40.0)
    set_world()


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (hair_particles, hair_curves, point_cloud)
}
