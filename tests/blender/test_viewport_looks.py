"""What the rendered viewport (under Xvfb) offers besides a picture: its passes, noise threshold,
denoising, blurred studio lights, warnings, and views far from the middle of a scene."""

import glob
import os
from pathlib import Path

import support
import test_viewport

HERE = Path(__file__).parent

STEPS = """
def redrawn():
    scene.update_tag()
    w.view()["area"].tag_redraw()
    yield 0.1
    yield from w.finished()
    assert not the_viewport().error, the_viewport().error

def passes_of_final():
    "{source: pixels} of a final render with all passes that a viewport shows."
    import komorebi.result
    from komorebi.passes import SWITCHES
    from komorebi.viewport.viewport import PASSES
    layer, kept = bpy.context.view_layer, {}
    for switch in SWITCHES:
        if switch.exists and switch.source in PASSES.values():
            setattr(switch.place(layer), switch.prop, True)
    finish = komorebi.result.ResultWriter.finish
    def kept_finish(self, session, *arguments, **options):
        for source in set(PASSES.values()):
            kept[source] = session.read(source)
        return finish(self, session, *arguments, **options)
    komorebi.result.ResultWriter.finish = kept_finish
    final()
    komorebi.result.ResultWriter.finish = finish
    return kept

def close(shown, expected, share=0.985):
    assert shown.shape == expected.shape, (shown.shape, expected.shape)
    within = 2e-3 * np.maximum(1.0, np.abs(expected))
    same = (np.abs(shown - expected) <= within).all(axis=2)
    assert same.mean() > share, same.mean()
"""


def library():
    """One to denoise with, by name: what the add-on finds, or that of the tests' own Blender 4.5."""
    from komorebi.denoise import library as oidn

    found = oidn.find()
    if not found.missing:
        return found.path
    root = HERE.parent.parent / "build/venv/bpy"
    for path in glob.glob(str(root / "lib/python*/site-packages/bpy/lib/libOpenImageDenoise.so.2")):
        return path
    raise support.Skip(found.missing)


def run(folder, steps):
    return test_viewport.run(folder, steps, STEPS)


def test_passes_are_those_of_the_final_render(folder):
    run(folder, """
    yield 0.3
    from komorebi.viewport.viewport import PASSES
    bpy.data.objects["Suzanne"].is_shadow_catcher = False
    bpy.data.objects["Plane"].is_shadow_catcher = True
    bpy.data.objects["Suzanne"].pass_index = 3
    bpy.data.materials["Material"].pass_index = 2
    scene.world.mist_settings.start, scene.world.mist_settings.depth = 2.0, 50.0
    yield from rendered()
    shading = w.space().shading
    known = [i.identifier for i in shading.komorebi.bl_rna.properties["render_pass"].enum_items]
    assert [k for k in known if k] == list(PASSES), known
    shown = {}
    for name in PASSES:
        shading.komorebi.render_pass = name
        yield from redrawn()
        picture = the_viewport().picture.pixels
        shown[name] = picture
        screen = w.screen()
        linear = np.clip(np.broadcast_to(picture[:, :, :3], screen.shape), 0, 1)
        if picture.shape[2] == 4:
            continue  # Blender draws over what is not opaque
        display = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        off = np.abs(screen - display).max(axis=2)
        assert np.percentile(off, 99) < 4 / 255, (name, np.percentile(off, (50, 90, 99, 100)))
    expected = passes_of_final()
    del shown["COMBINED"]  # without the shadow where that is a pass of its own; others test it
    for name, picture in shown.items():
        print("PASS", name, np.ptp(picture), flush=True)
        close(picture, expected[PASSES[name]])
    for name in set(shown) - {"EMISSION", "SAMPLE_COUNT"}:
        assert np.ptp(shown[name]) > 0.0, name
""")  # fmt: skip


def test_noise_threshold_of_the_viewport(folder):
    run(folder, """
    yield 0.3
    settings = scene.komorebi
    settings.preview_samples = settings.samples = 64
    settings.light_samples = 1
    settings.use_preview_adaptive_sampling = settings.use_adaptive_sampling = True
    settings.preview_adaptive_threshold = settings.adaptive_threshold = 0.05
    settings.preview_adaptive_min_samples = settings.adaptive_min_samples = 8
    yield from rendered()
    yield from expect_final()
    w.space().shading.komorebi.render_pass = "SAMPLE_COUNT"
    yield from redrawn()
    counts = the_viewport().picture.pixels
    assert counts.min() < counts.max() < 1.0, (counts.min(), counts.max())
    settings.use_preview_adaptive_sampling = False
    yield from redrawn()
    assert (the_viewport().picture.pixels == 1.0).all()
""")  # fmt: skip


def test_denoising(folder):
    os.environ["KOMOREBI_OIDN"] = library()
    try:
        run(folder, """
    yield 0.3
    settings = scene.komorebi
    settings.preview_samples = settings.samples = 4
    settings.light_samples = 1
    scene.render.preview_pixel_size = "2"  # for time's sake
    yield from rendered()
    yield from w.finished()
    noisy = the_viewport().picture
    assert not noisy.is_denoised
    settings.preview_samples = 64
    yield from redrawn()
    truth = the_viewport().picture.pixels
    settings.preview_samples = 4
    settings.use_preview_denoising = True
    pictures = {}
    for passes in ("RGB", "RGB_ALBEDO_NORMAL"):
        settings.preview_denoising_input_passes = passes
        yield from redrawn()
        picture = the_viewport().picture
        assert picture.is_denoised and picture.sample == 4, picture
        assert np.array_equal(picture.pixels[:, :, 3], noisy.pixels[:, :, 3])
        pictures[passes] = picture.pixels
    def error(pixels):
        return float(np.sqrt(np.mean((pixels - truth)[:, :, :3] ** 2)))
    errors = {name: error(pixels) for name, pixels in pictures.items()}
    print("ERRORS", error(noisy.pixels), errors, flush=True)
    assert errors["RGB_ALBEDO_NORMAL"] < 0.6 * error(noisy.pixels), errors
    assert errors["RGB_ALBEDO_NORMAL"] < errors["RGB"], errors
""")  # fmt: skip
    finally:
        del os.environ["KOMOREBI_OIDN"]


def test_denoising_while_views_and_settings_change(folder):
    """A turned view begins with noise again, and ends denoised; nothing stays behind."""
    os.environ["KOMOREBI_OIDN"] = library()
    try:
        run(folder, """
    yield 0.3
    settings = scene.komorebi
    settings.preview_samples, settings.light_samples = 4, 1
    scene.render.preview_pixel_size = "4"
    settings.use_preview_denoising = True
    yield from rendered()
    yield from w.finished()
    import mathutils
    for turn in range(10):
        w.space().region_3d.view_rotation.rotate(mathutils.Euler((0, 0, 0.05)))
        yield 0.03 * turn
    yield from w.finished()
    assert the_viewport().picture.is_denoised
    settings.preview_denoising_start_sample = 4
    yield from redrawn()
    assert the_viewport().picture.is_denoised
    settings.use_preview_denoising = False
    yield from redrawn()
    assert not the_viewport().picture.is_denoised
    names = [t.name for t in threading.enumerate()]
    assert "komorebi-denoiser" not in names, names
    settings.use_preview_denoising = True
    yield from redrawn()
    w.space().shading.type = "SOLID"
    yield 0.3
    assert threading.active_count() == 1, threading.enumerate()
""")  # fmt: skip
    finally:
        del os.environ["KOMOREBI_OIDN"]


def test_denoising_that_fails_says_why(folder):
    os.environ["KOMOREBI_OIDN"] = str(folder / "libOpenImageDenoise.so.2")
    (folder / "libOpenImageDenoise.so.2").write_text("no library")
    try:
        run(folder, """
    yield 0.3
    scene.komorebi.use_preview_denoising = True
    yield from rendered()
    yield from w.finished()
    viewport = the_viewport()
    assert not viewport.picture.is_denoised
    said = viewport._said(viewport.picture)
    assert "Denoising with" in said and "OpenImageDenoise 2" in said, said
""")  # fmt: skip
    finally:
        del os.environ["KOMOREBI_OIDN"]


def test_studio_lights_are_blurred_behind_the_scene(folder):
    if not support.reads_image_files():
        raise support.Skip("the core can read no files of pictures here")
    run(folder, """
    yield 0.3
    scene.komorebi.method = "WORLD_LIGHT"
    yield from rendered()
    shading = w.space().shading  # its list of lights is that of its type
    shading.use_scene_world_render = False
    shading.studio_light = "forest.exr"
    shading.studiolight_background_alpha = 1.0
    shown = {}
    for blur in (0.0, 0.15, 0.5, 1.0):
        shading.studiolight_background_blur = blur
        yield from redrawn()
        shown[blur] = the_viewport().picture.pixels
    shading.komorebi.render_pass = "NORMAL"
    yield from redrawn()
    hit = (np.abs(the_viewport().picture.pixels).max(axis=2) > 0)
    sky = ~hit
    inside = hit.copy()  # without the rims, where the filter mixes both
    for _ in range(3):
        for axis in (0, 1):
            inside &= np.roll(inside, 1, axis) & np.roll(inside, -1, axis)
            sky &= np.roll(sky, 1, axis) & np.roll(sky, -1, axis)
    assert sky.mean() > 0.1 and inside.mean() > 0.1
    before, rough = shown[0.0], []
    for blur, pixels in shown.items():
        off = np.abs(pixels[inside] - before[inside])  # what lights stays sharp
        assert (off > 1e-4).mean() < 1e-4, (blur, off.max())
        steps = np.abs(np.diff(pixels[:, :, :3], axis=1))[sky[:, 1:] & sky[:, :-1]]
        rough.append(float(steps.mean()))
    assert rough[0] > 4 * rough[1] > 8 * max(rough[2:]) > 0, rough
    shading.komorebi.render_pass = "COMBINED"
    shading.studiolight_background_blur = 0.5
    shading.studiolight_background_alpha = 0.5
    yield from redrawn()
    half = the_viewport().picture.pixels
    assert np.abs(half[sky] - 0.5 * shown[0.5][sky]).max() < 2e-3
""")  # fmt: skip


def test_warnings_are_said_once(folder):
    run(folder, """
    yield 0.3
    broken = bpy.data.images.new("Nowhere", 4, 4)
    broken.source, broken.filepath = "FILE", "//nowhere.png"
    tree = bpy.data.materials["Material"].node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = broken
    tree.links.new(texture.outputs[0], tree.nodes["Principled BSDF"].inputs["Base Color"])
    scene.komorebi.method = "WORLD_LIGHT"
    yield from rendered()
    yield from w.finished()
    viewport = the_viewport()
    text = viewport._said(viewport.picture).splitlines()
    assert len(text) == 2 and text[1].startswith("1 warning: "), text
    assert "nowhere" in text[1].lower(), text
    for turn in range(5):  # edits
        bpy.data.objects["Suzanne"].location.x += 0.1
        yield 0.2
    yield from w.finished()
    assert len(viewport.notices.sentences) == 1
    tree.links.remove(tree.links[-1])
    yield 0.2
    yield from w.finished()
    assert viewport.notices.sentences == [] and "\\n" not in viewport._said(viewport.picture)
    with bpy.context.temp_override(**w.view()):
        bpy.ops.screen.screen_full_area(use_hide_panels=True)
    yield 0.3
    area = bpy.context.window_manager.windows[0].screen.areas[0]
    area.type = "INFO"
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area):
        bpy.ops.info.select_all(action="SELECT")
        bpy.ops.info.report_copy()
    reports = bpy.context.window_manager.clipboard
    print("REPORTS", reports, flush=True)
    assert reports.count("nowhere") == 1, reports
""")  # fmt: skip


def test_views_far_from_the_middle_of_the_scene(folder):
    run(folder, """
    yield 0.3
    from mathutils import Vector
    far = Vector((10000.3, -7000.7, 50.2))
    # What is surveyed of the sky is rounded otherwise from another origin: rays without a guide.
    scene.komorebi.ao_sampling = "UNIFORM"
    for name in ("Suzanne", "Plane", "Cube"):
        copy = bpy.data.objects[name].copy()
        copy.location = copy.location + far
        scene.collection.objects.link(copy)
    yield from rendered()
    space = w.space()
    yield from expect_final()
    yield from w.finished()  # without the final render's camera
    worker, view = the_viewport()._worker, space.region_3d
    first = worker._scene
    def moved(place):
        before = the_viewport().picture.view
        view.view_location, view.view_distance = place, 3.0
        while the_viewport().picture.view == before:
            yield 0.05
        yield from w.finished()
    yield from moved(far + Vector((0.5, 0, 1)))
    second = worker._scene
    assert second is not first, "another origin"
    yield from moved(far + Vector((1.5, 0, 1)))
    assert worker._scene is second, "a step aside builds nothing"
    yield from expect_final()
    shading = space.shading
    shading.komorebi.render_pass = "POSITION"
    yield from redrawn()
    pixels = the_viewport().picture.pixels
    hit = np.abs(pixels).max(axis=2) > 1000
    assert hit.mean() > 0.3
""")  # fmt: skip
