"""What surfaces look like: materials, clay, cut-outs, and the sky that a user may choose."""

import contextlib
import math

import bpy
import numpy as np
import support

WHITE = (1.0, 1.0, 1.0, 1.0)


def plate(build=None, size=(16, 16)):
    """A scene of one plate that fills the picture, seen from straight above under a white world;
    `build` makes the surface's shader in the tree of its material."""
    scene = support.fresh_scene(size=size, samples=16)
    for obj in [o for o in scene.objects if o.type != "CAMERA"]:
        bpy.data.objects.remove(obj)
    settings = scene.komorebi
    settings.method, settings.surface, settings.bounces = "WORLD_LIGHT", "MATERIAL", 0
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = WHITE
    bpy.ops.mesh.primitive_plane_add(size=100.0)
    thing = bpy.context.object
    if build is not None:
        thing.data.materials.append(material(build))
    scene.camera.location, scene.camera.rotation_euler = (0.3, 0.2, 3.0), (0.0, 0.0, 0.0)
    return scene


def material(build, name="Look"):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(build(tree), output.inputs["Surface"])
    return made


def node(tree, kind, **inputs):
    made = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        socket = made.inputs[name]
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value
    return made


def diffuse(color):
    return lambda tree: node(tree, "BsdfDiffuse", Color=color).outputs[0]


def mixed(share, first, second):
    def build(tree):
        mix = tree.nodes.new("ShaderNodeMixShader")
        mix.inputs[0].default_value = share
        for index, part in ((1, first), (2, second)):
            tree.links.new(part(tree), mix.inputs[index])
        return mix.outputs[0]

    return build


def clear(tree):
    return node(tree, "BsdfTransparent").outputs[0]


def glass(tree):
    return node(tree, "BsdfGlass").outputs[0]


def shine(tree):
    return node(tree, "Emission", Color=(1.0, 0.5, 0.25, 1.0), Strength=2.0).outputs[0]


@contextlib.contextmanager
def reports():
    """Collects the sentences that a render warns by."""
    from komorebi import reporting

    sentences, warn = [], reporting.warn
    reporting.warn = lambda engine, sentence: (sentences.append(sentence), warn(engine, sentence))
    try:
        yield sentences
    finally:
        reporting.warn = warn


def seen(folder, name="picture"):
    """The mean colour and alpha."""
    return support.render(folder, name).reshape(-1, 4).mean(axis=0)


def test_a_colour_is_what_an_even_sky_leaves_of_it(folder):
    plate(diffuse((0.2, 0.5, 0.8, 1.0)))
    assert np.allclose(seen(folder), (0.2, 0.5, 0.8, 1.0), atol=1e-5)


def test_without_material_and_without_nodes(folder):
    scene = plate()
    assert np.allclose(seen(folder), (0.8, 0.8, 0.8, 1.0), atol=1e-5)
    if bpy.app.version < (5, 0, 0):
        plain = bpy.data.materials.new("Plain")
        plain.use_nodes, plain.diffuse_color = False, (0.1, 0.4, 0.6, 1.0)
        bpy.context.object.data.materials.append(plain)
        assert np.allclose(seen(folder), (0.1, 0.4, 0.6, 1.0), atol=1e-5)
    assert scene.komorebi.surface == "MATERIAL"


def test_clear_parts_show_what_is_behind(folder):
    scene = plate(mixed(0.25, diffuse((0.4, 0.4, 0.4, 1.0)), clear))
    scene.komorebi.samples = 256
    assert np.allclose(seen(folder)[:3], 0.75 * 0.4 + 0.25, atol=0.01)
    scene.render.film_transparent = True
    assert np.allclose(seen(folder), (0.3, 0.3, 0.3, 0.75), atol=0.01)


def test_what_shines_is_seen_and_warned_of(folder):
    plate(shine)
    with reports() as sentences:
        assert np.allclose(seen(folder), (2.0, 1.0, 0.5, 1.0), atol=1e-5)
    assert any('material "Look" shines' in s for s in sentences), sentences
    scene = bpy.context.scene
    scene.komorebi.surface = "CLAY"
    scene.komorebi.clay_color = (0.6, 0.6, 0.6)
    assert np.allclose(seen(folder), (0.6, 0.6, 0.6, 1.0), atol=1e-5)


def test_clay_of_one_click(folder):
    scene = plate(mixed(0.5, diffuse((0.9, 0.1, 0.1, 1.0)), glass))
    scene.komorebi.surface = "CLAY"
    scene.komorebi.clay_color = (0.5, 0.5, 0.5)
    scene.komorebi.samples = 256
    assert np.allclose(seen(folder)[:3], 0.5 * 0.5 + 0.5, atol=0.02)  # half is glass, and skipped
    scene.komorebi.clay_glass = "CLAY"
    assert np.allclose(seen(folder)[:3], 0.5, atol=1e-5)
    bpy.data.materials["Look"].komorebi.exclude_from_clay = True
    red, green, _, _ = seen(folder)
    assert red > green + 0.2


def test_clay_keeps_holes_and_a_volume_is_never_solid(folder):
    scene = plate(mixed(1.0, diffuse(WHITE), clear))
    scene.komorebi.surface = "CLAY"
    scene.komorebi.clay_color = (0.2, 0.2, 0.2)
    assert np.allclose(seen(folder)[:3], 1.0, atol=1e-5)  # the world behind it
    tree = bpy.data.materials["Look"].node_tree
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.remove(output.inputs["Surface"].links[0])
    scatter = tree.nodes.new("ShaderNodeVolumeScatter")
    tree.links.new(scatter.outputs[0], output.inputs["Volume"])
    assert np.allclose(seen(folder)[:3], 1.0, atol=1e-5)


def test_cut_outs_count_for_ambient_occlusion(folder):
    scene = plate(diffuse(WHITE))
    bpy.ops.mesh.primitive_plane_add(size=100.0, location=(0.0, 0.0, 1.0))
    bpy.context.object.visible_camera = False
    bpy.context.object.data.materials.append(material(mixed(0.25, diffuse(WHITE), clear), "Veil"))
    scene.komorebi.method, scene.komorebi.samples = "AMBIENT_OCCLUSION", 256
    assert np.allclose(seen(folder)[:3], 0.25, atol=0.01)


def test_pictures_on_surfaces(folder):
    def textured(tree):
        image = bpy.data.images.new("Halves", 2, 1, float_buffer=True)
        image.pixels.foreach_set([0.25, 0.5, 0.75, 1.0, 0.75, 0.25, 0.5, 1.0])
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image, texture.interpolation = image, "Closest"
        return node(tree, "BsdfDiffuse", Color=texture.outputs["Color"]).outputs[0]

    scene = plate(textured)
    scene.camera.location.x = 0.0
    picture = support.render(folder)
    assert np.allclose(picture[:, 2, :3], (0.25, 0.5, 0.75), atol=1e-3)
    assert np.allclose(picture[:, -3, :3], (0.75, 0.25, 0.5), atol=1e-3)


def test_a_missing_picture_is_magenta_and_named(folder):
    path = folder / "gone.png"

    def textured(tree):
        image = bpy.data.images.new("Gone", 4, 4)
        image.filepath_raw, image.file_format = str(path), "PNG"
        image.save()
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = bpy.data.images.load(str(path))
        path.unlink()
        return node(tree, "BsdfDiffuse", Color=texture.outputs["Color"]).outputs[0]

    plate(textured)
    with reports() as sentences:
        assert np.allclose(seen(folder)[:3], (1.0, 0.0, 1.0), atol=1e-5)
    assert any(str(path) in s and 'material "Look"' in s for s in sentences), sentences


def test_pictures_are_averaged_for_bounces_alone():
    from komorebi.export.surface import export_surface, look_of

    scene = plate()
    picture = bpy.data.images.new("Averaged", 8, 8)

    def widths(bounces, interpolation="Linear", coordinate="UV", **links):
        """Footprints by which camera rays look the picture up, and bounces if they differ."""

        def textured(tree):
            place = node(tree, "TexCoord").outputs[coordinate]
            if "noise" in links:
                place = node(tree, "TexNoise", Vector=place).outputs["Color"]
            place = node(tree, "Mapping", Vector=place, Scale=(3.0, 2.0, 1.0)).outputs[0]
            texture = node(tree, "TexImage", Vector=place)
            texture.image, texture.interpolation = picture, interpolation
            color = texture.outputs["Color"]
            if "normal" in links:
                bent = node(tree, "NormalMap", Color=color).outputs[0]
                return node(tree, "BsdfDiffuse", Normal=bent).outputs[0]
            if "alpha" in links:
                shader = node(tree, "MixShader", Fac=texture.outputs["Alpha"])
                tree.links.new(clear(tree), shader.inputs[1])
                tree.links.new(node(tree, "BsdfDiffuse", Color=color).outputs[0], shader.inputs[2])
                return shader.outputs[0]
            return node(tree, "BsdfDiffuse", Color=color).outputs[0]

        scene.komorebi.bounces = bounces
        with reports() as sentences:
            data = export_surface(None, material(textured), look_of(scene))
        assert not sentences, sentences
        looked_up = [
            [op.operands[-1] for op in surface.program.ops if op.op == "image"]
            for surface in (data.camera, data.bounce) if surface is not None
        ]  # fmt: skip
        assert set(looked_up[0]) == {0.0}  # camera rays
        return looked_up[1] if len(looked_up) > 1 else None

    for coordinate in ("UV", "Object", "Generated"):
        assert isinstance(widths(2, coordinate=coordinate)[-1], tuple)
    assert widths(0) is None
    assert widths(2, interpolation="Closest") is None
    assert widths(2, normal=True) is None
    assert widths(2, alpha=True) is None
    assert set(widths(2, noise=True) or {0.0}) == {0.0}


def test_the_emission_pass(folder):
    scene = plate(mixed(0.5, diffuse((0.5, 0.5, 0.5, 1.0)), shine))
    scene.view_layers[0].use_pass_emit = True
    channels, _ = support.render_layers(folder)
    (red,) = (c for name, c in channels.items() if ".Emi" in name and name.endswith(".R"))
    assert np.allclose(red, 1.0, atol=1e-5)


def test_skies_that_need_no_world(folder):
    scene = plate(diffuse((0.5, 0.5, 0.5, 1.0)))
    scene.world = None
    assert not seen(folder)[:3].any()
    scene.komorebi.sky, scene.komorebi.sky_strength = "WHITE", 2.0
    assert np.allclose(seen(folder)[:3], 1.0, atol=1e-5)
    scene.komorebi.sky, scene.komorebi.samples = "STUDIO", 64
    turned = []
    bpy.context.object.rotation_euler = (1.2, 0.0, 0.0)
    for degrees in (0, 120, 360):
        scene.komorebi.sky_rotation = math.radians(degrees)
        turned.append(seen(folder, f"turned{degrees}")[:3])
    assert np.allclose(turned[0], turned[2], rtol=0.05), turned
    assert not np.allclose(turned[0], turned[1], rtol=0.05), turned
    scene.komorebi.sky_studio_light = "nothing.exr"
    try:
        seen(folder)
    except RuntimeError as error:
        assert "nothing.exr" in str(error)
    else:
        raise AssertionError("a studio light that is not there must be told")


def test_the_sun_of_a_sky_lights_as_in_cycles(folder):
    """A plate under Nishita's sky with its disc, as bright as Cycles has it."""
    scene = plate(diffuse((0.8, 0.8, 0.8, 1.0)), size=(8, 8))
    tree = scene.world.node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type = "NISHITA" if bpy.app.version < (5, 0, 0) else "MULTIPLE_SCATTERING"
    sky.sun_elevation, sky.sun_disc = 0.6, True
    background = tree.nodes["Background"]
    tree.links.new(sky.outputs[0], background.inputs["Color"])
    background.inputs["Strength"].default_value = 0.1
    scene.komorebi.samples = 128
    ours = seen(folder)[:3]
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = 512, 0, False
    cycles.use_adaptive_sampling = False
    theirs = seen(folder, "cycles")[:3]
    assert np.allclose(ours, theirs, rtol=0.02), (ours, theirs)


def test_displacement_is_relief_as_in_cycles(folder):
    """A ball bumped by its material's displacement, under a sky that is brighter on one side."""
    scene = plate(size=(64, 64))
    bpy.data.objects.remove(bpy.context.object)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    look = material(diffuse((0.8, 0.8, 0.8, 1.0)))
    tree = look.node_tree
    noise = node(tree, "TexNoise", Scale=5.0)
    height = node(tree, "Displacement", Height=noise.outputs[0], Scale=0.3)
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(height.outputs[0], output.inputs["Displacement"])
    bpy.context.object.data.materials.append(look)
    sky = scene.world.node_tree
    gradient = sky.nodes.new("ShaderNodeTexGradient")
    sky.links.new(gradient.outputs[0], sky.nodes["Background"].inputs["Color"])
    scene.komorebi.samples, scene.komorebi.pixel_filter = 64, "BOX"
    ours = support.render(folder)[16:48, 16:48, 0]
    tree.links.remove(output.inputs["Displacement"].links[0])
    flat = support.render(folder, "flat")[16:48, 16:48, 0]
    tree.links.new(height.outputs[0], output.inputs["Displacement"])
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples, cycles.max_bounces, cycles.use_denoising = 256, 0, False
    cycles.use_adaptive_sampling, cycles.pixel_filter_type = False, "BOX"
    theirs = support.render(folder, "cycles")[16:48, 16:48, 0]

    def blocks(picture):
        return picture.reshape(8, 4, 8, 4).mean(axis=(1, 3))

    assert np.abs(blocks(ours) - blocks(theirs)).mean() < 0.01
    assert np.abs(blocks(flat) - blocks(theirs)).mean() > 0.02


def test_exposure_scales_light_and_not_alpha(folder):
    scene = plate(diffuse((0.2, 0.5, 0.8, 1.0)))
    scene.komorebi.film_exposure = 2.5
    assert np.allclose(seen(folder), (0.5, 1.25, 2.0, 1.0), atol=1e-4)
    scene.komorebi.method = "AMBIENT_OCCLUSION"
    assert np.allclose(seen(folder), 1.0, atol=1e-4)
