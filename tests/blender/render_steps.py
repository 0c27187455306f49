"""Final renders in a Blender with a window: started and stopped by keys, and watched meanwhile.

Used inside that Blender, beside window_steps.py; test_render_window.py starts it.
"""

import threading
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
            self._watch.seen, self._watch.seen_in = time.monotonic(), self._watch.stage
            self._watch.cpu = time.process_time()
        return stop


class Watch:
    """What the engine does in final renders, from the watch's making on."""

    def __init__(self):
        self.stage = ""  # the name of the last of STAGES that was begun; "" while none is on
        self.entered = []  # all that were
        self.frames = []  # of which `update` was called
        self.lines, self.fractions = [], []
        self.seen, self.seen_in = None, ""  # when, and in which stage, it was first told to stop
        self.cpu = 0.0  # seconds of processor time from `seen` to `left`, of the whole process
        self.left = None  # when the engine's last call returned
        self.engine = None
        self.gates = {}  # threading.Events that stages wait for at their beginning
        self.held = ""  # a stage that waits at its beginning until Esc has come through
        self.keyboard = x_keyboard.Keyboard()
        for name, module, function in STAGES:
            setattr(module, function, self._staged(name, getattr(module, function)))
        original = guard.run

        def run(engine, depsgraph, step, *args):
            if engine.is_preview:
                return original(engine, depsgraph, step, *args)
            if step == "export_frame":
                self.frames.append(depsgraph.scene.frame_current)
            self.engine = Watched(engine, self)
            try:
                return original(self.engine, depsgraph, step, *args)
            finally:
                self.left = time.monotonic()
                self.cpu = time.process_time() - self.cpu

        guard.run = run

    def _staged(self, name, function):
        def staged(*args, **kwargs):
            if "viewport" in threading.current_thread().name:
                return function(*args, **kwargs)
            before, self.stage = self.stage, name
            self.entered.append(name)
            if name in self.gates:
                assert self.gates.pop(name).wait(100), f"nobody opened the gate of {name}"
            if name == self.held:
                self.held = ""
                self.keyboard.press("Escape")
                while not self.engine.test_break():
                    time.sleep(0.005)
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

    def wait(self, limit=200.0):
        """Until no render is on."""
        yield from until(lambda: not is_rendering(), limit)

    def stop_in(self, stage, after=0.0):
        """Starts a render that Esc ends in a stage, twice.

        First the key is pressed `after` seconds into the stage, and it is printed how long it takes
        from there, and from the engine's being told, to the end. On a busy machine that may be too
        late, so then the stage waits for it: whatever comes next must not be begun.
        """
        yield from self.begin("F12")
        yield from until(lambda: self.stage == stage)
        yield after
        pressed = time.monotonic()
        self.keyboard.press("Escape")
        yield from self.wait()
        if self.seen is not None:
            print(
                f"STOPPED in {stage}: {1e3 * (self.left - pressed):.0f} ms after the key, in "
                f"{self.seen_in} {1e3 * (self.left - self.seen):.0f} ms after the engine saw it "
                f"({1e3 * self.cpu:.0f} ms of processor time)",
                flush=True,
            )
        self.held = stage
        yield from self.begin("F12")
        yield from self.wait()
        assert not self.held and self.seen is not None, self.entered
        assert self.entered[-1] == stage, f"{stage} was not given up: {self.entered}"


def is_rendering():
    return bpy.app.is_job_running("RENDER")


def until(holds, limit=100.0):
    end = time.monotonic() + limit
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        yield 0.005
