"""What every scene script shares: an empty file, meshes, cameras, worlds and saving.

Written for Blender 3.4, the oldest release that Komorebi supports, so that every later one opens
the files.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

FOLDER = Path(__file__).resolve().parent
Point = Sequence[float]


def empty_scene(width: int, height: int) -> bpy.types.Scene:
    """Start from a file with nothing in it but one scene of `width` × `height` pixels."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.cycles.max_bounces = 0
    return scene


def add_mesh(
    name: str, vertices: Sequence[Point], faces: Sequence[Sequence[int]], smooth: bool = False
) -> bpy.types.Object:
    """Link a mesh object made of `vertices` (metres, object space) and `faces` (vertex indices)."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    mesh.update()
    if smooth:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    return link(bpy.data.objects.new(name, mesh))


def link(
    thing: bpy.types.Object, collection: bpy.types.Collection | None = None
) -> bpy.types.Object:
    """Put an object into `collection`, or the scene's own, and hand it back."""
    (collection or bpy.context.scene.collection).objects.link(thing)
    return thing


def add_box(name: str, size: Point, centre: Point = (0.0, 0.0, 0.0)) -> bpy.types.Object:
    """An axis-parallel box, flat shaded; `size` holds the three edge lengths."""
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    vertices = [[c * s for c, s in zip(corner, size, strict=False)] for corner in corners]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    box = add_mesh(name, vertices, faces)
    box.location = centre
    return box


def add_rectangle(name: str, corner: Point, edge_u: Point, edge_v: Point) -> bpy.types.Object:
    """One quad from a corner and two edges; its normal is edge_u × edge_v."""
    origin, u, v = Vector(corner), Vector(edge_u), Vector(edge_v)
    return add_mesh(name, [origin, origin + u, origin + u + v, origin + v], [(0, 1, 2, 3)])


def add_sphere(
    name: str, radius: float, centre: Point, level: int = 7, smooth: bool = True
) -> bpy.types.Object:
    """A sphere of 6·4^level quads made by modifiers, so that the file stays small.

    Its vertices lie on the sphere; at level 7 the flat quads stay within 3e-5 radii of it.
    """
    box = add_box(name, (2.0, 2.0, 2.0), centre)
    box.data.polygons.foreach_set("use_smooth", [smooth] * 6)
    cut = box.modifiers.new("Cut", "SUBSURF")
    cut.subdivision_type, cut.levels, cut.render_levels = "SIMPLE", min(level, 4), level
    cast = box.modifiers.new("Round", "CAST")
    cast.cast_type, cast.factor, cast.use_radius_as_size, cast.size = "SPHERE", 1.0, False, radius
    return box


def add_camera(
    eye: Point,
    target: Point,
    lens: float = 35.0,
    ortho_scale: float | None = None,
    up: Point = (0, 0, 1),
) -> bpy.types.Object:
    """The scene's camera at `eye`, looking at `target`; orthographic when `ortho_scale` is
    given."""
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    if ortho_scale is not None:
        data.type, data.ortho_scale = "ORTHO", ortho_scale
    camera = link(bpy.data.objects.new("Camera", data))
    back = (Vector(eye) - Vector(target)).normalized()
    right = Vector(up).cross(back).normalized()
    axes = Matrix((right, back.cross(right), back)).transposed().to_4x4()
    camera.matrix_world = Matrix.Translation(Vector(eye)) @ axes
    bpy.context.scene.camera = camera
    return camera


def set_world(colour: Point = (1.0, 1.0, 1.0), strength: float = 1.0) -> bpy.types.World:
    """A uniform world through a Background node."""
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*colour, 1.0)
    background.inputs["Strength"].default_value = strength
    bpy.context.scene.world = world
    return world


def set_map(
    name: str, width: int, height: int, radiance: Callable[[float, float], Sequence[float]]
) -> None:
    """A world of a packed map; `radiance` gives the colour at column and row, 0 to 1."""
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    pixels: list[float] = []
    for row in range(height):
        for column in range(width):
            pixels += [*radiance((column + 0.5) / width, (row + 0.5) / height), 1.0]
    image.pixels.foreach_set(pixels)
    image.pack()
    tree = set_world().node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def save(name: str) -> Path:
    """Write `<name>.blend` beside this script, compressed and without a backup copy."""
    path = FOLDER / f"{name}.blend"
    bpy.context.preferences.filepaths.save_version = 0
    bpy.data.orphans_purge(do_recursive=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
    return path
