"""Blender's render pipeline around the engine: what artists and farms have always relied on."""

import contextlib

import bpy
import numpy as np
import support
from komorebi import driver


@contextlib.contextmanager
def exports():
    """Names of the view layers that are exported meanwhile, in order."""
    names, original = [], driver.export_scene

    def export_scene(*arguments, **options):
        depsgraph = next(a for a in arguments if isinstance(a, bpy.types.Depsgraph))
        names.append(depsgraph.view_layer.name)
        return original(*arguments, **options)

    driver.export_scene = export_scene
    try:
        yield names
    finally:
        driver.export_scene = original


def new_scene(name, camera=None):
    """An empty scene with the same settings, seen by the startup scene's camera."""
    source = bpy.context.scene
    scene = bpy.data.scenes.new(name)
    support.small(scene)
    scene.world = source.world
    scene.camera = camera or source.camera
    return scene


def sphere(name, location, scene):
    mesh = bpy.data.meshes.new(name)
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(corners, [], faces)
    obj = bpy.data.objects.new(name, mesh)
    obj.location = location
    scene.collection.objects.link(obj)
    return obj


def output_of(tree):
    """The input socket of a compositing tree that becomes the picture."""
    if hasattr(bpy.types, "CompositorNodeComposite"):
        return tree.nodes.new("CompositorNodeComposite").inputs[0]
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    return tree.nodes.new("NodeGroupOutput").inputs[0]


def test_background_set_is_rendered(folder):
    scene = bpy.context.scene
    behind = new_scene("Set")
    sphere("Wall", (-3, 1, 0), behind)
    alone = support.render(folder, "alone")
    scene.background_set = behind
    with_set = support.render(folder, "set")
    scene.background_set = None
    scene.collection.objects.link(bpy.data.objects["Wall"])
    linked = support.render(folder, "linked")
    assert not np.array_equal(alone, linked)
    assert np.array_equal(with_set, linked), np.abs(with_set - linked).max()


def test_two_scenes_in_one_compositor(folder):
    first = bpy.context.scene
    second = new_scene("Second")
    sphere("Other", (0, 2, 0), second)
    separate = [support.render(folder, s.name, s) for s in (first, second)]
    tree = support.compositor_tree(first)
    for node in list(tree.nodes):
        tree.nodes.remove(node)
    layers = [tree.nodes.new("CompositorNodeRLayers") for _ in range(2)]
    layers[0].scene, layers[1].scene = first, second
    mixed = hasattr(bpy.types, "CompositorNodeMixRGB")
    add = tree.nodes.new("CompositorNodeMixRGB" if mixed else "ShaderNodeMix")
    add.blend_type = "ADD"
    if not mixed:
        add.data_type = "RGBA"
    colors = [s for s in add.inputs if s.type == "RGBA"]
    factor = next(s for s in add.inputs if s.name in ("Fac", "Factor") and s.type == "VALUE")
    factor.default_value = 1
    for layer, socket in zip(layers, colors, strict=True):
        tree.links.new(layer.outputs["Image"], socket)
    tree.links.new(next(s for s in add.outputs if s.type == "RGBA"), output_of(tree))
    with exports() as exported:
        together = support.render(folder, "together", first)
    assert len(exported) == 2, exported
    expected = separate[0] + separate[1]
    assert np.abs(together - expected)[:, :, :3].max() < 1e-3


def test_scene_strip_of_the_sequencer(folder):
    shot = bpy.context.scene
    alone = support.render(folder, "alone", shot)
    edit = new_scene("Edit")
    edit.frame_start = edit.frame_end = 1
    editor = edit.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    strip = strips.new_scene("Shot", shot, channel=1, frame_start=1)
    strip.scene_input = "CAMERA"
    edit.render.use_sequencer = True
    edit.view_settings.view_transform = shot.view_settings.view_transform
    with exports() as exported:
        strung = support.render(folder, "edit", edit)
    assert exported == [shot.view_layers[0].name], exported
    # The sequencer works in its own colour space: there and back costs a little.
    assert np.abs(strung[:, :, :3] - alone[:, :, :3]).max() < 5e-3


def test_layers_that_are_not_used_are_not_rendered(folder):
    """(Render Single Layer counts only in a window: test_window.py.)"""
    scene = bpy.context.scene
    layer = scene.view_layers.new("Second")
    with exports() as exported:
        support.render(folder, "both")
    assert sorted(exported) == ["Second", "ViewLayer"], exported
    layer.use = False
    with exports() as exported:
        support.render(folder, "one")
    assert exported == ["ViewLayer"], exported


def test_stamp_is_burnt_in_and_written(folder):
    scene = bpy.context.scene
    plain = support.render(folder, "plain")
    scene.render.use_stamp = True
    scene.render.use_stamp_note = True
    scene.render.stamp_note_text = "a leaf falls"
    scene.render.stamp_font_size = 10
    scene.render.stamp_background = (1, 0, 0, 1)
    stamped = support.render(folder, "stamped")
    assert not np.array_equal(plain, stamped)
    rows = (np.abs(stamped - plain) > 0).any((1, 2))
    assert rows.any() and (stamped[rows][:, :, 0] > 0.5).any()
    written = (folder / "stamped.exr").read_bytes()
    for text in (b"a leaf falls", b"Camera", b"RenderTime", b"Frame"):
        assert text in written, text


def animation(folder, start, end, step=1):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end, scene.frame_step = start, end, step
    scene.render.image_settings.file_format = "PNG"
    bpy.ops.render.render(animation=True)
    return support.pictures(folder)


def test_frame_step_and_names(folder):
    bpy.context.scene.render.filepath = str(folder / "take_##_of_####")
    with exports() as exported:
        names = animation(folder, 2, 9, 3)
    # The last run of # is the number.
    assert names in (
        ["take_##_of_0002.png", "take_##_of_0005.png", "take_##_of_0008.png"],
        ["take_02_of_0002.png", "take_05_of_0005.png", "take_08_of_0008.png"],
    ), names
    assert len(exported) == 3


def test_no_overwrite_keeps_what_is_there(folder):
    scene = bpy.context.scene
    scene.render.filepath = str(folder / "####")
    scene.render.use_overwrite, scene.render.use_placeholder = False, True
    (folder / "0002.png").write_bytes(b"mine")
    with exports() as exported:
        names = animation(folder, 1, 3)
    assert names == ["0001.png", "0002.png", "0003.png"], names
    assert (folder / "0002.png").read_bytes() == b"mine"
    assert (folder / "0001.png").stat().st_size > 100 and len(exported) == 2


def test_placeholder_is_there_while_the_frame_renders(folder):
    scene = bpy.context.scene
    scene.render.filepath = str(folder / "####")
    scene.render.use_placeholder = True
    sizes, original = [], driver.export_scene

    def export_scene(*arguments, **options):
        sizes.append((folder / f"{scene.frame_current:04}.png").stat().st_size)
        return original(*arguments, **options)

    driver.export_scene = export_scene
    try:
        animation(folder, 1, 2)
    finally:
        driver.export_scene = original
    assert sizes == [0, 0], sizes


@contextlib.contextmanager
def handlers():
    """The render handlers that were called meanwhile, in order."""
    called, added = [], []
    for name in dir(bpy.app.handlers):
        if name.startswith("render_") and isinstance(getattr(bpy.app.handlers, name), list):

            def note(*_, name=name):
                called.append(name)

            getattr(bpy.app.handlers, name).append(note)
            added.append((name, note))
    try:
        yield called
    finally:
        for name, note in added:
            getattr(bpy.app.handlers, name).remove(note)


def test_handlers_are_called_in_order(folder):
    with handlers() as called:
        support.render(folder)
    called = [name for name in called if name != "render_stats"]
    assert called == ["render_init", "render_pre", "render_post", "render_write", "render_complete"]
    with handlers() as called:
        bpy.context.scene.render.filepath = str(folder / "####")
        animation(folder, 1, 2)
    called = [name for name in called if name != "render_stats"]
    frame = ["render_pre", "render_post", "render_write"]
    assert called == ["render_init", *frame, *frame, "render_complete"], called


def test_handlers_know_of_a_failure(folder):
    bpy.context.scene.camera.data.clip_start = 2
    bpy.data.objects["Cube"].data.vertices[0].co.x = float("nan")
    with handlers() as called:
        try:
            support.render(folder)
        except RuntimeError:
            pass
        else:
            raise AssertionError("a mesh with a vertex that is no number was rendered")
    assert "render_cancel" in called and "render_complete" not in called, called
