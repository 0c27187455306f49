"""The process around the render: its lines, its end, cancelling, memory, warnings."""

import re
import sys

import bpy
import numpy as np
import support


def test_progress_lines(folder):
    """`Fra:`, `Saved:` and `Time:` as farms read them, with sample, tile, time left and memory."""
    if bpy.app.version >= (5, 0, 0):
        raise support.Skip("from 5.0 on Blender prints no Fra: lines unless --log asks for them")
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_monkey_add()
    support.small(scene, size=(320, 240), samples=100000)
    file = support.save(folder)
    text = f"""
import bpy, sys
bpy.ops.wm.open_mainfile(filepath={str(file)!r})
from komorebi import driver
passed = [0]
original = driver._run_session
class Slow:
    "The session, ended after some polls, so that the test need not wait for the samples."
    def __init__(self, session): self.session = session
    def __getattr__(self, name): return getattr(self.session, name)
    def wait(self, timeout):
        passed[0] += 1
        if passed[0] == 60: self.session.cancel()
        return self.session.wait(timeout)
driver._run_session = lambda engine, session, *rest: original(engine, Slow(session), *rest)
bpy.context.scene.render.filepath = {str(folder / "picture.png")!r}
bpy.ops.render.render(write_still=True)
"""
    done = support.script(text, folder)
    assert done.code == 0, done
    lines = [k for k in done.output.splitlines() if k.startswith("Fra:") and "Sample" in k]
    assert lines, done
    for line in lines:
        assert re.search(r"Fra:1 Mem:\S+ .*\| Time:\S+ \| ViewLayer \| Sample \d+/100000 \|", line)
        assert "Memory" in line
    assert all("Tile " in k and "Remaining " in k for k in lines[:-1]), lines
    assert "1 lamp" in lines[-1], "what lights the scene besides the world is in the statistics"
    assert "Saved: '" in done.output
    assert "Time: " in done.output
    assert len(lines) < 20, "a log must not drown"


CANCEL = """
import bpy, os, signal, threading, time, sys
scene = bpy.context.scene
bpy.ops.mesh.primitive_monkey_add()
support.small(scene, size=(640, 480), samples=1 << 20)
scene.render.filepath = {picture!r}
def press():
    global pressed
    time.sleep(1.0)
    pressed = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)
from komorebi import driver
thread = threading.Thread(target=press)
original = driver._run_session
def run(engine, session, *rest):
    thread.start()
    try:
        original(engine, session, *rest)
    finally:
        print("SAMPLES", session.progress()["fraction"], "CANCEL", time.monotonic() - pressed)
driver._run_session = run
try:
    bpy.ops.render.render(write_still=True)
except RuntimeError as error:
    print("RAISED", error)
"""


def test_cancel_takes_less_than_100_ms(folder):
    done = support.script(CANCEL.format(picture=str(folder / "picture.png")), folder, timeout=180)
    assert "CANCEL" in done.output, done
    taken = float(re.search(r"CANCEL (\S+)", done.output).group(1))
    assert taken < 0.1 * support.slowness(), done
    assert 0 <= float(re.search(r"SAMPLES (\S+)", done.output).group(1)) < 1


def test_cancelled_picture_keeps_what_is_done():
    """Blender's answer to test_break turned to True after the first pass; tiles stay."""
    from komorebi import driver

    planes = []

    class Breaking:
        def __init__(self, engine, session):
            self.engine, self.session = engine, session

        def __getattr__(self, name):
            return getattr(self.engine, name)

        def test_break(self):
            return self.session.progress()["sample"] > 0

    original_run, original_set = driver._run_session, driver.ResultWriter._write

    def run(engine, session, *rest):
        original_run(Breaking(engine, session), session, *rest)

    def write(self, session, tile, *rest):
        planes.append(session.read("Combined", *tile))
        original_set(self, session, tile, *rest)

    driver._run_session, driver.ResultWriter._write = run, write
    try:
        support.small(bpy.context.scene, size=(320, 240), samples=1 << 20)
        bpy.ops.render.render()
    finally:
        driver._run_session, driver.ResultWriter._write = original_run, original_set
    assert len(planes) == 1
    assert planes[0].shape == (240, 320, 4)
    assert (planes[0][:, :, 3] > 0).mean() > 0.9, "refined as a whole, so all is there"


def test_memory_stays_flat_over_50_renders():
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    monkey.modifiers.new("Subdivision", "SUBSURF").render_levels = 3
    plane = support.add_object("Emitter", bpy.data.meshes["Cube"])
    plane.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = plane.particle_systems[0].settings
    settings.type, settings.count = "HAIR", 300
    settings.render_type, settings.instance_object = "OBJECT", monkey
    sizes = []
    for index in range(50):
        monkey.location.x = index  # something new each time
        bpy.ops.render.render()
        sizes.append(support.resident_bytes())
    # The allocator's own ups and downs are 20 MB (flat over 200 renders); a mesh kept by each render
    # would be 4 MB each time. The least of ten renders tells.
    growth = min(sizes[40:]) - min(sizes[10:20])
    assert growth < 32 << 20, f"{growth >> 10} kB in 30 renders: {[s >> 20 for s in sizes[::5]]}"


def test_module_ends_by_itself_within_5_s(folder):
    if not support.IS_MODULE:
        raise support.Skip("for Blender as a Python module only")
    endings = {
        "nothing": "",
        "render": "import bpy\nsupport.small(bpy.context.scene)\nbpy.ops.render.render()\n",
        "error": (
            "import bpy\nsupport.small(bpy.context.scene)\n"
            "support.spoil(bpy.context.scene.camera)\n"
            "try: bpy.ops.render.render()\nexcept RuntimeError: pass\n"
        ),
        "direct": "import komorebi\nkomorebi.unregister()\nkomorebi.register()\n",
    }
    for name, text in endings.items():
        done = support.script(text + "import time; print('END', time.time())\n", folder, timeout=90)
        assert done.code == 0, (name, done)
        assert done.seconds < 5 * support.slowness(), (name, done)


def test_registering_directly_ends_too(folder):
    """`komorebi.register()` without add-on machinery."""
    if not support.IS_MODULE:
        raise support.Skip("for Blender as a Python module only")
    import komorebi

    path = folder / "direct.py"
    path.write_text(
        f"import bpy, sys\nsys.path[:0] = {sys.path!r}\nimport komorebi\nkomorebi.register()\n"
        "bpy.context.scene.render.engine = 'KOMOREBI'\nbpy.context.scene.komorebi.samples = 1\n"
        "bpy.context.scene.render.resolution_percentage = 5\nbpy.ops.render.render()\n"
    )
    assert komorebi.__file__
    done = support.process([sys.executable, path], timeout=90)
    assert done.code == 0 and done.seconds < 5 * support.slowness(), done


def test_each_warning_once_an_animation_and_a_count(folder):
    scene = bpy.context.scene
    support.add_object("Smoke", bpy.data.volumes.new("Smoke"))
    tree = scene.world.node_tree
    background = next(n for n in tree.nodes if n.type == "BACKGROUND")
    bevel = tree.nodes.new("ShaderNodeBevel")
    tree.links.new(bevel.outputs["Normal"], background.inputs["Color"])
    scene.frame_end = 3
    file = support.save(folder)
    output = folder / "picture_"
    if support.IS_MODULE:
        done = support.blender_render(file, output, "1..3")
    else:
        done = support.process([
            bpy.app.binary_path, "-b", "--factory-startup", file, "--addons", "komorebi",
            "-E", "KOMOREBI", "-o", output, "-a",
        ])  # fmt: skip
    assert done.code == 0 and len(support.pictures(folder)) == 3, done
    assert done.output.count("is a volume, not rendered yet") == 1, done
    assert done.output.count("bevels are not rendered") == 1, done
    assert "Komorebi: 2 warnings, 6 times in 3 frames" in done.output, done


def test_threads_of_the_command_line(folder):
    """-t reaches the core; the picture does not change."""
    file = support.save(folder)
    for threads in ("1", "2"):
        extra = ("-t", threads)
        done = support.blender_render(file, folder / f"t{threads}_", extra=extra)
        assert done.code == 0, done
    one, two = (support.read(folder / f"t{n}_0001.png") for n in "12")
    assert np.array_equal(one, two)


def test_persistent_data_reuses_meshes_and_never_shows_old_ones(folder):
    from komorebi import cache

    scene = bpy.context.scene
    scene.render.use_persistent_data = True
    scene.render.film_transparent = True
    cube = bpy.data.objects["Cube"]
    cache.clear()
    first = support.render(folder, "first")
    assert cache.entry_count() == 1
    before = cache.misses
    cube.location.x = 0.5
    moved = support.render(folder, "moved")
    assert cache.misses == before, "a moved object's mesh is not built again"
    assert (moved != first).any()
    for vertex in cube.data.vertices:
        vertex.co *= 0.5
    cube.data.update()
    smaller = support.render(folder, "smaller")
    assert cache.misses == before + 1
    assert smaller[:, :, 3].sum() < 0.5 * moved[:, :, 3].sum()


def test_batch_and_view_layers_share_meshes(folder):
    """Renders of one background process, and layers of one render, build a mesh once."""
    from komorebi import cache

    scene = bpy.context.scene
    scene.view_layers.new("Second")
    cache.clear()
    before = cache.misses
    support.render(folder, "first")
    assert cache.misses == before + 1
    scene.camera.location.x += 1
    support.render(folder, "second")
    assert cache.misses == before + 1, "another view builds nothing"
    bpy.data.objects["Cube"].data.vertices[0].co.x = 3
    support.render(folder, "third")
    assert cache.misses == before + 2
    support.render(folder, "fourth")
    assert cache.entry_count() == 1, "what two renders did not use is gone"


def test_normals_alone_build_no_tree(folder):
    """Also what Blender 3.4 needs, where normals differ by rounding each time they are made."""
    from komorebi import cache

    cube = bpy.data.objects["Cube"].data
    bpy.context.scene.view_layers[0].use_pass_normal = True
    cache.clear()
    before = cache.misses
    with support.captured("native_scene._native_mesh") as meshes:
        flat = support.exported_picture("Normal")
        cube.polygons.foreach_set("use_smooth", [True] * 6)
        cube.update()
        smooth = support.exported_picture("Normal")
    assert cache.misses == before + 1
    assert len(meshes) == 2
    assert meshes[1][0][-1] is meshes[0][1], "the tree of the first"
    assert not np.array_equal(flat, smooth)


def test_cache_keeps_to_its_limit():
    from komorebi import cache

    class Thing:
        byte_count = 10

    limit, cache.LIMIT_BYTES = cache.LIMIT_BYTES, 25
    try:
        cache.clear()
        for key in (b"a", b"b", b"c"):
            cache.get(key, Thing)
        cache.make_room({b"a"})
        assert cache.entry_count() == 2, "the longest unused one goes"
        before = cache.hits
        cache.get(b"a", Thing)
        cache.get(b"c", Thing)
        assert cache.hits == before + 2
        cache.LIMIT_BYTES = 15
        cache.end_job(keep=True)
        assert cache.entry_count() == 1
        cache.end_job(keep=False)
        assert cache.entry_count() == 0, "in a window nothing stays without Persistent Data"
    finally:
        cache.LIMIT_BYTES = limit
        cache.clear()


def test_dump(folder):
    path = folder / "scene.komorebi"
    assert bpy.ops.komorebi.dump(filepath=str(path)) == {"FINISHED"}
    assert path.stat().st_size > 100
    other = folder / "other.komorebi"
    done = support.blender_render(
        support.save(folder), folder / "picture_", KOMOREBI_DUMP=str(other)
    )
    assert done.code == 0 and other.stat().st_size > 100, done
    assert support.pictures(folder) == ["picture_0001.png"]


def test_stereo_renders_both_eyes(folder):
    scene = bpy.context.scene
    scene.render.use_multiview = True
    scene.render.film_transparent = True
    scene.camera.data.stereo.interocular_distance = 1.0
    with (
        support.captured("driver.export_frame") as frames,
        support.captured("driver.export_scene") as scenes,
    ):
        bpy.ops.render.render()
    assert len(scenes) == 1, "the scene is exported once, whatever the number of eyes"
    left, right = (view.camera.matrix for view in frames[0][1].views)
    assert not np.allclose(left, right)
