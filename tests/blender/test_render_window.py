"""The final render in a window (under Xvfb), as a person has it: F12, Esc, an animation, edits.

Keys are pressed through the X server (x_keyboard.py). How long Esc takes is printed, not asserted;
that work was given up, and not finished, is.
"""

import re
from pathlib import Path

import support
import test_window

SCENE = """
import bpy, numpy as np, os, threading
import render_steps, window_steps as w
from render_steps import is_rendering, until
bpy.context.preferences.view.show_splash = False
FOLDER = {folder!r}
scene = bpy.context.scene
settings = scene.komorebi
support.small(scene, size=(320, 240), samples=4)
settings.preview_samples = 2
scene.render.threads_mode, scene.render.threads = "FIXED", 2
bpy.ops.mesh.primitive_monkey_add(location=(0, 0, 2))
bpy.ops.mesh.primitive_plane_add(size=10, location=(0, 0, -1))
watch = render_steps.Watch()

def saved(name):
    "The render result's pixels, by a float EXR."
    how = scene.render.image_settings
    how.file_format, how.color_mode, how.color_depth = "OPEN_EXR", "RGBA", "32"
    path = FOLDER + "/" + name + ".exr"
    bpy.data.images["Render Result"].save_render(path)
    return support.read(path)
"""


def run(folder, steps, **environment):
    text = SCENE.format(folder=str(folder)) + "\ndef steps():\n    yield 0.5\n" + steps
    return test_window.run(text + "\nw.start(steps())\n", folder, timeout=300, **environment)


def test_tiles_appear_from_the_centre_out(folder):
    run(folder, """
    from komorebi.result import ResultWriter
    scene.render.threads = 1  # else two are on their way at a time
    settings.use_progressive, settings.samples = False, 128
    shown, written = [], []
    show, write = ResultWriter.show, ResultWriter._write
    def noted_show(self, session, tiles):
        shown.extend(tiles)
        show(self, session, tiles)
    def noted_write(self, session, tile, *rest):
        written.append(tile)
        write(self, session, tile, *rest)
    ResultWriter.show, ResultWriter._write = noted_show, noted_write
    yield from watch.begin("F12")
    yield from watch.wait()
    assert len(shown) >= 20 and len(written) > 3, (len(shown), len(written))
    def distance(tile):
        x, y, width, height = tile
        return (x + width / 2 - 160) ** 2 + (y + height / 2 - 120) ** 2
    distances = [distance(tile) for tile in shown]
    assert distances == sorted(distances), shown
    assert distance(written[0]) < 64 ** 2, written
    assert tuple(written[-1]) == (0, 0, 320, 240), written
    pixels = saved("tiles")
    settings.use_progressive = True
    scene.render.threads = 2
    bpy.ops.render.render()
    assert np.array_equal(saved("passes"), pixels), "the order of work shows in the picture"
""")  # fmt: skip


def test_the_status_line_tells_progress_and_time_left(folder):
    done = run(folder, """
    settings.samples = 150
    yield from watch.begin("F12")
    yield from watch.wait()
    infos = [info for _, info in watch.lines]
    assert "Exporting" in infos[0] and "Building" in infos[1], infos[:3]
    for time, info in watch.lines:
        print("LINE", time, info, flush=True)
    assert watch.fractions == sorted(watch.fractions), watch.fractions
    assert watch.fractions[0] < 0.5 and watch.fractions[-1] == 1.0, watch.fractions
""")  # fmt: skip
    lines = re.findall(
        r"LINE (\S+) .*Sample (\d+)/150 \| Tile \d+/\d+ \| Remaining (\S+)", done.output
    )
    assert len(lines) >= 3, done
    samples = [int(sample) for _, sample, _ in lines]
    assert samples == sorted(samples)
    end = float(re.findall(r"LINE (\S+) .*M rays", done.output)[-1])
    for time, sample, remaining in lines:
        minutes, seconds = remaining.split(":")
        foreseen = float(time) + 60 * int(minutes) + float(seconds)
        print(f"at sample {sample}: {foreseen - end:+.2f} s beside the end")
    assert not any("unknown" in remaining for _, _, remaining in lines)


def oidn():
    """A library to denoise with: the add-on's own choice, else that of the tests' Blender 4.5."""
    from komorebi.denoise import library

    if not library.find().missing:
        return None  # as it is
    venv = Path(__file__).parents[2] / "build" / "venv" / "bpy"
    found = sorted(venv.glob("lib/python*/site-packages/bpy/lib/libOpenImageDenoise.so*"))
    return str(found[0]) if found else ""


def test_escape_ends_every_stage(folder):
    library = oidn()
    environment = {"KOMOREBI_OIDN": library} if library else {}
    has_files = support.reads_image_files()
    done = run(folder, f"    HAS_OIDN, HAS_FILES = {library != ''}, {has_files}" + """
    width, height = 4096, 2048
    noise = bpy.data.images.new("noise", width, height, float_buffer=True)
    noise.pixels.foreach_set(np.random.default_rng(1).random(4 * width * height, np.float32))
    noise.filepath_raw, noise.file_format = FOLDER + "/noise.exr", "OPEN_EXR"
    noise.save()
    bpy.data.images.remove(noise)

    settings.samples = 1 << 20
    yield from watch.begin("F12")
    yield from until(lambda: any("Sample 1/" in info for _, info in watch.lines))
    watch.keyboard.press("Escape")
    yield from watch.wait()
    assert (saved("stopped")[:, :, 3] == 1).mean() > 0.9, "what was there is kept"
    yield from watch.stop_in("rendering", 0.3)

    bpy.ops.mesh.primitive_grid_add(x_subdivisions=1000, y_subdivisions=1000, size=8)
    grid = bpy.context.object
    grid.hide_viewport = True
    yield from watch.stop_in("building")
    bpy.data.objects.remove(grid)

    bpy.ops.mesh.primitive_grid_add(x_subdivisions=300, y_subdivisions=300, size=8)
    grid = bpy.context.object
    grid.instance_type = "VERTS"
    grid.hide_viewport = True  # Blender's own viewport would draw them all
    bpy.data.objects["Cube"].parent = grid
    yield from watch.stop_in("exporting", 0.1)
    bpy.data.objects.remove(grid)

    if HAS_FILES:
        image = bpy.data.images.load(FOLDER + "/noise.exr")
        node = support.link_environment(image)
        settings.method = "WORLD_LIGHT"
        yield from watch.stop_in("world", 0.1)
        node.id_data.nodes.remove(node)

        settings.surface, settings.bounces = "MATERIAL", 1
        tree = bpy.data.materials["Material"].node_tree
        picture = tree.nodes.new("ShaderNodeTexImage")
        picture.image = image
        tree.links.new(picture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
        yield from watch.stop_in("textures", 0.1)
        tree.nodes.remove(picture)

    if not HAS_OIDN:
        return
    settings.samples, settings.use_denoising = 1, True
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    yield from watch.stop_in("denoising")
""", **environment)  # fmt: skip
    print(*re.findall("STOPPED.*", done.output), sep="\n")
    missing = [] if has_files else ["files of pictures to read"]
    missing += ["Open Image Denoise"] if library == "" else []
    if missing:
        raise support.Skip(f"the rest is tested; here are no {' and no '.join(missing)} to stop")


def test_an_animation_runs_and_escape_ends_it(folder):
    run(folder, """
    monkey = bpy.data.objects["Suzanne"]
    for frame, x in ((1, -2.0), (5, 2.0)):
        monkey.location.x = x
        monkey.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 5
    scene.frame_set(2)
    how = scene.render.image_settings
    how.file_format, how.color_mode, how.color_depth = "OPEN_EXR", "RGBA", "32"
    scene.render.filepath = FOLDER + "/frame_"
    def files():
        return sorted(f for f in os.listdir(FOLDER) if f.startswith("frame_"))
    yield from watch.begin("Control", "F12")
    yield from watch.wait()
    assert watch.frames == [1, 2, 3, 4, 5], watch.frames
    assert files() == [f"frame_{k:04}.exr" for k in range(1, 6)], files()
    assert scene.frame_current == 2, scene.frame_current
    for frame in (1, 4):
        scene.frame_set(frame)
        bpy.ops.render.render()
        assert np.array_equal(saved("still"), support.read(f"{FOLDER}/frame_{frame:04}.exr"))
    for file in files():
        os.remove(FOLDER + "/" + file)
    settings.samples, scene.frame_end = 64, 500
    yield from watch.begin("Control", "F12")
    yield from until(lambda: len(watch.frames) == 3 and watch.stage == "rendering")
    watch.keyboard.press("Escape")
    yield from watch.wait()
    assert watch.frames == [1, 2, 3] and len(files()) == 2, (watch.frames, files())
""")  # fmt: skip


EDITS = """
    yield from w.alone()
    w.space().shading.type = SHADING
    scene.render.use_lock_interface = LOCK
    monkey, cube = bpy.data.objects["Suzanne"], bpy.data.objects["Cube"]
    scene.render.use_persistent_data = True
    settings.surface = "MATERIAL"
    settings.method = "WORLD_LIGHT"
    image = bpy.data.images.new("checks", 64, 64)
    image.generated_type = "COLOR_GRID"
    support.link_environment(image)
    settings.samples = 32
    bpy.ops.render.render()
    expected = saved("expected")

    def edits():
        "One after the other, over and over; each leaves the scene another one."
        for turn in range(1000):
            monkey.location.x += 0.1
            yield
            for vertex in cube.data.vertices:
                vertex.co *= 1.01
            cube.data.update()
            yield
            monkey.data.clear_geometry()
            monkey.data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, turn)], [], [(0, 1, 2)])
            yield
            copy = bpy.data.objects.new("Copy", cube.data.copy())
            scene.collection.objects.link(copy)
            yield
            bpy.data.meshes.remove(copy.data)
            yield
            material = bpy.data.materials.new("New")
            cube.data.materials.clear()
            cube.data.materials.append(material)
            yield
            bpy.data.materials.remove(material)
            image.generated_color = (turn % 2, 0.5, 0.5, 1)
            image.generated_width = 32 + turn % 64
            yield
            scene.camera.location.x += 0.1
            scene.camera.data.lens = 35 + turn % 10
            settings.seed += 1
            yield
            scene.frame_set(1 + turn % 50)
            bpy.context.view_layer.update()
            yield

    gate = watch.gates["building"] = threading.Event()  # between export and all else
    yield from watch.begin("F12")
    yield from until(lambda: watch.stage == "building")
    made = 0
    editing = edits()
    while is_rendering():
        next(editing)
        made += 1
        for window in bpy.context.window_manager.windows:  # as a mouse that passes over it does
            for area in window.screen.areas:
                area.tag_redraw()
        if made == 9:  # one of each
            gate.set()
        yield 0.01
    assert made > 9, made
    pixels = saved("edited")
    assert np.array_equal(pixels, expected), (np.abs(pixels - expected).mean(), made)
    bpy.ops.render.render()  # the scene as it is now, of which nothing was kept that is old
    assert not np.array_equal(saved("after"), expected)
"""


def test_edits_while_it_renders_stay_out_of_the_picture(folder):
    run(folder, EDITS.replace("LOCK", "False").replace("SHADING", '"RENDERED"'))


def test_lock_interface(folder):
    run(folder, EDITS.replace("LOCK", "True").replace("SHADING", '"RENDERED"'))
