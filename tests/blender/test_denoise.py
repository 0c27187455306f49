"""Denoising: the picture, the pass that keeps the noise, and what is said where it cannot be.

The library is Blender's own in 4.5 (official build), else that of the package pyoidn; KOMOREBI_OIDN
may name another. Without any the tests of the picture are skipped, those of the refusal are not.
"""

import os
from contextlib import contextmanager

import bpy
import numpy as np
import support

VARIABLE = "KOMOREBI_OIDN"


@contextmanager
def named(path):
    before = os.environ.get(VARIABLE, "")
    os.environ[VARIABLE] = str(path)
    try:
        yield
    finally:
        os.environ[VARIABLE] = before


def library():
    from komorebi.denoise import library as oidn

    found = oidn.find()
    if found.missing:
        raise support.Skip(found.missing)
    return found.path


def corner():
    """A cube on a ground, so that there is a shadow to be noisy; samples are few."""
    scene = bpy.context.scene
    support.small(scene, size=(96, 64), samples=4)
    bpy.ops.mesh.primitive_plane_add(size=40, location=(0, 0, -1))
    return scene


def error(one, other):
    return float(np.sqrt(np.mean((one[:, :, :3] - other[:, :, :3]) ** 2)))


def test_less_noise_and_the_noisy_image_is_kept(folder):
    library()
    scene = corner()
    noisy = support.render(folder, "noisy")
    scene.komorebi.use_denoising = True
    with support.captured("compat.set_rect") as written:
        denoised = support.render(folder, "denoised")
    kept = [pixels for (_, pixels), _ in written if pixels.shape == noisy.shape]
    assert len(kept) == 2, "Combined and Noisy Image"
    assert any(np.array_equal(k, noisy) for k in kept), "the Noisy Image is the picture as it was"
    assert np.array_equal(denoised[:, :, 3], noisy[:, :, 3]), "alpha stays"
    scene.komorebi.use_denoising = False
    scene.komorebi.samples = 256
    truth = support.render(folder, "truth")
    assert error(denoised, truth) < 0.7 * error(noisy, truth), (
        error(denoised, truth), error(noisy, truth),
    )  # fmt: skip


def test_noisy_image_is_a_pass_of_blenders():
    scene = bpy.context.scene
    tree = support.compositor_tree(scene)
    node = tree.nodes.new("CompositorNodeRLayers")
    assert "Noisy Image" not in [s.name for s in node.outputs if s.enabled]
    scene.komorebi.use_denoising = True
    assert "Noisy Image" in [s.name for s in node.outputs if s.enabled]


def test_border_and_view_layers(folder):
    library()
    scene = corner()
    scene.komorebi.use_denoising = True
    scene.view_layers.new("Second")
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_max_x = 0.5
    picture = support.render(folder)
    assert picture.shape == (64, 48, 4)
    assert np.isfinite(picture).all()


def test_no_library_is_an_error_before_the_render(folder):
    scene = bpy.context.scene
    scene.komorebi.use_denoising = True
    with named(folder / "nothing"):
        from komorebi.denoise import library as oidn

        assert str(folder / "nothing") in oidn.find().missing
        with support.captured("driver._run_session") as sessions:
            try:
                support.render(folder)
            except RuntimeError as refusal:
                assert "Denoising is switched on" in str(refusal), refusal
            else:
                raise AssertionError("rendered without the denoising that was asked for")
        assert not sessions


def test_a_library_that_fails_is_an_error(folder):
    """A file that is no library, and the C library, which has none of the functions."""
    scene = bpy.context.scene
    scene.komorebi.use_denoising = True
    scene.komorebi.samples = 1
    wrong = folder / "libOpenImageDenoise.so.2"
    wrong.write_text("no library")
    for path in (wrong, "/lib/x86_64-linux-gnu/libc.so.6"):
        if not os.path.exists(path):
            continue
        with named(path):
            try:
                support.render(folder)
            except RuntimeError as refusal:
                assert "Denoising with" in str(refusal), refusal
                assert "OpenImageDenoise 2" in str(refusal), refusal
            else:
                raise AssertionError(f"rendered with {path}")


def test_panel_says_why_it_is_greyed(folder):
    """The header's checkbox can be used only with a library, or to switch it off."""
    from komorebi.ui import base, sampling

    class Layout:
        def __init__(self):
            self.enabled, self.active, self.labels = True, True, []

        def prop(self, *_, **__):
            pass

        def label(self, text):
            self.labels.append(text)

        def column(self, **_):
            return self

    class Panel:
        layout = Layout()
        column = base.KomorebiPanel.column

    panel = sampling.KOMOREBI_RENDER_PT_sampling_render_denoise
    with named(folder / "nothing"):
        here = Panel()
        panel.draw_header(here, bpy.context)
        assert not here.layout.enabled
        panel.draw(here, bpy.context)
        assert "There is no OpenImageDenoise at" in " ".join(here.layout.labels)
        bpy.context.scene.komorebi.use_denoising = True
        panel.draw_header(here, bpy.context)
        assert here.layout.enabled


def test_preferences_name_a_library(folder):
    from komorebi.denoise import library as oidn

    addon = bpy.context.preferences.addons.new()  # as switching it on in the preferences does
    addon.module = "komorebi"
    preferences = addon.preferences
    preferences.oidn_path = str(folder / "mine")
    try:
        with named(""):
            assert str(folder / "mine") in oidn.find().missing
            (folder / "mine").mkdir()
            (folder / "mine" / "libOpenImageDenoise.so.2").touch()
            assert oidn.find().path == str(folder / "mine" / "libOpenImageDenoise.so.2")
    finally:
        bpy.context.preferences.addons.remove(addon)


def test_cancel_while_denoising(folder):
    """A stop ends the worker, and the noisy picture stays."""
    import threading

    from komorebi.denoise import run
    from komorebi.errors import RenderCancelled

    denoiser = run.Denoiser("none", 1)
    threading.Timer(0.2, denoiser.request).start()
    sleeper = folder / "sleeper.py"
    sleeper.write_text("import time\ntime.sleep(60)\n")
    worker, run.WORKER = run.WORKER, str(sleeper)
    plane = np.zeros((4, 4, 4), np.float32)
    try:
        denoiser.denoise(plane, (plane, plane))
    except RenderCancelled:
        pass
    else:
        raise AssertionError("it was not stopped")
    finally:
        run.WORKER = worker
    with denoiser:
        pass
    assert denoiser._process.returncode != 0


def test_picture_after_picture_in_one_process(folder):
    """Of any size, with any guides; one that is stopped comes to nothing, and the next one does."""
    import threading

    from komorebi.denoise import run
    from komorebi.errors import RenderCancelled

    noise = np.random.default_rng(1).random((512, 512, 4)).astype(np.float32)
    flat = np.full((512, 512, 3), 0.5, np.float32)
    with run.Denoiser(library(), 2) as denoiser:
        for size in (64, 96, 96):
            for guides in range(3):
                for prefilter in run.PREFILTERS:
                    given = noise[:size, :size]
                    result = denoiser.denoise(
                        given, [flat[:size, :size]] * guides, prefilter, "BALANCED"
                    )
                    assert np.array_equal(result[:, :, 3], given[:, :, 3])
                    assert result[:, :, :3].std() < 0.5 * given[:, :, :3].std()
        process = denoiser._process
        large = np.tile(noise, (4, 4, 1))
        over = threading.Event()

        def stop():
            while not over.wait(0.05):
                denoiser.stop()

        threading.Thread(target=stop).start()
        try:
            denoiser.denoise(large, [])
        except RenderCancelled:
            pass
        else:
            raise AssertionError("it was not stopped")
        finally:
            over.set()
        denoiser.stop()  # what is not on
        assert denoiser.denoise(noise, []).shape == noise.shape
        assert denoiser._process is process and process.poll() is None
    assert process.returncode is not None
