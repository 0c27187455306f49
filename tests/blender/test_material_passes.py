"""What passes tell of materials beside Cycles' own: shader AOVs, and materials and UVs of hair."""

import bpy
import numpy as np
import support
from beside_cycles import close, inside, render_both, short_or_long, stacked
from test_strands import add_hair

SIZE = (96, 64)


def new_material(name, index=0):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.pass_index = index
    return material, material.node_tree


def aov_node(tree, name):
    node = tree.nodes.new("ShaderNodeOutputAOV")
    setattr(node, "aov_name" if hasattr(node, "aov_name") else "name", name)
    return node


def value_of(tree, kind, value):
    """The output of an RGB or Value node."""
    node = tree.nodes.new(kind)
    node.outputs[0].default_value = value
    return node.outputs[0]


def add_aov(name, kind):
    aov = bpy.context.view_layer.aovs.add()
    aov.name, aov.type = name, kind


def plain():
    """Numbers of the nodes themselves, and of others through a reroute and a muted node."""
    material, tree = new_material("Plain")
    node = aov_node(tree, "Tint")
    reroute, muted = tree.nodes.new("NodeReroute"), tree.nodes.new("ShaderNodeInvert")
    muted.mute = True
    tree.links.new(value_of(tree, "ShaderNodeRGB", (0.9, 0.25, 4.0, 1.0)), muted.inputs["Color"])
    tree.links.new(muted.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], node.inputs["Color"])
    aov_node(tree, "Mask").inputs["Value"].default_value = 0.75
    aov_node(tree, "Not asked for").inputs["Value"].default_value = 9.0
    return material


def twice():
    """Two nodes of one name, numbers that become colours and colours that become numbers."""
    material, tree = new_material("Twice")
    first, second = aov_node(tree, "Tint"), aov_node(tree, "Tint")
    first.inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
    tree.links.new(value_of(tree, "ShaderNodeValue", 0.5), second.inputs["Color"])
    mask = aov_node(tree, "Mask")
    tree.links.new(value_of(tree, "ShaderNodeRGB", (0.1, 0.7, 0.4, 1.0)), mask.inputs["Value"])
    hidden = aov_node(tree, "Mask")
    hidden.mute = True
    hidden.inputs["Value"].default_value = 100.0 if hidden.mute else 0.0  # 5.2 mutes no outputs
    return material


def new_group(name, kind):
    """A node group with one input and one output of a kind ("Color", "Float")."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    socket = f"NodeSocket{kind}"
    if hasattr(group, "interface"):
        group.interface.new_socket("In", in_out="INPUT", socket_type=socket)
        group.interface.new_socket("Out", in_out="OUTPUT", socket_type=socket)
    else:
        group.inputs.new(socket, "In")
        group.outputs.new(socket, "Out")
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def grouped():
    """AOVs in a group of a group, fed from outside; and a number that comes out of one."""
    inner, inner_in, inner_out = new_group("Inner", "Color")
    inner.links.new(inner_in.outputs[0], aov_node(inner, "Tint").inputs["Color"])
    inner.links.new(value_of(inner, "ShaderNodeValue", 0.3), inner_out.inputs[0])
    outer, outer_in, outer_out = new_group("Outer", "Color")
    within = outer.nodes.new("ShaderNodeGroup")
    within.node_tree = inner
    outer.links.new(outer_in.outputs[0], within.inputs[0])
    outer.links.new(within.outputs[0], outer_out.inputs[0])
    material, tree = new_material("Grouped")
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = outer
    node.inputs[0].default_value = (0.6, 0.5, 0.25, 1.0)
    tree.links.new(node.outputs[0], aov_node(tree, "Mask").inputs["Value"])
    return material


def balls(materials):
    """A row of balls, each with a material of its own, and one with none."""
    scene = support.fresh_scene(size=SIZE, samples=16)
    made = [make() for make in materials]
    for obj in list(scene.objects):
        if obj.type != "CAMERA":
            bpy.data.objects.remove(obj)
    scene.camera.location, scene.camera.rotation_euler = (0.0, -14.0, 0.0), (np.pi / 2, 0.0, 0.0)
    for i, material in enumerate([*made, None]):
        at = (2.2 * i - 1.1 * len(made), 0.0, 0.0)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, location=at)
        if material is not None:
            bpy.context.object.data.materials.append(material)
    bpy.context.view_layer.use_pass_cryptomatte_object = True
    return scene


def test_aovs_are_cycles(folder):
    scene = balls([plain, twice, grouped, plain])
    next(o for o in scene.objects if o.type == "MESH").is_holdout = True  # says it all the same
    add_aov("Mask", "VALUE")
    add_aov("Tint", "COLOR")
    with support.warnings() as sentences:
        ours, theirs, _, _ = render_both(scene, folder, filter_width=0.01)
    assert not sentences, sentences
    missing = set(theirs) - set(ours)
    assert not missing, missing
    whole = inside(ours) & inside(theirs)
    background = (ours["CryptoObject00.g"] == 0.0) & (theirs["CryptoObject00.g"] == 0.0)
    assert whole.mean() > 0.1 and background.mean() > 0.3
    assert (ours["Mask.X"][background] == 0.75).mean() > 0.02  # the holdout
    for where, share in ((whole, 1.0), (background, 0.995)):  # but for the holdout's edge
        close(ours, theirs, "Mask", "X", 1e-5, where, share)
        close(ours, theirs, "Tint", "RGBA", 1e-5, where, share)
    assert np.allclose(np.unique(np.round(ours["Tint.R"][whole], 4)), (0.0, 0.6, 0.9))
    assert set(np.unique(ours["Tint.A"][whole])) == {0.0, 1.0, 2.0}
    # A filter of the usual width gives the mean over all samples, the background's too.
    ours, theirs, _, _ = render_both(scene, folder, "soft")
    for name in ("Mask.X", "Tint.G", "Tint.A"):
        assert abs(ours[name].mean() - theirs[name].mean()) < 2e-3, name


def varying():
    """Positions, hundreds of metres large, and a picture's colours plus a constant."""
    material, tree = new_material("Varying")
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    far = tree.nodes.new("ShaderNodeMath")
    far.operation = "MULTIPLY"
    far.inputs[1].default_value = 300.0
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(geometry.outputs["Position"], split.inputs[0])
    tree.links.new(split.outputs["X"], far.inputs[0])
    tree.links.new(far.outputs[0], aov_node(tree, "Mask").inputs["Value"])
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Normal"], aov_node(tree, "Tint").inputs["Color"])
    aov_node(tree, "Tint").inputs["Color"].default_value = (0.25, 0.5, 0.0, 1.0)
    return material


def shows_sky(scene):
    """A world that says its own Mask: a gradient over directions."""
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(coordinates.outputs["Generated"], split.inputs[0])
    tree.links.new(split.outputs["Z"], aov_node(tree, "Mask").inputs["Value"])
    aov_node(tree, "Not asked for")


def test_aovs_that_vary_are_cycles(folder):
    scene = balls([varying, plain])
    shows_sky(scene)
    add_aov("Mask", "VALUE")
    add_aov("Tint", "COLOR")
    with support.warnings() as sentences:
        ours, theirs, _, _ = render_both(scene, folder, filter_width=0.01)
    assert not sentences, sentences
    whole = inside(ours) & inside(theirs)
    background = (ours["CryptoObject00.g"] == 0.0) & (theirs["CryptoObject00.g"] == 0.0)
    assert np.ptp(ours["Mask.X"][whole]) > 500.0
    assert np.ptp(ours["Mask.X"][background]) > 0.1
    assert np.ptp(ours["Tint.R"][whole]) > 0.5
    assert set(np.unique(ours["Tint.A"][whole])) == {0.0, 1.0, 2.0}
    close(ours, theirs, "Mask", "X", 0.02, whole)
    close(ours, theirs, "Mask", "X", 1e-4, background)
    # Near edges the samples of a pixel's middle differ.
    close(ours, theirs, "Tint", "RGBA", 2e-3, whole)


def test_bits_of_aovs_do_not_depend_on_threads():
    scene = balls([varying, plain])
    shows_sky(scene)
    add_aov("Mask", "VALUE")
    scene.render.threads_mode = "FIXED"
    pictures = []
    for threads in (1, 3):
        scene.render.threads = threads
        pictures.append(support.exported_picture("Mask"))
    assert np.array_equal(*pictures)


def test_the_layers_override_says_what_aovs_show():
    balls([plain])
    add_aov("Mask", "VALUE")
    bpy.context.view_layer.material_override = twice()
    assert np.isclose(
        support.exported_picture("Mask").max(),
        0.1 * 0.2127 + 0.7 * 0.7152 + 0.4 * 0.0722,
        atol=1e-3,
    )


def furry():
    """A plate of three materials on which two systems grow; the second names a slot beyond."""
    scene = support.fresh_scene(size=SIZE, samples=16)
    plate = bpy.data.objects["Cube"]
    plate.scale = (1.5, 1.5, 0.1)
    plate.data.materials.clear()
    for i, name in enumerate(("Skin", "Fur", "Down")):
        plate.data.materials.append(new_material(name, i + 3)[0])
    for k, slot in enumerate((2, 7)):
        settings = add_hair(plate, count=40, length=1.0)
        plate.particle_systems[k].seed = k
        settings.material = slot
        settings.root_radius, settings.tip_radius, settings.radius_scale = 5.0, 5.0, 0.03
        settings.use_close_tip = False
    settings.child_type, settings.rendered_child_count = "SIMPLE", 3
    layer = bpy.context.view_layer
    for kind in ("object", "material"):
        setattr(layer, f"use_pass_cryptomatte_{kind}", True)
    layer.use_pass_material_index = layer.use_pass_uv = layer.use_pass_z = True
    return scene


def test_materials_and_uvs_of_hair_are_cycles(folder):
    scene = furry()
    with support.warnings() as sentences:
        ours, theirs, _, _ = render_both(scene, folder, filter_width=0.01)
    assert not sentences, sentences
    seen = inside(ours) & inside(theirs)
    # Where both see the same strand at the same depth.
    same = seen & (np.abs(ours["Depth.Z"] - theirs["Depth.Z"]) < 2e-3)
    assert same.sum() > 0.9 * seen.sum() > 400, (same.sum(), seen.sum())
    index = short_or_long("IndexMA", "Material Index")
    close(ours, theirs, index, "X", 0.0, same, 0.995)
    assert {3.0, 4.0, 5.0} <= set(np.unique(ours[f"{index}.X"][same]))
    ids = ours["CryptoMaterial00.r"].view(np.uint32) == theirs["CryptoMaterial00.r"].view(np.uint32)
    assert ids[same].mean() > 0.995, ids[same].mean()
    close(ours, theirs, "UV", "UVA", 1e-3, same, 0.99)
    hair = same & (ours[f"{index}.X"] > 3.0)
    uvs = stacked(ours, "UV", "UV")[hair]
    assert hair.sum() > 100 and len(np.unique(np.round(uvs, 5), axis=0)) > 20
