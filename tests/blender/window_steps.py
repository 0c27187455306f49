"""Steps in a Blender with a window: a generator that yields how long Blender may go on meanwhile.

Used inside that Blender; test_viewport.py starts it. A failed step ends Blender with code 3.
"""

import contextlib
import os
import sys
import threading
import time
import traceback

import bpy
import numpy as np


def start(steps):
    """Runs the generator `steps` from a timer, then quits; "DONE" is what a good end says."""

    def tick():
        try:
            return next(steps)
        except StopIteration:
            print("DONE", flush=True)
            bpy.ops.wm.quit_blender()
        except BaseException:
            traceback.print_exc()
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(3)  # an exception in a timer does not end Blender
        return None

    bpy.app.timers.register(tick, first_interval=0.5, persistent=True)


def view():
    """What to override the context by; looked up each time, as full screens and files replace it."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def space():
    return view()["area"].spaces.active


@contextlib.contextmanager
def override(of=None):
    """bpy.context.temp_override of view() or of another, for operators that change windows and
    areas, while viewports stand still.

    Up to Python 3.11 Blender itself crashes else, now and then: where such an operator takes what
    was overridden out of the context, it holds another thread's lock of the interpreter for its own
    (BPY_context_dict_clear_members_array), whoever's thread that is.
    """
    held = [] if sys.version_info >= (3, 12) else [v._worker for v in viewports()]
    for worker in held:
        worker.pause(True)
    end = time.monotonic() + 10.0
    while held and time.monotonic() < end:
        time.sleep(0.002)  # whoever the pause has woken waits again
        if _all_wait():
            break
    try:
        with bpy.context.temp_override(**(of or view())):
            yield
    finally:
        for worker in held:
            worker.pause(False)


def _all_wait():
    """Whether every thread but this waits for a condition, and so runs nothing of Python's."""
    frames = sys._current_frames()
    others = [t.ident for t in threading.enumerate() if t is not threading.current_thread()]
    return all(i in frames and frames[i].f_code.co_filename == threading.__file__ for i in others)


def alone():
    """The viewport fills the window, with nothing over the picture."""
    with override():
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield 0.3
    shown = space()
    shown.overlay.show_overlays = False
    shown.show_gizmo = False
    yield 0.1


def viewports():
    """The engine's live viewports, newest last."""
    import gc

    from komorebi.viewport.viewport import Viewport

    return [o for o in gc.get_objects() if type(o) is Viewport]  # what is dead has no class to ask


def finished(limit=60.0):
    """Until the picture on the screen is done, its last sample drawn."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        yield 0.05
        alive = [v for v in viewports() if v.picture is not None]
        if alive and all(v.is_done for v in alive):
            yield 0.2
            return
    states = [(v.picture, v.error) for v in viewports()]
    raise AssertionError(f"not finished: {states}, {space().shading.type}, {bpy.context.engine}")


def screen():
    """What the window shows, which is all of the display: [height, width, 3] from 0 to 1, row 0 at
    the bottom. Blender's own screenshot is black in 5.2."""
    window = bpy.context.window_manager.windows[0]
    with open(os.environ["KOMOREBI_SCREEN"], "rb") as file:
        pixels = np.frombuffer(file.read()[-4 * window.width * window.height :], np.uint8)
    return pixels.reshape(window.height, window.width, 4)[::-1, :, 2::-1].astype(np.float32) / 255
