"""Every failure ends `blender -b` with a non-zero code, one sentence, and no picture."""

import bpy
import compositing
import support
from support import ERROR, WARNING


def rendered(folder, frames="1", **environment):
    out = folder / "out"
    out.mkdir(exist_ok=True)
    file = support.save(folder)
    return support.blender_render(file, out / "picture_", frames, **environment)


def assert_fails(done, folder, *words):
    assert done.code != 0, done
    for word in words:
        assert word in done.output, done
    assert support.pictures(folder / "out") == [], done
    assert "Traceback (most recent call last)" not in done.output or support.IS_MODULE, done


def test_a_good_scene_passes(folder):
    done = rendered(folder)
    assert done.code == 0, done
    assert support.pictures(folder / "out") == ["picture_0001.png"], done


def test_no_camera(folder):
    bpy.data.objects.remove(bpy.context.scene.camera)
    assert_fails(rendered(folder), folder, "camera")


def test_camera_without_focus(folder):
    support.spoil(bpy.context.scene.camera)
    assert_fails(rendered(folder), folder, f"{ERROR} Camera", "focuses")


def test_missing_map(folder):
    image = bpy.data.images.new("Sky", 8, 4, float_buffer=True)
    path = folder / "sky of mine.exr"
    image.filepath_raw, image.file_format = str(path), "OPEN_EXR"
    image.save()
    support.link_environment(bpy.data.images.load(str(path)))
    path.unlink()
    assert_fails(rendered(folder), folder, ERROR, "sky of mine.exr", "missing")


def test_unreadable_map(folder):
    path = folder / "broken.exr"
    path.write_bytes(b"no picture at all")
    image = bpy.data.images.new("Sky", 8, 4)
    image.source, image.filepath = "FILE", str(path)
    support.link_environment(image)
    assert_fails(rendered(folder), folder, ERROR, "broken.exr")


def test_no_core_for_this_python(folder):
    """A user folder with the add-on and without the core."""
    import komorebi

    addons = folder / "scripts" / "addons"
    addons.mkdir(parents=True)
    source = next(iter(komorebi.__path__))
    (addons / "komorebi").symlink_to(source)
    done = rendered(folder, BLENDER_USER_SCRIPTS=str(folder / "scripts"))
    assert_fails(done, folder, ERROR, "komorebi_core", "Python 3.")


def test_vertices_that_are_not_finite(folder):
    bpy.data.objects["Cube"].data.vertices[3].co.x = float("nan")
    assert_fails(rendered(folder), folder, ERROR, "Cube")


def test_out_of_memory(folder):
    """The address space limited to little more than Blender takes."""
    import resource

    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 16384
    out = folder / "out"
    out.mkdir()
    file = support.save(folder)
    limit = 3 << 30
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (limit, before[1]))
    try:
        done = support.blender_render(file, out / "picture_")
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)
    assert_fails(done, folder, f"{ERROR} Out of memory")


def test_exception_anywhere(folder):
    text = """
import bpy, komorebi.driver
def broken(*arguments): raise KeyError("surprise")
komorebi.driver.export_scene = broken
support.small(bpy.context.scene)
bpy.context.scene.render.filepath = %r
bpy.ops.render.render(write_still=True)
"""
    (folder / "out").mkdir()
    done = support.script(text % str(folder / "out" / "picture.png"), folder)
    assert done.code != 0 and "surprise" in done.output, done
    assert support.pictures(folder / "out") == []


def test_second_view_layer(folder):
    """The first layer is fine, the second has what the core refuses."""
    scene = bpy.context.scene
    mesh = bpy.data.meshes.new("Broken")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, float("nan"), 0)], [], [(0, 1, 2)])
    collection = bpy.data.collections.new("Second")
    scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects.new("Broken", mesh))
    layer = scene.view_layers.new("Other")
    assert not layer.layer_collection.children["Second"].exclude
    scene.view_layers[0].layer_collection.children["Second"].exclude = True
    assert_fails(rendered(folder), folder, "Broken")


def test_frame_of_an_animation(folder):
    """Another camera, without a focus, comes at frame 2: frame 1 stays, 2 and 3 are not there."""
    scene = bpy.context.scene
    scene.frame_end = 3
    other = support.add_object("Spoilt", bpy.data.cameras.new("Spoilt"))
    support.spoil(other)
    scene.timeline_markers.new("a", frame=1).camera = scene.camera
    scene.timeline_markers.new("b", frame=2).camera = other
    done = rendered(folder, "1..3")
    assert done.code != 0, done
    assert support.pictures(folder / "out") == ["picture_0001.png"], done


def failing_second_scene():
    scene = bpy.context.scene
    second = bpy.data.scenes.new("Second")
    support.small(second)
    camera = bpy.data.objects.new("Spoilt", bpy.data.cameras.new("Spoilt"))
    support.spoil(camera)
    second.collection.objects.link(camera)
    second.camera = camera
    return scene, second


def test_scene_strip(folder):
    scene, second = failing_second_scene()
    editor = scene.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    strips.new_scene("Strip", second, 1, 1)
    assert_fails(rendered(folder), folder, ERROR, "focuses")


def test_scene_strip_in_two_frames(folder):
    scene, second = failing_second_scene()
    editor = scene.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    strips.new_scene("Strip", second, 1, 1).frame_final_duration = 2
    assert_fails(rendered(folder, "1,2"), folder, ERROR, "focuses")


def test_second_scene_of_the_compositor(folder):
    scene, second = failing_second_scene()
    tree = support.compositor_tree(scene)
    layers = compositing.layers_node(tree)
    layers.scene = second
    (folder / "out").mkdir()
    own = compositing.layers_node(tree)
    own.scene = scene
    files = {"Image": layers.outputs["Image"], "Own": own.outputs["Image"]}
    compositing.file_output(tree, folder / "out", files)
    composite = tree.nodes.get("Composite")
    if composite is None:  # from 5.0
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        composite = tree.nodes.new("NodeGroupOutput")
    tree.links.new(layers.outputs["Image"], composite.inputs["Image"])
    assert_fails(rendered(folder), folder, ERROR, "focuses")


def test_strip_and_compositor_that_work_pass(folder):
    scene, second = failing_second_scene()
    second.camera.data.dof.use_dof = False
    editor = scene.sequence_editor_create()
    strips = editor.strips if hasattr(editor, "strips") else editor.sequences
    strips.new_scene("Strip", second, 1, 1)
    done = rendered(folder)
    assert done.code == 0 and support.pictures(folder / "out") == ["picture_0001.png"], done


def test_a_warning_stops_nothing(folder):
    support.add_object("Smoke", bpy.data.volumes.new("Smoke"))
    done = rendered(folder)
    assert done.code == 0 and f'{WARNING} object "Smoke" is a volume' in done.output, done
    assert support.pictures(folder / "out") == ["picture_0001.png"]
    assert not [k for k in done.output.splitlines() if "Komorebi" in k and "rror" in k], done
