"""Worlds: colours, environment maps, their rotation, and what stands in for the rest."""

import math

import bpy
import komorebi_core as core
import mathutils
import numpy as np
import support
from komorebi.errors import RenderError
from komorebi.export import mapping
from komorebi.export.world import export_world


class Reports:
    """An engine that keeps what is reported."""

    is_preview = False

    def __init__(self):
        self.sentences = []

    def report(self, kinds, sentence):
        self.sentences.append((set(kinds), sentence))


def exported(world=None):
    from komorebi import reporting

    reporting.begin()
    reports = Reports()
    return export_world(reports, world or bpy.context.scene.world), reports.sentences


def color_of(data):
    """The even light of a world, which only the core knows."""
    from komorebi.native_programs import Programs

    return Programs(core).program(data.program).constants


def background():
    return next(n for n in bpy.context.scene.world.node_tree.nodes if n.type == "BACKGROUND")


def test_background_colour_and_strength():
    background().inputs["Color"].default_value = (0.1, 0.2, 0.4, 1)
    background().inputs["Strength"].default_value = 2.5
    data, sentences = exported()
    assert np.allclose(color_of(data), (0.25, 0.5, 1.0))
    assert not sentences


def test_no_world_is_black_and_a_plain_one_its_colour():
    assert export_world(Reports(), None).color == (0, 0, 0)
    if bpy.app.version >= (5, 0, 0):
        return
    world = bpy.data.worlds.new("Plain")
    world.use_nodes = False
    world.color = (0.3, 0.2, 0.1)
    data, _ = exported(world)
    assert np.allclose(data.color, (0.3, 0.2, 0.1))


def test_a_view_layer_without_sky_is_black():
    scene = support.fresh_scene()
    scene.komorebi.method = "WORLD_LIGHT"
    background().inputs["Color"].default_value = (1, 1, 1, 1)
    for lamp in [o for o in scene.objects if o.type == "LIGHT"]:
        bpy.data.objects.remove(lamp)
    scene.view_layers[0].use_sky = False
    with support.folder() as folder:
        picture = support.render(folder)
    assert not picture[:, :, :3].any()
    scene.view_layers[0].use_sky = True
    with support.folder() as folder:
        picture = support.render(folder)
    assert picture[:, :, :3].min() > 0


def direction_map(width=64, height=32):
    """An image whose colour is its own direction, (d + 1) / 2, as Blender maps them."""
    image = bpy.data.images.new("Directions", width, height, float_buffer=True)
    u = (np.arange(width) + 0.5) / width
    v = (np.arange(height) + 0.5) / height
    theta, phi = np.meshgrid((v - 0.5) * math.pi, -(u - 0.5) * 2 * math.pi, indexing="ij")
    directions = np.stack(
        [np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta)], axis=2
    )
    pixels = np.ones((height, width, 4), np.float32)
    pixels[:, :, :3] = directions * 0.5 + 0.5
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image


# Camera rotations; the poles themselves are left out, where the map wraps around as in Cycles.
LOOKS = [(90, 0, 0), (90, 0, 90), (90, 0, 180), (90, 0, -90), (165, 0, 20), (20, 0, 20)]


def middle_colours(folder):
    """(direction, colour · 2 − 1) of what the camera sees of the world in some directions."""
    scene = bpy.context.scene
    for obj in [o for o in scene.objects if o.type != "CAMERA"]:
        bpy.data.objects.remove(obj)
    support.small(scene, size=(9, 9), samples=4)
    scene.camera.data.lens = 500
    result = []
    for index, degrees in enumerate(LOOKS):
        euler = mathutils.Euler([math.radians(d) for d in degrees])
        scene.camera.rotation_euler = euler
        direction = euler.to_matrix() @ mathutils.Vector((0, 0, -1))
        result.append((direction[:], support.render(folder, f"look{index}")[4, 4, :3] * 2 - 1))
    return result


def test_every_axis_of_the_map_is_where_blender_draws_it(folder):
    support.link_environment(direction_map())
    for axis, seen in middle_colours(folder):
        assert np.allclose(seen, axis, atol=0.06), (axis, seen)


def test_mapping_turns_the_map(folder):
    node = support.link_environment(direction_map())
    tree = bpy.context.scene.world.node_tree
    mapping_node = tree.nodes.new("ShaderNodeMapping")
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], mapping_node.inputs["Vector"])
    tree.links.new(mapping_node.outputs["Vector"], node.inputs["Vector"])
    mapping_node.inputs["Rotation"].default_value = (0, 0, math.radians(90))
    for kind, sign in (("POINT", 1), ("TEXTURE", -1), ("VECTOR", 1), ("NORMAL", 1)):
        mapping_node.vector_type = kind
        for axis, seen in middle_colours(folder):
            expected = (-sign * axis[1], sign * axis[0], axis[2])  # a quarter turn about Z
            assert np.allclose(seen, expected, atol=0.06), (kind, axis, seen)


def test_mapping_matrix_is_blenders_euler():
    euler = (0.3, -0.7, 1.9)
    expected = np.array(mathutils.Euler(euler).to_matrix())
    assert np.allclose(mapping.euler_matrix(euler), expected, atol=1e-6)
    turn, exact = mapping.nearest_rotation(expected * 3.0)
    assert exact
    assert np.allclose(turn, expected, atol=1e-6)
    _, exact = mapping.nearest_rotation(expected @ np.diag([1, 2, 1]))
    assert not exact


def environment_pixels(folder, image):
    node = support.link_environment(image)
    seen = middle_colours(folder)
    bpy.context.scene.world.node_tree.nodes.remove(node)
    return np.array([colour for _, colour in seen])


def test_file_packed_and_generated_images_are_the_same_light(folder):
    image = direction_map()
    generated = environment_pixels(folder, image)
    path = folder / "map.exr"
    settings = bpy.context.scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGB"
    image.save_render(str(path))
    loaded = bpy.data.images.load(str(path))
    from_file = environment_pixels(folder, loaded)
    assert np.allclose(generated, from_file, atol=2e-3)
    loaded.pack()
    path.unlink()
    packed = environment_pixels(folder, loaded)
    assert np.allclose(packed, from_file, atol=2e-3)


def test_byte_images_are_made_linear(folder):
    """Blender's own conversion, as a scene-linear EXR of the same image shows it."""
    image = bpy.data.images.new("Bytes", 8, 4)
    image.generated_color = (0.5, 0.2, 0.8, 1)
    expected = np.array([0.21404, 0.0331, 0.6038])
    node = support.link_environment(image)
    data, sentences = exported()
    assert not sentences
    stored = np.round(np.array([0.5, 0.2, 0.8]) * 255) / 255
    linear = ((stored + 0.055) / 1.055) ** 2.4
    assert np.allclose(data.image.pixels[0, 0], linear, rtol=1e-4)
    assert np.allclose(linear, expected, rtol=2e-2)
    path = folder / "bytes.png"
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    node.image = bpy.data.images.load(str(path))
    data, _ = exported()
    assert data.image.path
    assert data.image.color_space == "SRGB"
    seen = (middle_colours(folder)[0][1] + 1) / 2
    assert np.allclose(seen, linear, rtol=1e-3), seen


def test_missing_file_is_a_failure_that_names_it(folder):
    image = direction_map()
    path = folder / "gone.exr"
    image.filepath_raw, image.file_format = str(path), "OPEN_EXR"
    image.save()
    support.link_environment(bpy.data.images.load(str(path)))
    path.unlink()
    try:
        exported()
    except RenderError as error:
        assert str(path) in str(error)
    else:
        raise AssertionError("a missing file must not pass")


def test_colour_and_strength_scale_the_light():
    node = support.link_environment(direction_map())
    background().inputs["Strength"].default_value = 3.0
    data, _ = exported()
    assert data.strength == 3.0
    assert data.image.pixels.shape == (32, 64, 3)
    value = bpy.context.scene.world.node_tree.nodes.new("ShaderNodeValue")
    value.outputs[0].default_value = 0.25
    bpy.context.scene.world.node_tree.links.new(value.outputs[0], background().inputs["Strength"])
    assert exported()[0].strength == 0.25
    node.mute = True


UNSUPPORTED = {"ShaderNodeTexPointDensity": "Color", "ShaderNodeBevel": "Normal"}


def test_what_is_not_supported_is_named_and_never_black():
    tree = bpy.context.scene.world.node_tree
    for kind, output in UNSUPPORTED.items():
        node = tree.nodes.new(kind)
        node.name = f"My {kind} Error"
        tree.links.new(node.outputs[output], background().inputs["Color"])
        data, sentences = exported()
        assert len(sentences) == 1, (kind, sentences)
        kinds, sentence = sentences[0]
        assert kinds == {"WARNING"} and f"My {kind}" in sentence, sentence
        assert "error" not in sentence.lower(), sentence
        color = color_of(data)
        assert output == "Normal" or min(color) > 0.01, (kind, color)


def test_a_muted_node_does_nothing():
    tree = bpy.context.scene.world.node_tree
    environment = support.link_environment(direction_map())
    hue = tree.nodes.new("ShaderNodeHueSaturation")
    tree.links.new(environment.outputs["Color"], hue.inputs["Color"])
    tree.links.new(hue.outputs["Color"], background().inputs["Color"])
    hue.mute = True
    data, sentences = exported()
    assert data.image is not None
    assert not sentences


def test_the_camera_sees_another_world_than_lights():
    """A map for the light and a colour behind: Mix by Is Camera Ray, the map as exact as alone."""
    tree = bpy.context.scene.world.node_tree
    support.link_environment(direction_map())
    output = next(n for n in tree.nodes if n.type == "OUTPUT_WORLD")
    mix, other = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBackground")
    other.inputs["Color"].default_value = (0.25, 0.5, 1, 1)
    path = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(background().outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    data, sentences = exported()
    assert data.image is not None and not sentences
    with support.folder() as folder:
        for _, seen in middle_colours(folder):
            assert np.allclose((seen + 1) / 2, (0.25, 0.5, 1), atol=1e-5)


def test_mix_shader_and_volume():
    tree = bpy.context.scene.world.node_tree
    output = next(n for n in tree.nodes if n.type == "OUTPUT_WORLD")
    mix = tree.nodes.new("ShaderNodeMixShader")
    background().inputs["Color"].default_value = (0.5, 0.5, 0.5, 1)
    tree.links.new(background().outputs[0], mix.inputs[1])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    tree.links.new(tree.nodes.new("ShaderNodeVolumeScatter").outputs[0], output.inputs["Volume"])
    data, sentences = exported()
    assert np.allclose(color_of(data), 0.25) and len(sentences) == 1, sentences
