"""Passes through Blender's compositor: files of single passes, and nodes that need what they tell."""

import bpy
import compositing
import numpy as np
import support

SIZE = (64, 48)
OBJECT_INDEX = "Object Index" if bpy.app.version >= (5, 0, 0) else "IndexOB"


def two_things():
    """A cube of the material Red before a ball of the material Blue, which it partly hides."""
    scene = support.fresh_scene(size=SIZE, samples=16)
    layer = bpy.context.view_layer
    cube = bpy.data.objects["Cube"]
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, location=(-2, 2, 0.5))
    ball = bpy.context.object
    ball.name = "Ball"
    for index, (thing, name) in enumerate(((cube, "Red"), (ball, "Blue"))):
        thing.data.materials.clear()
        thing.data.materials.append(bpy.data.materials.new(name))
        thing.pass_index = index + 1
    for name in ("z", "normal", "mist", "object_index", "position", "uv"):
        setattr(layer, f"use_pass_{name}", True)
    layer.cycles.denoising_store_passes = True
    for kind in ("object", "material"):
        setattr(layer, f"use_pass_cryptomatte_{kind}", True)
    scene.world.mist_settings.start, scene.world.mist_settings.depth = 5, 10
    layer.update_render_passes()
    return scene, cube, ball


def coverage(scene, folder, thing):
    """The alpha that `thing` has where all else is a hole."""
    others = [o for o in scene.objects if o.type == "MESH" and o is not thing]
    scene.render.film_transparent = True
    for other in others:
        other.is_holdout = True
    try:
        return support.render(folder, f"only {thing.name}")[:, :, 3]
    finally:
        scene.render.film_transparent = False
        for other in others:
            other.is_holdout = False


def test_file_outputs_hold_the_passes(folder):
    scene, _, _ = two_things()
    channels, _ = support.render_layers(folder, "direct")
    tree = support.compositor_tree(scene)
    outputs = compositing.layers_node(tree).outputs
    single = {"Image": "Combined.R", "Depth": "Depth.Z", "Mist": "Mist.Z",
              OBJECT_INDEX: f"{OBJECT_INDEX}.X", "Normal": "Normal.X", "Position": "Position.X",
              "Denoising Albedo": "Denoising Albedo.R"}  # fmt: skip
    compositing.file_output(tree, folder, {name: outputs[name] for name in single})
    files = compositing.render_files(folder, single)
    for name, channel in single.items():
        assert np.array_equal(files[name][:, :, 0], channels[f"ViewLayer.{channel}"]), name


def test_multilayer_files_are_read_again(folder):
    """By Blender's own Image node, every pass as it was."""
    scene, _, _ = two_things()
    channels, _ = support.render_layers(folder, "direct")
    tree = support.compositor_tree(scene)
    node = tree.nodes.new("CompositorNodeImage")
    node.image = bpy.data.images.load(str(folder / "direct.exr"))
    node.image.source = "FILE"
    wanted = {"Combined": "Combined.R", "Depth": "Depth.Z", "Normal": "Normal.X",
              OBJECT_INDEX: f"{OBJECT_INDEX}.X", "CryptoObject00": "CryptoObject00.r"}  # fmt: skip
    missing = set(wanted) - {o.name for o in node.outputs}
    assert not missing, (missing, [o.name for o in node.outputs])
    compositing.file_output(tree, folder, {name: node.outputs[name] for name in wanted})
    compositing.layers_node(tree)  # without one Blender renders nothing
    files = compositing.render_files(folder, wanted)
    for name, channel in wanted.items():
        assert np.array_equal(files[name][:, :, 0], channels[f"ViewLayer.{channel}"]), name


def test_cryptomatte_node_picks_by_name(folder):
    scene, cube, ball = two_things()
    truth = {thing.name: coverage(scene, folder, thing) for thing in (cube, ball)}
    tree = support.compositor_tree(scene)
    compositing.layers_node(tree)
    mattes = {}
    for name, kind, picked in (
        ("Cube", "CryptoObject", "Cube"), ("Ball", "CryptoObject", "Ball"),
        ("Blue", "CryptoMaterial", "Blue"),
    ):  # fmt: skip
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source, node.scene = "RENDER", scene
        node.layer_name = f"ViewLayer.{kind}"
        node.matte_id = picked
        assert [e.name for e in node.entries] == [picked]
        mattes[name] = node.outputs["Matte"]
    compositing.file_output(tree, folder, mattes)
    files = compositing.render_files(folder, mattes)
    for name, thing in (("Cube", "Cube"), ("Ball", "Ball"), ("Blue", "Ball")):
        matte = files[name][:, :, 0]
        assert truth[thing].max() == 1 and 0.02 < truth[thing].mean() < 0.5
        assert np.abs(matte - truth[thing]).max() < 1e-5, (name, np.abs(matte - truth[thing]).max())


def test_id_mask_node_takes_the_object_index(folder):
    scene, cube, _ = two_things()
    truth = coverage(scene, folder, cube)
    tree = support.compositor_tree(scene)
    node = tree.nodes.new("CompositorNodeIDMask")
    if hasattr(node, "index"):
        node.index = cube.pass_index
    else:
        node.inputs["Index"].default_value = cube.pass_index
    tree.links.new(compositing.layers_node(tree).outputs[OBJECT_INDEX], node.inputs[0])
    compositing.file_output(tree, folder, {"Mask": node.outputs[0]})
    mask = compositing.render_files(folder, ["Mask"])["Mask"][:, :, 0]
    assert (mask[truth == 1] == 1).all() and (mask[truth == 0] == 0).all()


def test_denoise_node_takes_the_guides(folder):
    """It smooths the ambient occlusion of few samples, and its guides keep the edges."""
    scene, _, _ = two_things()
    scene.komorebi.samples = 1
    bpy.ops.mesh.primitive_plane_add(size=30, location=(0, 0, -1))
    tree = support.compositor_tree(scene)
    outputs = compositing.layers_node(tree).outputs
    node = tree.nodes.new("CompositorNodeDenoise")
    for name, source in (("Image", "Image"), ("Normal", "Denoising Normal"),
                         ("Albedo", "Denoising Albedo")):  # fmt: skip
        tree.links.new(outputs[source], node.inputs[name])
    compositing.file_output(tree, folder, {"Noisy": outputs["Image"], "Clean": node.outputs[0]})
    files = compositing.render_files(folder, ["Noisy", "Clean"])
    noisy, clean = files["Noisy"], files["Clean"]
    if not support.IS_MODULE and np.array_equal(noisy, clean):
        raise support.Skip("this Blender is built without OpenImageDenoise")
    scene.komorebi.samples, scene.render.use_compositing = 256, False
    reference = support.render(folder, "reference")
    errors = [np.sqrt(((p - reference)[:, :, :3] ** 2).mean()) for p in (noisy, clean)]
    assert errors[1] < 0.7 * errors[0], errors
