"""Scenes that hold one kind of setting each: shading, view layers, border, cameras, small and
large scales."""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
from common import (
    add_box,
    add_camera,
    add_mesh,
    add_rectangle,
    add_sphere,
    empty_scene,
    link,
    set_map,
    set_world,
)
from mathutils import Matrix, Vector


def wavy(name: str, at: tuple[float, float, float], smooth: bool) -> bpy.types.Object:
    """A drum of twelve sides with a lid: its edges show how normals are shared."""
    sides = 12
    ring = [(math.cos(math.tau * k / sides), math.sin(math.tau * k / sides)) for k in range(sides)]
    vertices = [(0.7 * x, 0.7 * y, z) for z in (0.0, 0.9) for x, y in ring]
    faces: list[tuple[int, ...]] = [
        (k, (k + 1) % sides, sides + (k + 1) % sides, sides + k) for k in range(sides)
    ]
    faces.append(tuple(range(sides, 2 * sides)))
    thing = add_mesh(name, vertices, faces, smooth)
    thing.location = at
    return thing


def shading() -> None:
    """Flat, smooth, auto smooth, partly smooth and marked-sharp drums side by side, and one with
    set normals."""
    empty_scene(320, 160)
    add_rectangle("Ground", (-20.0, -20.0, 0.0), (40.0, 0.0, 0.0), (0.0, 40.0, 0.0))
    wavy("Flat", (-4.5, 0.0, 0.0), False)
    wavy("Smooth", (-2.7, 0.0, 0.0), True)
    auto = wavy("Auto smooth", (-0.9, 0.0, 0.0), True)
    auto.data.use_auto_smooth, auto.data.auto_smooth_angle = True, math.radians(40.0)
    part = wavy("Lid flat", (0.9, 0.0, 0.0), True)
    part.data.polygons[-1].use_smooth = False
    sharp = wavy("Sharp edges", (2.7, 0.0, 0.0), True)
    for edge in sharp.data.edges:
        edge.use_edge_sharp = all(v >= 12 for v in edge.vertices)
    set_by_hand = wavy("Set normals", (4.5, 0.0, 0.0), True)
    mesh = set_by_hand.data
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    up = [
        (mesh.vertices[loop.vertex_index].co.normalized() + Vector((0.0, 0.0, 0.5))).normalized()
        for loop in mesh.loops
    ]
    mesh.normals_split_custom_set(up)
    add_camera((0.0, -9.0, 4.5), (0.0, 0.0, 0.3), lens=30.0)
    set_world()


def view_layers() -> None:
    """Two view layers, each without the other's collection: a ball in one, a box in the other."""
    scene = empty_scene(240, 160)
    add_rectangle("Ground", (-9.0, -9.0, 0.0), (18.0, 0.0, 0.0), (0.0, 18.0, 0.0))
    scene.view_layers[0].name = "Ball"
    other = scene.view_layers.new("Box")
    for name, thing in (
        ("Ball", add_sphere("Ball", 0.8, (-0.6, 0.0, 0.8), level=5)),
        ("Box", add_box("Box", (1.2, 1.2, 1.2), (0.7, 0.0, 0.6))),
    ):
        collection = bpy.data.collections.new(name)
        scene.collection.children.link(collection)
        scene.collection.objects.unlink(thing)
        link(thing, collection)
    scene.view_layers["Ball"].layer_collection.children["Box"].exclude = True
    other.layer_collection.children["Ball"].exclude = True
    add_camera((2.5, -5.0, 3.0), (0.0, 0.0, 0.5))
    set_world()


def steps_and_ball() -> None:
    """Something with no symmetry to point a camera at."""
    add_rectangle("Ground", (-30.0, -30.0, 0.0), (60.0, 0.0, 0.0), (0.0, 60.0, 0.0))
    for k in range(5):
        add_box(f"Step {k}", (1.0, 0.4, 0.2 * (k + 1)), (-0.5, 0.4 * k, 0.1 * (k + 1)))
    add_sphere("Ball", 0.5, (0.8, 0.2, 0.5), level=5)


def border() -> None:
    """A render border that crops, with a shifted lens and pixels that are not square."""
    scene = empty_scene(320, 200)
    steps_and_ball()
    camera = add_camera((3.0, -4.0, 2.5), (0.2, 0.5, 0.5), lens=42.0)
    camera.data.shift_x, camera.data.shift_y = 0.12, -0.07
    scene.render.pixel_aspect_x = 1.4
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.21, 0.83
    scene.render.border_min_y, scene.render.border_max_y = 0.13, 0.77
    set_world()


def orthographic() -> None:
    """An orthographic camera with vertical fit, clipping that cuts the scene, and a transparent
    film."""
    scene = empty_scene(180, 240)
    steps_and_ball()
    camera = add_camera((3.0, -4.0, 2.5), (0.2, 0.5, 0.5), ortho_scale=3.2)
    camera.data.sensor_fit, camera.data.clip_start, camera.data.clip_end = "VERTICAL", 4.2, 8.0
    scene.render.film_transparent = True
    set_world((0.7, 0.8, 1.0), 1.5)


def scaled(factor: float, offset: float) -> None:
    """The same things `factor` times as large, `offset` metres away from the origin along each
    axis."""
    empty_scene(240, 160)
    steps_and_ball()
    camera = add_camera((3.0, -4.0, 2.5), (0.2, 0.5, 0.5))
    camera.data.clip_start, camera.data.clip_end = 0.1 * factor, 100.0 * factor
    move = Matrix.Translation((offset, offset, offset)) @ Matrix.Scale(factor, 4)
    for thing in bpy.context.scene.objects:
        place = move @ Matrix.LocRotScale(thing.location, thing.rotation_euler, None)
        thing.matrix_world = (
            Matrix.LocRotScale(place.translation, thing.rotation_euler, None)
            if thing.type == "CAMERA"
            else place
        )
    set_world()


def tiny() -> None:
    """Everything a thousand times smaller: no distance in the tracer is absolute."""
    scaled(1e-3, 0.0)


def huge() -> None:
    """Everything a thousand times larger."""
    scaled(1e3, 0.0)


def far_away() -> None:
    """Ten kilometres from the origin along every axis: world space must start elsewhere."""
    scaled(1.0, 1e4)


def shadow_terminator() -> None:
    """Coarse smooth balls in low sunlight, each with other shadow terminator offsets; one is
    larger and mirrored."""
    empty_scene(320, 160)
    add_rectangle("Floor", (-6.0, -6.0, 0.0), (12.0, 0.0, 0.0), (0.0, 12.0, 0.0))
    kinds = (
        (0.1, 0.0, (1.0, 1.0, 1.0)), (0.0, 0.0, (1.0, 1.0, 1.0)), (0.6, 0.0, (1.0, 1.0, 1.0)),
        (0.0, 0.7, (1.0, 1.0, 1.0)), (0.1, 0.2, (-1.2, 1.2, 1.2)),
    )  # fmt: skip
    for i, (geometry, shading, scale) in enumerate(kinds):
        bpy.ops.mesh.primitive_uv_sphere_add(
            segments=10, ring_count=6, radius=0.55, location=(1.3 * (i - 2), 0.0, 0.9)
        )
        ball = bpy.context.object
        ball.scale = scale
        ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
        ball.cycles.shadow_terminator_geometry_offset = geometry
        ball.cycles.shadow_terminator_offset = shading
    sun = (40.5 / 64, 19.5 / 32)
    set_map("Low sun", 64, 32, lambda *at: (150, 130, 100) if at == sun else (0.2, 0.3, 0.4))
    add_camera((0.0, -6.0, 2.4), (0.0, 0.0, 0.8), lens=36.0)


def coarse_ball(name: str, place: Matrix) -> bpy.types.Object:
    """A ball of few smooth faces, so that it shows where normals are interpolated."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=6, ring_count=4, radius=0.6)
    ball = bpy.context.object
    ball.name, ball.matrix_world = name, place
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    return ball


def stretched() -> None:
    """Coarse smooth balls, stretched, mirrored and sheared; two that share their mesh, one that
    owns its corner normals, and one that is partly flat; the sky is brighter on one side."""
    empty_scene(320, 160)
    tilt = Matrix.Rotation(0.6, 4, "Y") @ Matrix.Rotation(0.4, 4, "X")
    shear = Matrix(((1.0, 0.9, 0.2, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.4, 1.0, 0.0), (0, 0, 0, 1)))

    def size(x: float, y: float, z: float) -> Matrix:
        return tilt @ Matrix.Diagonal((x, y, z, 1.0))

    kinds = (
        ("Round", tilt), ("Stretched", size(1.0, 0.4, 1.4)), ("Mirrored", size(-1.3, 0.5, 1.0)),
        ("Sheared", shear), ("Hand-set", size(1.2, 1.4, 0.4)), ("Partly flat", size(1.4, 0.4, 1.0)),
        ("Shared", size(1.0, 0.4, 1.4)), ("Shared too", size(0.6, 1.4, 1.0)),
    )  # fmt: skip
    balls = {}
    for i, (name, turned) in enumerate(kinds):
        at = Matrix.Translation((1.5 * (i % 4 - 1.5), 0.0, 0.8 - 1.6 * (i // 4)))
        balls[name] = coarse_ball(name, at @ turned)
    balls["Shared too"].data = balls["Shared"].data
    mesh = balls["Hand-set"].data
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.pi
    up = Vector((0.0, 0.4, 0.3))
    mesh.normals_split_custom_set(
        [
            (mesh.vertices[loop.vertex_index].co.normalized() + up).normalized()
            for loop in mesh.loops
        ]
    )
    for face in balls["Partly flat"].data.polygons:
        face.use_smooth = face.index % 3 != 0
    for ball in balls.values():
        ball.cycles.shadow_terminator_geometry_offset = 0.0
    set_map("Side", 64, 32, lambda x, y: [0.02 + 4.0 * x**6 + y**4] * 3)
    add_camera((0.0, -9.0, 1.0), (0.0, 0.0, 0.0), lens=54.0)


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene
    for scene in (
        shading,
        view_layers,
        border,
        orthographic,
        tiny,
        huge,
        far_away,
        shadow_terminator,
        stretched,
    )
}
