"""Blender's lights as lamps: what they come to in the picture, what is exported, what is said."""

import math

import bpy
import numpy as np
import support

OLD = bpy.app.version < (4, 0, 0)


def scene_with(kind, **settings):
    """A floor of albedo 1 under one light 2 m above it, seen from straight above through 4 cm."""
    scene = support.fresh_scene(size=(8, 8), samples=64)
    for thing in list(scene.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_plane_add(size=60.0)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 0.04
    camera.location = (0.0, 0.0, 1.0)
    light = bpy.data.objects.new("Key", bpy.data.lights.new("Key", kind))
    light.location = (0.0, 0.0, 2.0)
    light.data.energy = 10.0
    for name, value in settings.items():
        setattr(light.data, name, value)
    for thing in (camera, light):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.world = None
    scene.komorebi.method, scene.komorebi.clay_color = "WORLD_LIGHT", (1.0, 1.0, 1.0)
    scene.komorebi.use_adaptive_sampling = False
    return scene, light


def irradiance(folder):
    """In the middle of the picture: white diffuse radiance is irradiance over π."""
    return math.pi * float(support.render(folder)[..., 0].mean())


def expect(folder, value, tolerance=2e-3):
    seen = irradiance(folder)
    assert abs(seen - value) < tolerance * value, (seen, value)


def test_power_is_irradiance_as_in_cycles(folder):
    cases = [
        ("SUN", {"angle": 0.0}, 10.0),
        ("SUN", {"angle": math.radians(20.0)}, None),
        ("POINT", {"shadow_soft_size": 0.0}, 10.0 / (4.0 * math.pi * 4.0)),
        ("POINT", {"shadow_soft_size": 0.5}, None),
        ("SPOT", {"shadow_soft_size": 0.0, "spot_size": 1.0}, 10.0 / (4.0 * math.pi * 4.0)),
        ("AREA", {"shape": "DISK", "size": 1.0}, None),
    ]
    for kind, settings, exact in cases:
        scene_with(kind, **settings)
        if exact is None and kind == "SUN":
            r = math.tan(math.radians(10.0))  # Cycles 3.x: the mean cosine over the tangent disk
            exact = 10.0 * (2.0 * (math.hypot(1.0, r) - 1.0) / r**2 if OLD else 1.0)
        elif exact is None and kind == "POINT":  # a disk of power / 4 π² r²
            exact = 10.0 / (4.0 * math.pi * 4.25)
        elif exact is None:  # π L r² / (h² + r²), L = power / (4 or π) A
            exact = 10.0 / ((4.0 if OLD else math.pi) * 4.25)
        expect(folder, exact)
    if not OLD:
        scene_with("POINT", shadow_soft_size=0.5, use_soft_falloff=False)
        expect(folder, 10.0 / (4.0 * math.pi * 4.0))


def test_area_of_parallel_rays(folder):
    _, light = scene_with("AREA", shape="SQUARE", size=1.0)
    light.data.spread = 0.0
    if OLD:  # never narrower than a degree
        assert irradiance(folder) > 5.0
    else:
        expect(folder, 10.0)


def test_scale_and_instances(folder):
    scene, light = scene_with("AREA", shape="RECTANGLE", size=0.1, size_y=0.1)
    light.scale = (3.0, 2.0, 1.0)
    before = irradiance(folder)  # the power stays
    expect(folder, 10.0 / ((4.0 if OLD else math.pi) * 4.0), 2e-2)
    stock = bpy.data.collections.new("Stock")
    scene.collection.objects.unlink(light)
    stock.objects.link(light)
    for _ in range(3):
        empty = bpy.data.objects.new("Empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", stock
        scene.collection.objects.link(empty)
    assert len(support.exported().lamps) == 3
    expect(folder, 3.0 * before)
    light.scale = (0.0, 0.0, 0.0)
    assert irradiance(folder) == 0.0


def test_colour_nodes_and_what_is_left_out(folder):
    scene, light = scene_with("POINT", shadow_soft_size=0.0)
    light.data.color = (1.0, 0.5, 0.25)
    light.data.use_nodes = True
    tree = light.data.node_tree
    emission = tree.nodes["Emission"]
    emission.inputs["Strength"].default_value = 2.0
    emission.inputs["Color"].default_value = (1.0, 1.0, 0.0, 1.0)
    picture = support.render(folder)[..., :3].mean(axis=(0, 1))
    expected = np.array([2.0, 1.0, 0.0]) * 10.0 / (16.0 * math.pi**2)
    assert np.allclose(picture, expected, rtol=2e-3), (picture, expected)
    falloff = tree.nodes.new("ShaderNodeLightFalloff")
    falloff.inputs["Strength"].default_value = 3.0
    tree.links.new(falloff.outputs["Quadratic"], emission.inputs["Strength"])
    expect(folder, 3.0 * 10.0 / (16.0 * math.pi))
    checker = tree.nodes.new("ShaderNodeTexChecker")
    tree.links.new(checker.outputs["Color"], emission.inputs["Color"])
    said = warnings_of(folder)
    assert 'light "Key", node "Checker Texture"' in said and "not supported" in said, said
    light.visible_diffuse = False
    assert irradiance(folder) == 0.0
    scene.komorebi.method = "AMBIENT_OCCLUSION"
    assert irradiance(folder) == math.pi


def with_nodes(light):
    """The light's tree and its Emission."""
    light.data.use_nodes = True
    tree = light.data.node_tree
    return tree, tree.nodes["Emission"]


def test_falloff_as_its_node_says(folder):
    _, light = scene_with("POINT", shadow_soft_size=0.0)
    tree, emission = with_nodes(light)
    node = tree.nodes.new("ShaderNodeLightFalloff")
    node.inputs["Strength"].default_value = 3.0
    point = 3.0 * 10.0 / (16.0 * math.pi)  # two metres away
    for smooth in (0.0, 4.0):
        node.inputs["Smooth"].default_value = smooth
        for output, factor in (("Quadratic", 1.0), ("Linear", 2.0), ("Constant", 4.0)):
            tree.links.new(node.outputs[output], emission.inputs["Strength"])
            expect(folder, point * factor * (4.0 / (4.0 + smooth)))
    twice = tree.nodes.new("ShaderNodeMath")
    twice.operation, twice.inputs[1].default_value = "MULTIPLY", 2.0
    tree.links.new(node.outputs["Linear"], twice.inputs[0])
    tree.links.new(twice.outputs[0], emission.inputs["Strength"])
    expect(folder, point * 2.0)
    assert warnings_of(folder) == ""
    twice.operation = "POWER"
    assert 'light "Key": its nodes let the light fall off' in warnings_of(folder)
    light.data.type = "SUN"  # too far away for it
    twice.operation = "MULTIPLY"
    bpy.data.lights["Key"].angle = 0.0
    expect(folder, 60.0)


def test_nodes_that_come_to_a_constant(folder):
    _, light = scene_with("POINT", shadow_soft_size=0.0)
    tree, emission = with_nodes(light)
    blackbody = tree.nodes.new("ShaderNodeBlackbody")
    blackbody.inputs[0].default_value = 3000.0
    tree.links.new(blackbody.outputs[0], emission.inputs["Color"])
    maths = tree.nodes.new("ShaderNodeMath")
    maths.operation = "ADD"
    maths.inputs[0].default_value, maths.inputs[1].default_value = 1.5, 0.5
    tree.links.new(maths.outputs[0], emission.inputs["Strength"])
    mixed, second = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeEmission")
    second.inputs["Color"].default_value = (0.0, 0.0, 1.0, 1.0)
    tree.links.new(emission.outputs[0], mixed.inputs[0])
    tree.links.new(second.outputs[0], mixed.inputs[1])
    output = next(n for n in tree.nodes if n.type == "OUTPUT_LIGHT")
    tree.links.new(mixed.outputs[0], output.inputs["Surface"])
    picture = support.render(folder)[..., :3].mean(axis=(0, 1)) * 16.0 * math.pi**2 / 10.0
    expected = 2.0 * np.array([1.771, 0.844, 0.272]) + (0.0, 0.0, 1.0)  # 3000 K, twice
    assert np.allclose(picture, expected, rtol=1e-2), (picture, expected)
    assert warnings_of(folder) == ""


def test_max_bounces_of_lights_and_world(folder):
    scene, light = scene_with("POINT", shadow_soft_size=0.0)
    assert support.exported().lamps[0].sizes["max_bounces"] == 1024
    light.data.cycles.max_bounces = 3
    assert support.exported().lamps[0].sizes["max_bounces"] == 3
    scene.world = bpy.data.worlds.new("World")
    scene.world.cycles.max_bounces = 2
    layer = scene.view_layers[0]
    region = (0, 0, 8, 8)
    from komorebi.export.settings import export_settings

    assert export_settings(scene, layer, [], region)["world_max_bounces"] == 2
    scene.komorebi.sky = "WHITE"
    assert export_settings(scene, layer, [], region)["world_max_bounces"] == 1024


def test_fast_gi_reads_factor_and_distance_of_the_world(folder):
    """In the open ambient occlusion is 1: what Add brings is its factor, Replace the world's light
    times it."""
    scene, light = scene_with("POINT", shadow_soft_size=0.0)
    light.data.energy = 0.0
    scene.komorebi.bounces = 0
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.5, 0.5, 0.5, 1.0)
    scene.world.light_settings.ao_factor = 0.25
    expect(folder, 0.5 * math.pi)
    scene.komorebi.use_fast_gi = True
    expect(folder, 0.125 * math.pi)
    scene.komorebi.fast_gi_method = "ADD"
    expect(folder, 0.75 * math.pi)
    bpy.ops.mesh.primitive_plane_add(size=400.0, location=(0.0, 0.0, 3.0))
    scene.world.light_settings.distance = 3.5
    # Nearer than that the roof hides all but what grazes: cos² of the angle at its limit.
    expect(folder, 0.25 * math.pi * (3.0 / 3.5) ** 2, 2e-2)
    scene.komorebi.fast_gi_method = "REPLACE"
    assert warnings_of(folder) == ""
    bpy.context.object.cycles.ao_distance = 1.0
    assert "an AO Distance of its own is not supported yet" in warnings_of(folder)
    scene.world = None
    assert irradiance(folder) == 0.0


def warnings_of(folder):
    """What a render warns of."""
    with support.warnings() as said:
        support.render(folder)
    return "\n".join(said)


def test_camera_and_linking_are_warned_of(folder):
    _, light = scene_with("AREA", shape="SQUARE", size=1.0)
    assert warnings_of(folder) == ""
    light.visible_camera = True
    assert 'light "Key": the camera sees no lamps yet' in warnings_of(folder)
    if not hasattr(light, "light_linking"):
        return
    light.light_linking.receiver_collection = bpy.data.collections.new("Some")
    assert 'light "Key": light linking is not supported yet' in warnings_of(folder)


def test_shadow_and_portal(folder):
    _, light = scene_with("POINT", shadow_soft_size=0.0)
    bpy.ops.mesh.primitive_plane_add(size=1.0, location=(0.0, 0.0, 1.5))
    assert irradiance(folder) == 0.0
    if hasattr(light.data.cycles, "cast_shadow"):
        light.data.cycles.cast_shadow = False
    else:
        light.data.use_shadow = False
    expect(folder, 10.0 / (16.0 * math.pi))
    light.data.type = "AREA"
    light = bpy.data.lights["Key"]
    light.cycles.is_portal = True
    assert support.exported().lamps == []


def test_new_settings():
    if not hasattr(bpy.types.Light.bl_rna.properties.get("normalize"), "name"):
        raise support.Skip("no exposure, temperature and normalize in this release")
    _, light = scene_with("POINT", shadow_soft_size=0.5)
    plain = support.exported().lamps[0].radiance
    light.data.exposure = 2.0
    assert np.allclose(support.exported().lamps[0].radiance, 4.0 * plain)
    light.data.exposure, light.data.normalize = 0.0, False
    assert np.allclose(support.exported().lamps[0].radiance, 10.0 / math.pi)
    light.data.normalize, light.data.use_temperature, light.data.temperature = True, True, 3000.0
    red, _, blue = support.exported().lamps[0].radiance
    assert red > 2.0 * blue > 0.0
