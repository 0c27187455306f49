"""Random actions around rendered viewports in a window (under Xvfb): no crash, no thread or memory
lost, and the right picture at the end.

KOMOREBI_SOAK=1000 and KOMOREBI_SOAK_SEED=7 choose how many actions, and which; the same seed does
the same again. KOMOREBI_SOAK_ENGINE=BLENDER_WORKBENCH measures Blender's own growth.
"""

import os

import test_window

SOAK = """
import gc, inspect, os, random, threading
import addon_utils, bpy, numpy as np
import soak_actions, support, x_windows
import view_steps as v
import window_steps as w
from soak_actions import komorebi, object_mode, scene
FOLDER, NUMBER, SEED, ENGINE = {folder!r}, {number}, {seed}, {engine!r}
BASE = FOLDER + "/base.blend"
numbers = random.Random(SEED)

def begin():
    "From the file that was saved at the start, rendered."
    if not hasattr(bpy.types.Scene, "komorebi"):
        addon_utils.enable("komorebi")
    bpy.ops.wm.open_mainfile(filepath=BASE)
    yield 0.3

def look():
    scene().render.engine = ENGINE
    for view in v.views():
        v.bare(view["area"].spaces.active)
        view["area"].spaces.active.shading.type = "RENDERED"
    yield 0.1

def measure(done):
    "Nothing is rendered now: what is left is what was lost."
    yield from begin()
    for _ in range(60):  # a busy machine may draw late
        yield 0.3
        gc.collect()
        if threading.active_count() == 1:
            break
    assert not w.viewports(), w.viewports()
    assert threading.active_count() == 1, threading.enumerate()
    measured.append((done, support.resident_bytes(), v.threads()))
    print("MEASURED after %d actions: %.1f MB, %d threads" % (done, measured[-1][1] / 1e6, measured[-1][2]),
          flush=True)

def plain():
    "Whatever has been done to the scene: what a viewport and a final render show alike."
    object_mode()
    display = x_windows.Display()
    for y in (1, 0):  # Blender knows where a window is only once it moves with the size that it has
        display.place(display.windows()[0], 0, y, 960, 540)
        yield 0.2
    for each in bpy.data.objects:
        each.hide_viewport = each.hide_render = False
        for modifier in each.modifiers:
            modifier.render_levels = modifier.levels
    komorebi().preview_pause, komorebi().preview_samples, komorebi().samples = False, 4, 4
    komorebi().light_samples = 2
    scene().render.film_transparent = scene().render.use_border = False
    scene().render.preview_pixel_size = "AUTO"
    if len(v.views()) >= 4:
        with w.override():
            bpy.ops.screen.region_quadview()
        yield 0.2
    for view in v.views():
        space = view["area"].spaces.active
        space.use_render_border = False
        space.shading.use_scene_world_render = space.shading.use_scene_lights_render = True
        space.shading.komorebi.render_pass = "COMBINED"
        view["view"].view_perspective = "PERSP"
        view["view"].view_distance = 20.0
        if space.local_view is not None:
            with w.override(v.override(view)):
                bpy.ops.view3d.localview(frame_selected=False)
    scene().update_tag()
    yield from look()

def steps():
    yield 0.3
    v.prepare()
    bpy.ops.wm.save_as_mainfile(filepath=BASE)
    yield from begin()
    yield from look()
    part = max(30, NUMBER // 10)
    for done in range(1, NUMBER + 1):
        act = numbers.choice(soak_actions.ACTIONS)
        pause = numbers.choice((0.0, 0.0, 0.05, 0.2))
        print(done, act.__name__, flush=True)
        going = act(numbers)
        if inspect.isgenerator(going):
            yield from going
        if ENGINE != "KOMOREBI":
            scene().render.engine = ENGINE
        yield pause
        if done % part == 0:
            if ENGINE == "KOMOREBI":
                yield from plain()
                yield from v.expect_final_of(v.views()[0], "after %d" % done, contrast=0.0)
            yield from measure(done)
            if done == NUMBER:
                break
            yield from look()
    known = measured[len(measured) // 3]  # by then all is warm that stays
    assert measured[-1][1] - known[1] < {growth}, measured
    assert measured[-1][2] <= known[2], measured
    yield from look()
    yield from v.expect_final_of(v.views()[0], "at the end")
    yield from look()  # Blender quits with views that it renders

measured = []
w.start(steps())
"""


def soak(folder, number, seed, growth):
    text = SOAK.format(
        folder=str(folder), number=number, seed=seed, growth=growth,
        engine=os.environ.get("KOMOREBI_SOAK_ENGINE", "KOMOREBI"),
    )  # fmt: skip
    done = test_window.run(text, folder, timeout=120 + 4 * number)
    print("\n".join(x for x in done.output.splitlines() if x.startswith(("MEASURED", "COMPARED"))))


def test_random_actions(folder):
    number = int(os.environ.get("KOMOREBI_SOAK", 60))
    seed = int(os.environ.get("KOMOREBI_SOAK_SEED", 1))
    soak(folder, number, seed, growth=30e6)
