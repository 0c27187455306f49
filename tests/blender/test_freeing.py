"""What outlives a frame is gone when nothing can ask for it again, and the memory with it."""

import bpy
import support
import test_window
from komorebi import cache

SIDE = 600  # quads along a side of the mesh: 42 MB with its tree


def large_scene(persistent):
    """Rendered once, so that something is kept."""
    scene = support.fresh_scene(size=(16, 12), samples=1)
    scene.render.use_persistent_data = persistent
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=SIDE, y_subdivisions=SIDE)
    bpy.ops.render.render()
    assert cache.byte_count() > SIDE * SIDE * 2 * 29
    return scene


def update():
    """Blender says what has changed, as it does in a window after each step of a user."""
    bpy.context.view_layer.update()


def test_another_engine_frees_all():
    for persistent in (True, False):
        scene = large_scene(persistent)
        kept, before = cache.byte_count(), support.resident_bytes()
        scene.render.engine = "CYCLES"
        update()
        assert cache.byte_count() == 0 and cache.entry_count() == 0
        freed = before - support.resident_bytes()
        assert freed > 0.8 * kept, f"{freed} of {kept} bytes"


def test_persistent_data_off_frees_all():
    scene = large_scene(persistent=True)
    kept, before = cache.byte_count(), support.resident_bytes()
    update()
    assert cache.byte_count() == kept, "nothing has been switched off yet"
    scene.render.use_persistent_data = False
    update()
    assert cache.byte_count() == 0
    freed = before - support.resident_bytes()
    assert freed > 0.8 * kept, f"{freed} of {kept} bytes"


def test_another_file_frees_all(folder):
    large_scene(persistent=True)
    path = support.save(folder)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert cache.byte_count() == 0
    bpy.ops.render.render()
    assert cache.byte_count() > 0
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert cache.byte_count() == 0


def test_a_batch_without_persistent_data_keeps_its_meshes():
    scene = large_scene(persistent=False)
    kept = cache.byte_count()
    scene.camera.location.x += 1
    update()
    assert cache.byte_count() == kept


def test_the_last_scene_of_ours_counts():
    scene = large_scene(persistent=True)
    other = bpy.data.scenes.new("Other")
    other.render.engine, other.render.use_persistent_data = "KOMOREBI", True
    scene.render.engine = "CYCLES"
    update()
    assert cache.byte_count() > 0
    bpy.data.scenes.remove(other)
    scene.camera.location.x += 1
    update()
    assert cache.byte_count() == 0


def test_the_next_render_of_another_engine_frees_all():
    """A script that switches to another engine tells nobody before it renders."""
    scene = large_scene(persistent=False)
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    bpy.ops.render.render()
    assert cache.byte_count() == 0


def test_addon_off_frees_all():
    import addon_utils

    large_scene(persistent=True)
    addon_utils.disable("komorebi")
    try:
        assert cache.byte_count() == 0
    finally:
        support.enable()


WINDOW = """
import bpy
from komorebi import cache
scene = bpy.context.scene
support.small(scene, size=(16, 12), samples=1)
settings = scene.render

def render():
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.render.render("INVOKE_DEFAULT")

def switch(name, value):
    return lambda: setattr(settings, name, value)

steps = [
    ("without", render),
    ("on", switch("use_persistent_data", True)), ("with", render),
    ("off", switch("use_persistent_data", False)),
    ("on again", switch("use_persistent_data", True)), ("with again", render),
    ("cycles", switch("engine", "CYCLES")),
]
last = None
def step():
    global last
    if bpy.app.is_job_running("RENDER"):
        return 0.05
    if last is not None:
        print("KEPT", last + ":", cache.byte_count(), flush=True)
    if not steps:
        print("DONE", flush=True)
        bpy.ops.wm.quit_blender()
        return None
    last, act = steps.pop(0)
    act()
    return 0.4
bpy.app.timers.register(step, first_interval=1.0, persistent=True)
"""


def test_a_window_keeps_what_persistent_data_asks_for(folder):
    done = test_window.run(WINDOW, folder)
    said = [k.removeprefix("KEPT ") for k in done.output.splitlines() if k.startswith("KEPT ")]
    kept = {name: int(count) for name, count in (k.rsplit(": ", 1) for k in said)}
    assert kept["with"] > 0 and kept["with again"] > 0, kept
    assert kept["without"] == kept["off"] == kept["on again"] == kept["cycles"] == 0, kept
