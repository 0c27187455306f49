"""How a viewport's pictures become finer (under Xvfb): which follow one another, what waits while a
view or a scene is in motion, and what that leaves to Blender's own threads."""

import test_viewport
from komorebi.viewport import refinement

STEPS = """
import os, time
import support
from komorebi.viewport import refinement, worker
from komorebi.viewport.worker import Worker
shown, begun = [], []
show, render_at = Worker._show_picture, Worker._render_at

def noted_show(self, picture):
    shown.append((picture.pixel, picture.sample, picture.serial))
    show(self, picture)

def noted_render_at(self, view, pixel, settings, is_final, gives_way):
    with self._condition:
        wanted = self._wanted
        if self._serial == wanted.serial:  # else it ends at once
            rested = time.monotonic() - wanted.since
            begun.append((pixel, self._serial, gives_way, wanted.is_motion, rested))
    return render_at(self, view, pixel, settings, is_final, gives_way)

Worker._show_picture, Worker._render_at = noted_show, noted_render_at

def until(holds, limit=60.0):
    end = time.monotonic() + limit
    while not holds():
        assert time.monotonic() < end, "waited in vain"
        yield 0.02

def turn(angle=0.5):
    w.space().region_3d.view_rotation.rotate(__import__("mathutils").Euler((0, 0, angle)))
    w.view()["area"].tag_redraw()

def turned(angle=0.5):
    "The pictures from a turn of the view on to the end."
    yield 1.1 * refinement.MOTION_SECONDS
    del shown[:]
    turn(angle)
    yield from until(lambda: shown)
    yield from w.finished()
    last = [entry for entry in shown if entry[2] == shown[-1][2]]
    assert last[-1][:2] == (1, scene.komorebi.preview_samples), shown
    return last

def nice(but=()):
    "The nice values of all threads but some, by their ids."
    values = {}
    for task in sorted({int(name) for name in os.listdir("/proc/self/task")} - set(but)):
        try:
            with open(f"/proc/self/task/{task}/stat") as file:
                values[task] = int(file.read().rpartition(")")[2].split()[16])
        except OSError:  # it has ended meanwhile
            pass
    return values
"""


def run(folder, steps):
    return test_viewport.run(folder, steps, STEPS)


def test_how_wide_pixels_are():
    first, following = refinement.first_pixel, refinement.next_pixel
    # As long as nobody knows what a pixel costs, the first picture is the coarsest.
    assert first(960, 540, 256, 1) == 4 and first(960, 540, 128, 1) == 8
    assert first(540, 960, 64, 2) == 16 and first(200, 100, 256, 2) == 2
    # Then the finest that comes in time, and never one that is coarser.
    in_time = refinement.FIRST_SECONDS / (960 * 540)
    for final in (1, 2):
        assert first(960, 540, 128, final, 0.9 * in_time * final**2) == final
        assert first(960, 540, 128, final, 1.1 * in_time * final**2) == 2 * final
        assert first(960, 540, 128, final, 1.0) == first(960, 540, 128, final)
    assert first(960, 540, 128, 1, 0.9 * 16 * in_time) == 4
    # The next one is the finest that comes in time, at least twice as fine.
    step = refinement.STEP_SECONDS
    assert following(16, 1.1 * step, 1) == 8 and following(16, 0.3 * step, 1) == 8
    assert following(16, 0.05 * step, 1) == 4
    assert following(16, 0.9 * step / 256 / refinement.FINE_SHARE, 1) == 1
    assert following(16, 1.1 * step / 256 / refinement.FINE_SHARE, 1) == 2
    assert following(16, 1.1 * step / 256 / refinement.FINE_SHARE, 2) == 2
    assert following(2, 100.0, 1) == 1 and following(2, 100.0, 2) == 2
    # Redraws become rarer: ten a second at first, one a second in the end.
    times = [refinement.redraw_seconds(elapsed) for elapsed in (0.0, 0.4, 2.0, 4.0, 1000.0)]
    assert times == [0.1, 0.1, 0.5, 1.0, 1.0], times


def test_pictures_become_finer(folder):
    run(folder, """
    yield 0.3
    scene.komorebi.light_samples = 8  # the first fine picture has fewer
    scene.komorebi.preview_start_resolution = 64
    refinement.FIRST_SECONDS = refinement.STEP_SECONDS = 0.0  # as if nothing were quick
    yield from rendered()
    yield from w.finished()
    last = yield from turned()
    pixels = [pixel for pixel, _, _ in last]
    assert pixels[:5] == [16, 8, 4, 2, 1] and set(pixels[5:]) == {1}, shown
    assert last[4][:2] == (1, 0), shown  # all pixels, before the first sample
    refinement.STEP_SECONDS = 1000.0  # as if all were
    last = yield from turned()
    assert [entry[:2] for entry in last[:2]] == [(16, 0), (1, 0)], shown
    assert {pixel for pixel, _, _ in last[2:]} == {1}, shown
    refinement.FIRST_SECONDS = 1000.0
    the_viewport()._worker._cost = 0.0
    last = yield from turned()
    assert last[0][:2] == (1, 0) and {pixel for pixel, _, _ in last} == {1}, shown
    assert the_viewport()._worker._cost > 0.0  # what it took is known, lest the next one be as fine and late
    # As it is: no coarser at first, and each picture finer than the one before.
    refinement.FIRST_SECONDS, refinement.STEP_SECONDS = 0.01, 0.35
    last = yield from turned()
    pixels = [pixel for pixel, _, _ in last]
    assert pixels[0] <= 16 and (1, 0) in {entry[:2] for entry in last}, shown
    assert all(b <= a // 2 for a, b in zip(pixels, pixels[1:]) if a > 1), shown
    yield from expect_final()
""")  # fmt: skip


def test_in_a_motion_nothing_finer_is_begun(folder):
    run(folder, """
    yield 0.3
    scene.komorebi.preview_start_resolution = 64
    refinement.FIRST_SECONDS = 0.0  # so that there is something finer
    yield from rendered()
    yield from w.finished()
    rest = worker.REST_SECONDS

    def motion(number, pause):
        "Views that follow one another; how many of them had their first picture."
        del begun[:], shown[:]
        for _ in range(number):
            turn(0.02)
            yield pause
        return len({serial for *_, serial in shown})

    # A motion that never ends and never rests.
    worker.MOTION_SECONDS, worker.REST_SECONDS = 1000.0, 1000.0
    seen = yield from motion(20, 0.05)
    yield 1.0
    assert seen >= 3 and {pixel for pixel, _, _ in shown} == {16}, shown
    assert begun and all(pixel == 16 for pixel, *_ in begun), begun
    assert begun[-1][1] == shown[-1][2] == the_viewport()._worker._wanted.serial, begun
    # One more view takes the place of the one that waits, and so does another scene.
    for change in (turn, lambda: setattr(bpy.data.objects["Suzanne"].location, "x", 0.5)):
        before = shown[-1][2]
        change()
        yield from until(lambda: shown[-1][2] > before)
        assert shown[-1][0] == 16, shown
    # A change that is no motion: on to the end.
    worker.MOTION_SECONDS = 0.0
    turn()
    yield from expect_final()
    assert shown[-1][0] == 1, shown
    # As it is: what is finer waits until nothing has come for a while.
    worker.MOTION_SECONDS, worker.REST_SECONDS = 1000.0, rest
    yield from motion(40, 0.02)
    yield from w.finished()
    finer = [entry for entry in begun if entry[2]]
    assert finer and all(moves and rested >= rest - 1e-3 for *_, moves, rested in finer), begun
    yield from expect_final()
""")  # fmt: skip


def test_blenders_own_threads_come_first(folder):
    run(folder, """
    if not os.path.exists("/proc/self/task"):
        print("SKIPPED", flush=True)
        return
    yield 0.3
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.komorebi.preview_samples = 0  # for ever
    before = nice()  # of Mesa's threads one has a low priority of its own
    yield from rendered()
    yield from until(lambda: shown and shown[-1][0] == 1 and shown[-1][1] >= 4)
    values = nice()
    assert values[os.getpid()] == 0, values
    assert all(values[task] == value for task, value in before.items() if task in values)
    assert sum(value > 0 for value in nice(before).values()) >= 2, (before, values)
    w.space().shading.type = "SOLID"
    yield from until(lambda: not w.viewports())
    yield from until(lambda: not any(nice(before).values()))
    # A final render's threads are as any others.
    from komorebi_core import Session
    during, wait = [], Session.wait
    def noted_wait(self, seconds):
        during.append(nice(before))
        return wait(self, seconds)
    Session.wait = noted_wait
    scene.komorebi.samples = 64
    scene.render.resolution_percentage = 20
    bpy.ops.render.render()
    Session.wait = wait
    assert any(len(values) >= 2 for values in during), during
    assert not any(any(values.values()) for values in during), during
""")  # fmt: skip
