"""Scenes of cameras: lenses that blur, panoramas. Each file holds several cameras, the first is the
scene's; `./run compare FILE --camera NAME` looks through another."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import bpy
from common import add_box, add_camera, add_sphere, empty_scene, link, set_world
from features import ground
from mathutils import Euler


def surroundings() -> None:
    """Boxes all around the origin, above and below eye level, and two balls."""
    rng = random.Random(11)
    ground()
    for k in range(28):
        angle, far = math.tau * k / 28, rng.uniform(2.5, 7.0)
        size = [rng.uniform(0.3, 1.0) for _ in range(3)]
        height = rng.uniform(0.2, 4.0)
        box = add_box(f"Box {k}", size, (far * math.cos(angle), far * math.sin(angle), height))
        box.rotation_euler = [rng.uniform(0.0, math.tau) for _ in range(3)]
    add_box("Above", (1.5, 0.6, 0.3), (0.4, 0.3, 5.0))
    add_sphere("Ball", 0.6, (2.0, 1.0, 0.6), level=4)
    add_sphere("Small ball", 0.25, (0.6, -1.1, 1.1), level=4)


def another_camera(name: str, of: bpy.types.Object) -> bpy.types.Object:
    """A camera at the same place, with settings of its own."""
    camera = link(bpy.data.objects.new(name, of.data.copy()))
    camera.data.name = name
    camera.matrix_world = of.matrix_world
    return camera


def depth_of_field() -> None:
    """Lenses: a disk, a turned and squeezed pentagon, parallel rays; focus by distance and
    object."""
    empty_scene(320, 200)
    surroundings()
    disk = add_camera((0.5, -4.5, 1.6), (0.9, 0.0, 0.9), lens=35.0)
    disk.name, disk.data.clip_start = "Disk", 0.01
    disk.data.stereo.interocular_distance, disk.data.stereo.convergence_distance = 0.5, 3.4
    dof = disk.data.dof
    dof.use_dof, dof.aperture_fstop, dof.focus_distance = True, 0.12, 3.4
    blades = another_camera("Blades", disk)
    dof = blades.data.dof
    dof.focus_object = bpy.data.objects["Ball"]
    dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 5, 0.4, 1.7
    parallel = another_camera("Orthographic", blades)
    parallel.data.type, parallel.data.ortho_scale, parallel.data.clip_start = "ORTHO", 5.0, 0.001
    parallel.data.dof.aperture_fstop = 1.6
    set_world()


def panorama() -> None:
    """Every kind of panorama that Blender 3.4 has, off the axes, shifted, with limits; a lens on
    two."""
    empty_scene(320, 200)
    surroundings()
    first = add_camera((0.1, -0.3, 1.5), (1.0, 0.5, 1.4))
    first.rotation_euler = Euler((1.35, 0.12, -1.1))
    first.data.type, first.data.clip_start = "PANO", 0.05
    bpy.context.view_layer.update()
    first.name = "Equisolid"
    stereo = first.data.stereo
    stereo.interocular_distance, stereo.convergence_distance = 0.6, 3.0
    stereo.convergence_mode, stereo.use_pole_merge = "TOE", True
    equisolid = first.data.cycles
    equisolid.panorama_type, equisolid.fisheye_lens = "FISHEYE_EQUISOLID", 9.0
    equisolid.fisheye_fov = math.radians(170.0)
    equidistant = another_camera("Equidistant", first)
    equidistant.data.cycles.panorama_type = "FISHEYE_EQUIDISTANT"
    equidistant.data.cycles.fisheye_fov = math.radians(220.0)
    polynomial = another_camera("Polynomial", first)
    polynomial.data.cycles.panorama_type = "FISHEYE_LENS_POLYNOMIAL"
    polynomial.data.cycles.fisheye_fov = math.radians(150.0)
    polynomial.data.cycles.fisheye_polynomial_k1 = -0.06
    polynomial.data.sensor_fit, polynomial.data.sensor_height = "VERTICAL", 25.0
    whole = another_camera("Equirectangular", first)
    whole.data.cycles.panorama_type = "EQUIRECTANGULAR"
    part = another_camera("Equirectangular part", whole)
    settings = part.data.cycles
    settings.longitude_min, settings.longitude_max = -1.0, 2.5
    settings.latitude_min, settings.latitude_max = -0.4, 1.5
    part.data.shift_x, part.data.shift_y = 0.1, -0.05
    part.data.stereo.convergence_mode = "PARALLEL"
    ball = another_camera("Mirror ball", first)
    ball.data.cycles.panorama_type = "MIRRORBALL"
    face = another_camera("Cube face", first)
    face.data.cycles.panorama_type = "EQUIANGULAR_CUBEMAP_FACE"
    for name, of in (("Equirectangular lens", whole), ("Mirror ball lens", ball)):
        dof = another_camera(name, of).data.dof
        dof.use_dof, dof.aperture_fstop, dof.focus_distance = True, 0.1, 2.0
        dof.aperture_blades, dof.aperture_rotation, dof.aperture_ratio = 3, 0.3, 1.5
    set_world()


SCENES: dict[str, Callable[[], None]] = {
    scene.__name__: scene for scene in (depth_of_field, panorama)
}
