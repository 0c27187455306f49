"""Final renders in a Blender with a window: started and stopped by keys, and watched meanwhile.

Used inside that Blender, beside window_steps.py; test_render_window.py starts it.
"""

import time

import bpy
import x_keyboard
from komorebi import driver, guard, native_scene, native_texture, native_world

STAGES = (
    ("exporting", driver, "export_scene"),
    ("building", native_scene, "_mesh"),
    ("textures", native_texture, "load"),
    ("world", native_world, "load"),
    ("rendering", driver, "_run_session"),
    ("denoising", driver, "_denoised"),
)


class Watched:
    """The engine, with what it tells and what it is told noted in a Watch."""

    def __init__(self, engine, watch):
        object.__setattr__(self, "_engine", engine)
        object.__setattr__(self, "_watch", watch)

    def __getattr__(self, name):
        return getattr(self._engine, name)

    def __setattr__(self, name, value):
        setattr(self._engine, name, value)

    def update_stats(self, stats, info):
        self._watch.lines.append((time.monotonic(), info))
        self._engine.update_stats(stats, info)

    def update_progress(self, fraction):
        self._watch.fractions.append(fraction)
        self._engine.update_progress(fraction)

    def test_break(self):
        stop = self._engine.test_break()
        if stop and self._watch.seen is None:
            self._watch.seen = time.monotonic()
        return stop


class Watch:
    """What the engine does in final renders, from the watch's making on."""

    def __init__(self):
        self.stage = ""  # the name of the last of STAGES that was begun; "" while none is on
        self.entered = []  # all that were
        self.frames = []  # of which `update` was called
        self.lines, self.fractions = [], []
        self.seen = None  # when the engine was first told to stop
        self.left = None  # when the engine's last call returned
        self.keyboard = x_keyboard.Keyboard()
        for name, module, function in STAGES:
            setattr(module, function, self._staged(name, getattr(module, function)))
        original = guard.run

        def run(engine, depsgraph, step, *args):
            if engine.is_preview:
                return original(engine, depsgraph, step, *args)
            if step == "export_frame":
                self.frames.append(depsgraph.scene.frame_current)
            try:
                return original(Watched(engine, self), depsgraph, step, *args)
            finally:
                self.left = time.monotonic()

        guard.run = run

    def _staged(self, name, function):
        def staged(*args, **kwargs):
            before, self.stage = self.stage, name
            self.entered.append(name)
            try:
                return function(*args, **kwargs)
            finally:
                self.stage = before

        return staged

    def begin(self, *keys):
        """Presses keys that start a render, and waits until it is on."""
        self.entered.clear()
        self.frames.clear()
        self.lines.clear()
        self.fractions.clear()
        self.seen = self.left = None
        self.keyboard.press(*keys)
        yield from until(is_rendering)

    def wait(self, limit=60.0):
        """Until no render is on."""
        yield from until(lambda: not is_rendering(), limit)

    def stop_in(self, stage, after=0.0):
        """Starts a render, presses Esc `after` seconds into a stage, and waits for the end; prints
        how long that took from the key's being pressed, and from the engine's being told."""
        yield from self.begin("F12")
        yield from until(lambda: self.stage == stage)
        yield after
        assert self.stage == stage, f"{stage} was over too soon: {self.stage}"
        pressed = time.monotonic()
        self.keyboard.press("Escape")
        yield from self.wait()
        assert self.seen is not None, f"{stage} ended by itself: {self.entered}"
        print(
            f"STOPPED {stage}: {1e3 * (self.left - pressed):.0f} ms after the key, "
            f"{1e3 * (self.left - self.seen):.0f} ms after the engine saw it",
            flush=True,
        )


def is_rendering():
    return bpy.app.is_job_running("RENDER")


def until(holds, limit=60.0):
    end = time.monotonic() + limit
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        yield 0.005
