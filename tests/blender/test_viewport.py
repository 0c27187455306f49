"""The rendered viewport in a window (under Xvfb): what it shows, and that it lives and ends well."""

import test_window

SCENE = """
import bpy, numpy as np, threading
import addon_utils
import window_steps as w
bpy.context.preferences.view.show_splash = False
FOLDER = {folder!r}
scene = bpy.context.scene
scene.render.engine = "KOMOREBI"
scene.view_settings.view_transform = "Standard"
scene.komorebi.preview_samples = scene.komorebi.samples = 4
scene.komorebi.light_samples = 2
bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 2))
bpy.ops.mesh.primitive_plane_add(size=10, location=(0, 0, -1))

def final(orthographic=False):
    "The final render of what the viewport shows, by a camera of its own."
    space, region = w.space(), w.view()["region"]
    view = space.region_3d
    camera = bpy.data.objects.new("Looks along", bpy.data.cameras.new("Looks along"))
    scene.collection.objects.link(camera)
    camera.matrix_world = view.view_matrix.inverted()
    data = camera.data
    # A viewport shows twice as much as a camera with its lens.
    data.lens, data.sensor_width, data.clip_end = space.lens, 72.0, space.clip_end
    data.clip_start = space.clip_start
    if orthographic:
        data.type = "ORTHO"
        data.ortho_scale = 2.0 / view.window_matrix[0][0]
        camera.matrix_world = camera.matrix_world @ __import__("mathutils").Matrix.Translation((0, 0, 200))
        data.clip_start, data.clip_end = 1.0, 1000.0
    before, scene.camera = scene.camera, camera
    scene.render.resolution_x, scene.render.resolution_y = region.width, region.height
    scene.render.resolution_percentage = 100
    bpy.ops.render.render()
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR", "32"
    path = FOLDER + "/final.exr"
    bpy.data.images["Render Result"].save_render(path)
    image = bpy.data.images.load(path)
    pixels = np.array(image.pixels[:], np.float32).reshape(image.size[1], image.size[0], -1)
    bpy.data.images.remove(image)
    scene.camera = before
    bpy.data.objects.remove(camera)
    return pixels

def the_viewport():
    alive = w.viewports()
    assert len(alive) == 1, alive
    return alive[0]

def expect_final(orthographic=False):
    "The viewport has the very samples of the final render: but for edges pixels are the same."
    yield from w.finished()
    viewport = the_viewport()
    assert not viewport.error, viewport.error
    shown = viewport.picture.pixels
    expected = final(orthographic)
    assert shown.shape == expected.shape, (shown.shape, expected.shape)
    same = np.abs(shown - expected).max(axis=2) < 2e-3
    assert same.mean() > 0.985, same.mean()
    assert abs(shown.mean() - expected.mean()) < 1e-3
    yield from w.finished()
    screen = w.screen()
    linear = np.clip(shown[:, :, :3], 0, 1)
    display = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    off = np.abs(screen - display).max(axis=2)
    assert np.percentile(off, 99) < 2.5 / 255, np.percentile(off, (50, 90, 99, 100))

def rendered():
    yield from w.alone()
    w.space().shading.type = "RENDERED"
    yield 0.1
"""


def run(folder, steps, more=""):
    """`steps` are the body of a generator; `more` is what it calls besides SCENE's."""
    text = SCENE.format(folder=str(folder)) + more
    text += "\ndef steps():\n" + steps + "\nw.start(steps())\n"
    return test_window.run(text, folder)


def test_a_viewport_shows_the_final_picture(folder):
    run(folder, """
    yield 0.3
    yield from rendered()
    yield from expect_final()
    bpy.data.objects["Suzanne"].location.x = 1.5  # an object moves
    yield 0.1
    yield from expect_final()
    mesh = bpy.data.objects["Cube"].data  # a mesh is edited
    for vertex in mesh.vertices:
        vertex.co.z *= 1.5
    mesh.update()
    yield 0.1
    yield from expect_final()
    w.space().region_3d.view_rotation.rotate(__import__("mathutils").Euler((0, 0, 0.5)))
    yield from expect_final()
    w.space().region_3d.view_perspective = "ORTHO"
    yield from expect_final(orthographic=True)
    scene.komorebi.method = "WORLD_LIGHT"  # a setting changes
    scene.update_tag()
    yield 0.1
    yield from expect_final(orthographic=True)
    scene.world.light_settings.ao_factor = 0.3
    scene.komorebi.use_fast_gi = True
    scene.komorebi.ao_bounces, scene.komorebi.ao_bounces_render = 1, 0  # bounces of its own
    scene.update_tag()
    yield 0.1
    yield from w.finished()
    approximated = the_viewport().picture.pixels.copy()
    scene.komorebi.ao_bounces_render = 1
    off = np.abs(approximated - final(orthographic=True)).mean()
    scene.komorebi.ao_bounces = 0
    scene.update_tag()
    yield 0.1
    yield from w.finished()
    change = np.abs(the_viewport().picture.pixels - approximated).mean()
    assert change > 1e-3 and off < 0.05 * change, (off, change)
""")  # fmt: skip


def test_local_view_and_render_regions(folder):
    run(folder, """
    yield 0.3
    yield from rendered()
    yield from w.finished()
    whole = the_viewport().picture.pixels
    space = w.space()
    space.use_render_border = True
    space.render_border_min_x, space.render_border_max_x = 0.25, 0.5
    space.render_border_min_y, space.render_border_max_y = 0.5, 1.0
    w.view()["area"].tag_redraw()
    yield 0.1
    yield from w.finished()
    picture = the_viewport().picture
    height, width = whole.shape[:2]
    x, y, x_end, y_end = picture.view.region
    assert (x, x_end) == (width // 4, width // 2) and (y, y_end) == (height // 2, height)
    assert np.array_equal(picture.pixels, whole[y:y_end, x:x_end])
    space.use_render_border = False
    for obj in bpy.data.objects:
        obj.select_set(obj.name == "Suzanne")
    before = space.region_3d.view_matrix.copy()
    with bpy.context.temp_override(**w.view()):
        bpy.ops.view3d.localview(frame_selected=False)
    yield 0.3
    yield from w.finished()
    alone = the_viewport().picture.pixels
    background = alone[2, 2]
    share = (np.abs(alone - background).max(axis=2) > 1e-3).mean()
    assert 0.001 < share < 0.03, share  # the monkey's head without ground and cube
""")  # fmt: skip


def test_a_viewport_comes_and_goes(folder):
    run(folder, """
    yield 0.3
    yield from rendered()
    space = w.space()
    for turn in range(12):
        space.shading.type = "RENDERED"
        yield 0.05 * (turn % 3)
        space.shading.type = "SOLID"
        yield 0.05
    assert threading.active_count() == 1, threading.enumerate()
    assert not w.viewports()
    space.shading.type = "RENDERED"
    yield 0.1
    for step in range(30):  # edits that come faster than pictures
        bpy.data.objects["Suzanne"].location.x = 0.05 * step
        mesh = bpy.data.objects["Cube"].data
        mesh.vertices[0].co.z -= 0.02
        mesh.update()
        yield 0.0
    yield from w.finished()
    assert not the_viewport().error
    scene.render.engine = "BLENDER_WORKBENCH"
    yield 0.2
    assert not w.viewports() and threading.active_count() == 1
    scene.render.engine = "KOMOREBI"
    yield 0.1
    bpy.ops.ed.undo_push(message="before")
    bpy.data.objects.remove(bpy.data.objects["Suzanne"])
    bpy.ops.ed.undo_push(message="after")
    yield 0.1
    with bpy.context.temp_override(**w.view()):
        bpy.ops.ed.undo()
    yield from w.finished()
    assert "Suzanne" in bpy.data.objects
    bpy.data.objects.remove(bpy.context.scene.camera)
    yield from w.finished()
    bpy.ops.wm.save_as_mainfile(filepath=FOLDER + "/saved.blend")
    bpy.ops.wm.open_mainfile(filepath=FOLDER + "/saved.blend")
    yield 0.3
    assert not w.viewports() and threading.active_count() == 1
    w.space().shading.type = "RENDERED"  # files are opened in Solid
    yield from w.finished()
    assert not the_viewport().error
    addon_utils.disable("komorebi")
    yield 0.3
    assert threading.active_count() == 1, threading.enumerate()
    addon_utils.enable("komorebi")
    yield 0.1
    w.space().shading.type = "RENDERED"
    bpy.context.scene.render.engine = "KOMOREBI"
    yield 0.05  # Blender quits while it renders
""")  # fmt: skip


def test_no_edit_is_missed(folder):
    run(folder, """
    from komorebi.viewport.worker import Worker
    show, shown = Worker._show_picture, []
    def noted(self, picture):
        shown.append((picture.pixel, picture.sample, picture.serial))
        show(self, picture)
    Worker._show_picture = noted
    yield 0.3
    yield from rendered()
    yield from expect_final()
    # A mesh that changes all the time is seen all the same, and is right in the end.
    mesh = bpy.data.objects["Suzanne"].data
    del shown[:]
    for turn in range(60):
        for vertex in mesh.vertices:
            vertex.co.z += 0.002
        mesh.update()
        yield 0.005
    assert len({serial for _, _, serial in shown}) >= 3, shown
    yield from expect_final()
    mesh.flip_normals()  # other corners, the same places
    mesh.update()
    yield 0.1
    yield from expect_final()
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    mesh.update()
    yield 0.1
    yield from expect_final()
""")  # fmt: skip
