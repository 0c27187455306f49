"""Sky Texture beside Cycles: the sky all round, the sun's disc, and its light on a plate.

Cycles' own skies are computed by the release at hand, so every model is tested in the releases
that have it.
"""

import math
from types import SimpleNamespace

import bpy
import komorebi_core as core
import mathutils
import numpy as np
import support
from komorebi.export.shader import Compiler, Ray
from komorebi.export.shader.nodes_sky import SkyData, SkySun
from node_beside_cycles import MOST, Reports, Stage

DEGREE = math.pi / 180.0
# How far apart pictures may be, as the sum of differences over the sum of radiances: far more than
# a part of the range says, since skies are brightest by far around the sun.
RELATIVE = 0.004


def models():
    return {
        item.identifier
        for item in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items
    }


def scattering():
    return [m for m in ("NISHITA", "SINGLE_SCATTERING", "MULTIPLE_SCATTERING") if m in models()]


def set_sky(stage, model, **properties):
    sky = stage.new("TexSky")
    sky.sky_type = model
    if not hasattr(sky, "dust_density") and "dust_density" in properties:
        properties["aerosol_density"] = properties.pop("dust_density")
    for name, value in properties.items():
        setattr(sky, name, value)
    return sky


def compare_sky(stage, model, most=RELATIVE, **properties):
    """Both pictures."""
    stage.points()
    stage.clear()
    sky = set_sky(stage, model, **properties)
    name = f"{model} {properties}"
    difference, theirs, ours = stage.differ(sky.outputs[0])
    relative = np.abs(theirs - ours).sum() / max(np.abs(theirs).sum(), 1e-6)
    print(f"[sky] {name}: {difference:.1e} of the range, {relative:.1e} of the sum", flush=True)
    assert difference <= MOST, f"{name}: {difference} of the range"
    worst = int(np.abs(theirs - ours).sum(axis=1).argmax())
    assert relative <= most, (
        f"{name}: {relative} of the sum; at {stage.points()[0]['position'][worst]} Cycles has "
        f"{theirs[worst]}, we have {ours[worst]}"
    )
    assert not stage.warnings, stage.warnings
    return theirs, ours


def test_preetham():
    stage = Stage()
    for elevation in (-5, 0, 3, 30, 60, 90):
        sun = (0.3, math.cos(elevation * DEGREE), math.sin(elevation * DEGREE))
        for turbidity in (1.0, 2.2, 5.5, 10.0):
            compare_sky(stage, "PREETHAM", sun_direction=sun, turbidity=turbidity)


def test_hosek_and_wilkie():
    stage = Stage()
    for elevation in (-5, 0, 3, 30, 60, 90):
        sun = (0.3, math.cos(elevation * DEGREE), math.sin(elevation * DEGREE))
        for turbidity, albedo in ((1.0, 0.0), (2.2, 0.3), (5.5, 1.0), (10.0, 0.7)):
            compare_sky(
                stage, "HOSEK_WILKIE", sun_direction=sun, turbidity=turbidity, ground_albedo=albedo
            )


def test_scattering():
    stage = Stage()
    for model in scattering():
        for elevation in (-5, -1, 0, 3, 15, 45, 90):
            compare_sky(stage, model, sun_elevation=elevation * DEGREE, sun_disc=False)
        for rotation in (100, 400, -30):
            compare_sky(stage, model, sun_rotation=rotation * DEGREE, sun_disc=False)
        compare_sky(stage, model, sun_elevation=110 * DEGREE, sun_disc=False)
        for altitude in (0.0, 1.0, 1000.0, 20000.0, 60000.0):
            # At its upper end Nishita's air is a metre thick, and its light Cycles' rounding errors.
            most = 1.0 if altitude == 60000.0 else RELATIVE
            for elevation in (-2, 20):
                compare_sky(stage, model, most, altitude=altitude, sun_disc=False,
                            sun_elevation=elevation * DEGREE)  # fmt: skip
        for name in ("air_density", "dust_density", "ozone_density"):
            for density in (0.0, 10.0):
                compare_sky(stage, model, sun_disc=False, **{name: density})


def test_discs_that_the_camera_sees():
    """Large enough to cover pixels; these agree one by one, and so at the horizon."""
    stage = Stage()
    for model in scattering():
        for elevation in (-3, 0, 4, 30, 85):
            for intensity in (0.01, 1.0):
                theirs, ours = compare_sky(
                    stage, model, sun_elevation=elevation * DEGREE, sun_size=20 * DEGREE,
                    sun_rotation=1.0, sun_intensity=intensity)  # fmt: skip
                close = np.abs(theirs - ours) <= 0.01 * theirs.max(axis=1, keepdims=True) + 1e-4
                assert close.mean() > 0.995, (model, elevation, close.mean())


def test_bad_numbers_are_sentences():
    for model in ("PREETHAM", "NISHITA"):
        data = SkyData(model=model)
        fields = {name: getattr(data, name) for name in data.__slots__}
        fields |= {"turbidity": math.nan, "altitude": math.inf}
        for call in (core.sky_numbers, core.sky_table):
            try:
                call(SimpleNamespace(**fields))
            except ValueError as error:
                assert "finite" in str(error)
            else:
                raise AssertionError("a sky of NaN")


def test_the_disc_as_a_light():
    """Cycles' own light on a plate that faces the sun; the sky's part is taken off, and small
    beside a sun a hundred times as strong."""
    for model in scattering():
        for elevation, size in ((0.1, 0.545), (5, 0.545), (40, 10), (89, 0.545)):
            stage = Stage(plate_that_faces(elevation * DEGREE, 0.7))
            sky = sky_over(model, sun_elevation=elevation * DEGREE, sun_rotation=0.7,
                           sun_size=size * DEGREE, sun_intensity=100.0)  # fmt: skip
            (sun,) = suns(sky)
            ours = np.array(sun.radiance) * math.sin(sun.radius) ** 2
            theirs = light_on(stage)
            sky.sun_disc = False
            assert not suns(sky)
            theirs -= light_on(stage)
            print(f"[sky] {model} {elevation}° {size}°: {ours} {ours / theirs}", flush=True)
            assert (np.abs(ours / theirs - 1.0) < 0.005).all() or theirs.min() < 1e-3 * theirs.max()


def plate_that_faces(elevation, rotation):
    bpy.ops.mesh.primitive_plane_add(size=2.0)
    plate = bpy.context.object
    plate.rotation_euler = (0.0, math.pi / 2.0 - elevation, math.pi / 2.0 - rotation)
    camera = bpy.context.scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", 1.0
    bpy.context.view_layer.update()
    camera.matrix_world = plate.matrix_world
    camera.location = plate.matrix_world.to_quaternion() @ mathutils.Vector((0.0, 0.0, 5.0))
    return plate


def sky_over(model, **properties):
    """The world's sky, lighting a white plate."""
    scene = bpy.context.scene
    tree = scene.world.node_tree
    tree.nodes.clear()
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = model
    for name, value in properties.items():
        setattr(sky, name, value)
    shader, output = (tree.nodes.new(f"ShaderNode{name}") for name in ("Background", "OutputWorld"))
    tree.links.new(sky.outputs[0], shader.inputs["Color"])
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return sky


def light_on(stage):
    """Radiance of the plate, of albedo 1: the irradiance / π, a channel."""
    tree = stage.tree
    tree.nodes.clear()
    shader, output = (
        tree.nodes.new(f"ShaderNode{name}") for name in ("BsdfDiffuse", "OutputMaterial")
    )
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    stage.scene.render.engine = "CYCLES"
    stage.scene.cycles.samples = 128
    with support.folder() as folder:
        return support.render(folder)[..., :3].mean(axis=(0, 1))


def suns(sky):
    compiler = Compiler(Reports(), "Under test", Ray("DIFFUSE"), is_world=True)
    compiler.value(sky.outputs[0].links[0].to_socket)
    assert all(isinstance(sun, SkySun) for sun in compiler.suns)
    return compiler.suns
