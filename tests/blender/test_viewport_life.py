"""Rendered viewports in a window (under Xvfb) through what may happen to them: no crash, no memory
or thread lost, and the right picture afterwards."""

import test_window

BEGIN = """
import gc, os, threading, time
import bmesh, bpy, numpy as np
import support
import view_steps as v
import window_steps as w
import x_windows
scene = v.prepare()

def rendered():
    yield from w.alone()
    v.bare(w.space())
    w.space().shading.type = "RENDERED"
    yield 0.2

def closed():
    "Nothing is rendered any more: the memory, in bytes, and the threads that are left."
    for view in v.views():
        view["area"].spaces.active.shading.type = "SOLID"
    for _ in range(60):  # a busy machine may draw late
        yield 0.3
        gc.collect()
        if threading.active_count() == 1:
            break
    assert not w.viewports(), [(x, gc.get_referrers(x)) for x in w.viewports()]
    assert threading.active_count() == 1, threading.enumerate()
    return support.resident_bytes(), v.threads()
"""


def run(folder, steps):
    text = BEGIN + "\ndef steps():\n    yield 0.3\n" + steps + "\nw.start(steps())\n"
    return test_window.run(text, folder, timeout=400)


def test_five_hundred_sizes(folder):
    run(folder, """
    yield from rendered()
    display = x_windows.Display()
    (window,) = display.windows()
    numbers = np.random.default_rng(1)

    def sizes(number):
        for _ in range(number):
            width, height = numbers.integers((300, 200), (960, 540))
            display.place(window, 0, 0, int(width), int(height))
            yield (0.0, 0.02, 0.05)[numbers.integers(3)]

    yield from sizes(150)
    before = yield from closed()
    w.space().shading.type = "RENDERED"
    yield from sizes(350)
    after = yield from closed()
    print("MEMORY", before, after, flush=True)
    assert after[0] - before[0] < 20e6 and after[1] <= before[1], (before, after)
    w.space().shading.type = "RENDERED"
    for y in (1, 0):
        display.place(window, 0, y, 960, 540)
        yield 0.3
    yield from v.expect_final_of(v.views()[0], "resized")
""")  # fmt: skip


def test_areas_that_split_close_and_fill_the_window(folder):
    run(folder, """
    yield from rendered()
    with w.override():
        bpy.ops.screen.back_to_previous()
    yield 0.2

    def turns(number):
        for turn in range(number):
            v.views()[0]["area"].spaces.active.shading.type = "RENDERED"
            direction = ("VERTICAL", "HORIZONTAL")[turn % 2]
            with w.override():
                bpy.ops.screen.area_split(direction=direction, factor=0.3 + 0.01 * turn)
            yield 0.03 * (turn % 3)
            with w.override():
                bpy.ops.screen.screen_full_area(use_hide_panels=turn % 4 == 0)
            yield 0.05
            with w.override():
                bpy.ops.screen.screen_full_area(use_hide_panels=turn % 4 == 0)
            yield 0.03 * (turn % 2)
            if len(v.views()) > 1:  # else there was no room to split
                with w.override():
                    bpy.ops.screen.area_close()
            yield 0.02

    yield from turns(6)
    before = yield from closed()
    yield from turns(14)
    after = yield from closed()
    print("MEMORY", before, after, flush=True)
    assert after[0] - before[0] < 20e6 and after[1] <= before[1], (before, after)
    w.space().shading.type = "RENDERED"
    yield from rendered()
    assert (yield from v.expect_all("at the end")) == 1
""")  # fmt: skip


def test_hidden_windows(folder):
    run(folder, """
    yield from rendered()
    display = x_windows.Display()
    (window,) = display.windows()
    scene.komorebi.preview_samples = 64
    scene.update_tag()
    yield 0.1
    display.hide(window)  # while it renders
    for step in range(10):
        bpy.data.objects["Suzanne"].location.x = 0.1 * step
        yield 0.05
    display.show(window)
    scene.komorebi.preview_samples = 4
    scene.update_tag()
    yield 0.3
    yield from v.expect_final_of(v.views()[0], "shown again")
    display.hide(window)
    yield 0.2
    yield from closed()
""")  # fmt: skip


def test_scenes_and_cameras_that_go(folder):
    run(folder, """
    yield from rendered()
    window = bpy.context.window_manager.windows[0]
    for kind in ("FULL_COPY", "LINK_COPY", "EMPTY"):
        with w.override():
            bpy.ops.scene.new(type=kind)
        yield 0.1
        w.space().shading.type = "RENDERED"
        yield 0.05
        bpy.data.scenes.remove(window.scene)  # under the view that shows it
        bpy.data.orphans_purge()
        yield 0.1
    assert window.scene == scene
    w.space().shading.type = "RENDERED"
    w.space().region_3d.view_perspective = "CAMERA"
    camera = scene.camera
    camera.location, camera.rotation_euler = (0, -9, 1), (1.5, 0, 0)
    yield 0.1
    yield from w.finished()
    bpy.data.objects.remove(camera)  # under the view through it
    yield 0.3
    yield from w.finished()
    w.space().region_3d.view_perspective = "PERSP"
    yield 0.1
    assert (yield from v.expect_all("without the camera")) == 1
    for material in list(bpy.data.materials):
        bpy.data.materials.remove(material)
    bpy.data.worlds.remove(scene.world)
    bpy.data.meshes.remove(bpy.data.meshes["Suzanne"])
    yield 0.1
    assert (yield from v.expect_all("without world and mesh")) == 1
    bpy.data.batch_remove(list(bpy.data.objects))
    yield 0.1
    yield from w.finished()
    assert not w.viewports()[-1].error
""")  # fmt: skip


def test_modes_and_strokes(folder):
    run(folder, """
    yield from rendered()
    suzanne = bpy.data.objects["Suzanne"]
    bpy.context.view_layer.objects.active = suzanne
    for mode in ("EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT", "TEXTURE_PAINT"):
        with w.override():
            bpy.ops.object.mode_set(mode=mode)
        yield 0.2
        if mode == "EDIT":
            edited = bmesh.from_edit_mesh(suzanne.data)
            for vertex in edited.verts:
                vertex.co.z *= 1.3
            bmesh.update_edit_mesh(suzanne.data)
            yield 0.2
        elif mode in ("SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT"):
            for step in range(5):  # a stroke over the picture's middle
                points = [
                    {"name": "", "location": (0, 0, 0), "mouse": (480 + x, 300 + 4 * step),
                     "mouse_event": (480 + x, 300 + 4 * step), "pressure": 1.0, "size": 60.0,
                     "pen_flip": False, "x_tilt": 0.0, "y_tilt": 0.0, "time": 0.01 * x,
                     "is_start": x == -40}
                    for x in range(-40, 40, 10)
                ]
                stroke = {
                    "SCULPT": bpy.ops.sculpt.brush_stroke,
                    "VERTEX_PAINT": bpy.ops.paint.vertex_paint,
                    "WEIGHT_PAINT": bpy.ops.paint.weight_paint,
                }[mode]
                with w.override():
                    stroke(stroke=points)
                yield 0.03
        with w.override():
            bpy.ops.object.mode_set(mode="OBJECT")
        yield 0.1
        assert (yield from v.expect_all("after " + mode)) == 1
""")  # fmt: skip


def test_undo_and_redo(folder):
    run(folder, """
    yield from rendered()
    for _ in range(3):  # none goes back to what was before this test, another engine
        bpy.ops.ed.undo_push(message="before")

    def steps_back_and_forth(number):
        for step in range(number):
            bpy.data.objects["Suzanne"].location.x = 0.1 * (step % 7)
            if step % 3 == 0:
                mesh = bpy.data.objects["Cube"].data
                mesh.vertices[step % 8].co.z += 0.05
                mesh.update()
            if step % 5 == 0:
                with w.override():
                    bpy.ops.mesh.primitive_cube_add(size=0.3, location=(0.2 * (step % 10), 3, 0))
            bpy.ops.ed.undo_push(message="step")
            yield 0.02 * (step % 3)
            for operator in (bpy.ops.ed.undo, bpy.ops.ed.undo, bpy.ops.ed.redo):
                with w.override():
                    if operator.poll():
                        operator()
                yield 0.02 * (step % 2)

    yield from steps_back_and_forth(12)
    before = yield from closed()
    w.space().shading.type = "RENDERED"
    yield from steps_back_and_forth(24)
    after = yield from closed()
    print("MEMORY", before, after, flush=True)
    assert after[0] - before[0] < 20e6 and after[1] <= before[1], (before, after)
    w.space().shading.type = "RENDERED"
    assert (yield from v.expect_all("after undo")) == 1
""")  # fmt: skip


def test_other_engines_and_loads_while_it_renders(folder):
    run(folder, """
    yield from rendered()
    scene.komorebi.preview_samples = 0  # for ever
    path = os.path.dirname(os.environ["KOMOREBI_SCREEN"]) + "/saved.blend"
    bpy.ops.wm.save_as_mainfile(filepath=path)
    for turn in range(6):
        w.space().shading.type = "RENDERED"
        yield 0.15 * (turn % 3)
        bpy.context.scene.render.engine = "BLENDER_WORKBENCH"
        yield 0.05
        bpy.context.scene.render.engine = "KOMOREBI"
        yield 0.1 * (turn % 2)
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=turn % 2 == 0)
        yield 0.1
        bpy.context.scene.frame_set(turn)
        if turn % 2:
            bpy.ops.wm.read_homefile(use_factory_startup=True)
            bpy.context.scene.render.engine = "KOMOREBI"
            w.space().shading.type = "RENDERED"
            yield 0.1
            bpy.ops.wm.open_mainfile(filepath=path)
    threads = (yield from closed())[1]
    w.space().shading.type = "RENDERED"
    yield 0.3
    assert (yield from closed())[1] <= threads
    bpy.context.scene.komorebi.preview_samples = 4
    yield from rendered()
    assert (yield from v.expect_all("loaded")) == 1
""")  # fmt: skip


def test_a_view_that_cannot_be_rendered_takes_nothing_with_it(folder):
    run(folder, """
    yield from rendered()
    space = w.space()
    space.clip_start, space.clip_end = 20.0, 10.0
    yield 0.3
    for _ in range(100):
        if w.viewports()[-1].error:
            break
        yield 0.1
    assert w.viewports()[-1].error
    space.clip_start, space.clip_end = 0.1, 100.0
    yield 0.1
    assert (yield from v.expect_all("as before")) == 1
    assert not w.viewports()[-1].error
""")  # fmt: skip


def test_an_engine_that_is_still_held_when_blender_frees_it(folder):
    """As threads do that tell it to draw: what it renders by ends with it all the same."""
    run(folder, """
    yield from rendered()
    scene.komorebi.preview_samples = 0  # for ever
    scene.update_tag()
    yield 0.3
    engine = w.viewports()[0]._worker._redraw.__closure__[0].cell_contents()
    w.space().shading.type = "SOLID"
    yield 0.3
    assert len(w.viewports()) == 1
    del engine
    yield from closed()
    w.space().shading.type = "RENDERED"
    yield 0.2
    engine = w.viewports()[0]._worker._redraw.__closure__[0].cell_contents()
    thread = threading.Thread(target=lambda held: time.sleep(2.0), args=(engine,))
    thread.start()
    del engine
    w.space().shading.type = "SOLID"  # the last to hold it is another thread
    yield from closed()
""")  # fmt: skip
