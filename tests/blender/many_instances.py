"""Scenes of very many instances of a triangle, of every kind of instancer that makes so many."""

import bpy
import numpy as np
import support

KINDS = ("nodes", "generated", "particles", "collections")


def make(kind, count, instancer_first):
    """An empty scene with about `count` instances in which an instancer is the first object, or a
    mesh that instances nothing. Returns the instanced object."""
    for obj in list(bpy.data.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    camera = bpy.data.objects["Camera"]
    for collection in camera.users_collection:
        collection.objects.unlink(camera)
    if not instancer_first:
        support.add_object("first", triangle("first"))
    small = bpy.data.objects.new("small", triangle("small"))
    MAKERS[kind](small, count)
    bpy.context.scene.collection.objects.link(camera)
    return small


def triangle(name):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)], [], [(0, 1, 2)])
    return mesh


def on_points(small, count):
    """Geometry nodes: an instance on each vertex of a cloud, with its own turn."""
    points = bpy.data.meshes.new("cloud")
    points.vertices.add(count)
    at = 10 * np.random.default_rng(1).random(3 * count, dtype=np.float32)
    points.vertices.foreach_set("co", at)
    cloud = support.add_object("cloud", points)
    bpy.context.scene.collection.objects.link(small)
    tree = bpy.data.node_groups.new("instances", "GeometryNodeTree")
    if hasattr(tree, "interface"):  # from 4.0
        for way in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = tree.nodes
    given, made = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    to_points = nodes.new("GeometryNodeMeshToPoints")
    place = nodes.new("GeometryNodeInstanceOnPoints")
    what = nodes.new("GeometryNodeObjectInfo")
    what.inputs["Object"].default_value = small
    what.inputs["As Instance"].default_value = True
    position = nodes.new("GeometryNodeInputPosition")
    tree.links.new(given.outputs[0], to_points.inputs[0])
    tree.links.new(to_points.outputs[0], place.inputs["Points"])
    tree.links.new(what.outputs["Geometry"], place.inputs["Instance"])
    tree.links.new(position.outputs[0], place.inputs["Rotation"])
    tree.links.new(place.outputs[0], made.inputs[0])
    cloud.modifiers.new("instances", "NODES").node_group = tree


def of_generated_mesh(small, count):
    """The same, of a mesh that the nodes make themselves, which is no object's own."""
    on_points(small, count)
    tree = bpy.data.node_groups["instances"]
    grid = tree.nodes.new("GeometryNodeMeshGrid")
    grid.inputs["Vertices X"].default_value = grid.inputs["Vertices Y"].default_value = 2
    place = next(node for node in tree.nodes if node.type == "INSTANCE_ON_POINTS")
    tree.links.new(grid.outputs["Mesh"], place.inputs["Instance"])


def as_particles(small, count):
    emitter = support.add_object("emitter", triangle("emitter"))
    bpy.context.scene.collection.objects.link(small)
    emitter.modifiers.new("particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count = count
    settings.frame_start = settings.frame_end = 1
    settings.physics_type = "NO"
    settings.render_type = "OBJECT"
    settings.instance_object = small
    settings.use_rotations = True
    settings.rotation_factor_random = 1.0
    bpy.context.scene.frame_set(2)


def in_collections(small, count):
    """Empties that each show a collection of as many objects as there are empties."""
    side = round(count**0.5)
    inner = bpy.data.collections.new("inner")
    inner.objects.link(small)
    for i in range(1, side):
        copy = bpy.data.objects.new(f"small {i}", small.data)
        copy.location.x = 0.2 * i
        inner.objects.link(copy)
    for i in range(side):
        empty = bpy.data.objects.new(f"empty {i}", None)
        empty.location.y = 0.2 * i
        empty.instance_type, empty.instance_collection = "COLLECTION", inner
        bpy.context.scene.collection.objects.link(empty)


MAKERS = {
    "nodes": on_points,
    "generated": of_generated_mesh,
    "particles": as_particles,
    "collections": in_collections,
}
