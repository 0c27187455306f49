"""Every pass beside Cycles' of the same scene: data passes to rounding, noisy ones by their means."""

import json

import bpy
import numpy as np
import support
from beside_cycles import close, inside, render_both, short_or_long, stacked

SIZE = (96, 64)
DATA = ("use_pass_z", "use_pass_mist", "use_pass_position", "use_pass_normal", "use_pass_uv",
        "use_pass_object_index", "use_pass_material_index", "use_pass_diffuse_color",
        "use_pass_environment", "use_pass_ambient_occlusion", "use_pass_cryptomatte_object",
        "use_pass_cryptomatte_material", "use_pass_cryptomatte_asset")  # fmt: skip


def material(name, index, color=(0.8, 0.8, 0.8, 1.0)):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    tree = m.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = color
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    m.pass_index = index
    return m


def furnished():
    """Ground, a cube of two materials, balls with a parent, and instances of a collection."""
    scene = support.fresh_scene(size=SIZE, samples=16)
    for obj in list(scene.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    scene.camera.location, scene.camera.rotation_euler = (7.0, -7.0, 5.0), (1.1, 0.0, 0.785)
    clay, red = material("Clay", 3), material("紅", 4)

    bpy.ops.mesh.primitive_plane_add(size=9)
    ground = bpy.context.object
    ground.name, ground.pass_index = "Ground", 1
    ground.data.materials.append(clay)

    bpy.ops.mesh.primitive_cube_add(location=(1.0, -1.5, 1.0))
    cube = bpy.context.object
    cube.name, cube.pass_index = "Cube", 2
    cube.data.materials.append(clay)
    cube.data.materials.append(red)
    for i, face in enumerate(cube.data.polygons):
        face.material_index = i % 2

    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, location=(-1.5, 0.5, 1.0))
    ball = bpy.context.object
    ball.name, ball.pass_index, ball.parent = "Ball", 5, cube
    ball.matrix_parent_inverse = cube.matrix_world.inverted()
    ball.data.materials.append(clay)
    ball.material_slots[0].link = "OBJECT"
    ball.material_slots[0].material = red
    for face in ball.data.polygons:
        face.use_smooth = True

    collection = bpy.data.collections.new("Twice")
    other = bpy.data.objects.new("Inside", ball.data)
    other.pass_index, other.scale = 6, (0.4, 0.4, 0.4)
    collection.objects.link(other)
    for x in (-3.0, 3.0):
        empty = support.add_object(f"Empty{x}", None, (x, 2.0, 0.5))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
        empty.pass_index = 7

    world = scene.world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.5, 0.75, 1.0, 1.0)
    world.mist_settings.start, world.mist_settings.depth = 6.0, 12.0
    world.mist_settings.falloff = "LINEAR"
    world.light_settings.distance = scene.komorebi.ao_distance = 2.0
    return scene


def test_places_in_panoramas_are_cycles(folder):
    """Depth, which there is the distance, and what else is measured from the camera."""
    scene = furnished()
    layer = bpy.context.view_layer
    for switch in ("z", "mist", "position", "normal", "cryptomatte_object"):
        setattr(layer, f"use_pass_{switch}", True)
    layer.cycles.denoising_store_passes = True
    scene.camera.location = (0.0, 0.0, 1.6)
    camera = scene.camera.data
    camera.type = "PANO"
    settings = getattr(camera, "cycles", None)
    if settings is None or not hasattr(settings, "panorama_type"):
        settings = camera
    for panorama in ("EQUIRECTANGULAR", "FISHEYE_EQUIDISTANT"):
        settings.panorama_type = panorama
        ours, theirs, _, _ = render_both(scene, folder, panorama, filter_width=0.01)
        whole = inside(ours) & inside(theirs)
        assert whole.mean() > 0.2
        close(ours, theirs, "Depth", "Z", 1e-3, whole)
        close(ours, theirs, "Mist", "Z", 1e-3, whole)
        close(ours, theirs, "Position", "XYZ", 1e-3, whole)
        close(ours, theirs, "Denoising Normal", "XYZ", 2e-3, whole)
        close(ours, theirs, "Denoising Depth", "Z", 1e-3, whole)


def test_data_passes_are_cycles(folder):
    scene = furnished()
    layer = bpy.context.view_layer
    for switch in DATA:
        setattr(layer, switch, True)
    layer.cycles.denoising_store_passes = True
    # All samples at the pixel's centre: the engines' first ones would lie in different places.
    ours, theirs, _, _ = render_both(scene, folder, filter_width=0.01)
    missing = set(theirs) - set(ours)
    assert not missing, missing
    whole = inside(ours) & inside(theirs)
    assert whole.mean() > 0.5

    def near(name, ids, tolerance, where=whole, share=0.99):
        close(ours, theirs, name, ids, tolerance, where, share)

    near("Depth", "Z", 1e-3)
    near("Position", "XYZ", 1e-3)
    near(short_or_long("IndexOB", "Object Index"), "X", 0.0)
    near(short_or_long("IndexMA", "Material Index"), "X", 0.0)
    near("Mist", "Z", 1e-3)
    near("Normal", "XYZ", 2e-3)
    near("UV", "UVA", 1e-3)
    near("Denoising Normal", "XYZ", 2e-3)
    near("Denoising Albedo", "RGB", 1e-3)
    near("Denoising Depth", "Z", 1e-3)
    if bpy.app.version >= (5, 2, 0):
        near("Denoising Specular Albedo", "RGB", 0.0)
        near("Denoising Roughness", "X", 1e-3)
    near(short_or_long("DiffCol", "Diffuse Color"), "RGB", 1e-3)
    near(short_or_long("Env", "Environment"), "RGB", 1e-3)
    sky = ours["Depth.Z"] > 1e9
    assert sky.any() and (theirs["Depth.Z"][sky] > 1e9).mean() > 0.99
    background = (ours["CryptoObject00.g"] == 0.0) & (theirs["CryptoObject00.g"] == 0.0)
    assert background.any()
    near(short_or_long("Env", "Environment"), "RGB", 1e-4, where=background, share=1.0)

    # Noisy: by the mean over all.
    ao = short_or_long("AO", "Ambient Occlusion")
    a, b = stacked(ours, ao, "RGB"), stacked(theirs, ao, "RGB")
    assert abs(a[whole].mean() - b[whole].mean()) < 0.01, (a[whole].mean(), b[whole].mean())
    assert abs((a - b)[whole]).mean() < 0.05


def test_cryptomattes_are_cycles(folder):
    scene = furnished()
    layer = bpy.context.view_layer
    for kind in ("object", "material", "asset"):
        setattr(layer, f"use_pass_cryptomatte_{kind}", True)
    ours, theirs, metadata, their_metadata = render_both(scene, folder)
    assert set(theirs) == set(ours)
    # The same ids, near the same coverage, and the same words in the file.
    for matte in ("CryptoObject", "CryptoMaterial", "CryptoAsset"):
        first, second = f"{matte}00.r", f"{matte}00.g"
        same = ours[first].view(np.uint32) == theirs[first].view(np.uint32)
        assert same[ours[second] > 0.6].all(), matte
        difference = np.abs(ours[second] - theirs[second])[same]
        assert difference.max() < 0.25 and difference.mean() < 0.01, matte
    crypto = {k: v for k, v in metadata.items() if k.startswith("cryptomatte/")}
    theirs_crypto = {k: v for k, v in their_metadata.items() if k.startswith("cryptomatte/")}
    assert set(crypto) == set(theirs_crypto), (crypto, theirs_crypto)
    for key, value in theirs_crypto.items():
        if key.endswith("/manifest"):
            a, b = json.loads(crypto[key]), json.loads(value)
            # Cycles writes the bare hash; as a float it may be a NaN, and then is not the id.
            for thing, known in a.items():
                assert int(known, 16) ^ int(b[thing], 16) in {0, 1 << 23}, (thing, a, b)
        else:
            assert crypto[key] == value, key
