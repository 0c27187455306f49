"""Sessions from Python: memory, threads, cancelling, and pictures equal to the bit."""

from __future__ import annotations

import gc
import sys
import threading
import time
from pathlib import Path

import komorebi_core as core
import numpy as np
import pytest
import shapes


def test_the_module_says_what_it_is() -> None:
    info = core.build_info()
    assert info["version"] == core.__version__
    assert info["active_instruction_set"] in info["instruction_sets"]
    assert set(info["libraries"]) == {"OpenImageIO", "GLM", "Highway", "pybind11"}


def test_pictures_have_the_shapes_and_values_expected() -> None:
    session = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=16)))
    color, depth = session.read("Combined"), session.read("Depth")
    assert color.shape == (48, 64, 4) and color.dtype == np.float32
    assert depth.shape == (48, 64, 1) and session.read("Normal").shape == (48, 64, 3)
    assert np.isfinite(color).all() and 0.0 <= color.min() and color.max() <= 1.0
    assert color[:, :, :3].std() > 0.02  # the cube and its contact shade
    assert (color[:, :, 3] == 1.0).all()
    assert 4.0 < depth[24, 32, 0] < 9.0


def test_adaptive_sampling_says_where_the_work_went() -> None:
    settings = core.Settings(
        samples=64,
        light_samples=1,
        use_adaptive_sampling=True,
        adaptive_threshold=0.02,
        adaptive_min_samples=8,
        passes=("Combined", "Debug Sample Count"),
    )
    session = shapes.finish(core.Session(shapes.scene(), settings))
    counts = session.read("Debug Sample Count")
    assert counts.shape == (48, 64, 1) and counts.max() <= 1.0
    assert counts.min() == 8 / 64
    state = session.progress()
    assert state["mean_samples"] == np.mean(64.0 * counts)
    assert state["tile"] == state["tiles"] and state["fraction"] == 1.0
    assert session.resolved["adaptive_min_samples"] == 8
    with pytest.raises(ValueError, match="not among the settings' passes"):
        session.read("Depth")


def test_a_time_limited_render_is_repeated_by_its_count() -> None:
    limited = core.Session(shapes.scene(), core.Settings(samples=1 << 16, time_limit=0.1))
    assert limited.wait(60.0)
    samples = limited.progress()["sample"]
    assert 1 <= samples < 1 << 16
    again = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=samples)))
    assert np.array_equal(again.read("Combined"), limited.read("Combined"))


def test_row_zero_is_at_the_bottom() -> None:
    depth = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=1))).read("Depth")
    assert depth[0].mean() < depth[-1].mean()  # the ground near the camera is below


def test_a_rectangle_is_the_crop() -> None:
    session = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=2)))
    whole = session.read("Combined")
    part = session.read("Combined", 10, 5, 20, 15)
    assert np.array_equal(part, whole[5:20, 10:30])


def test_pictures_outlive_their_session() -> None:
    session = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=2)))
    picture = session.read("Combined")
    before = picture.copy()
    del session
    gc.collect()
    assert picture.flags.owndata and np.array_equal(picture, before)


def test_nothing_refers_to_the_arrays_after_the_build() -> None:
    positions, corners, offsets = shapes.cube()
    counts = [sys.getrefcount(a) for a in (positions, corners, offsets)]
    scene = core.Scene()
    mesh = core.Mesh("cube", positions, corners, offsets)
    assert [sys.getrefcount(a) for a in (positions, corners, offsets)] == counts
    scene.add_instances(scene.add_mesh(mesh), np.eye(4)[None], np.zeros(1, np.uint32))
    positions[:] = np.nan  # must not reach the scene
    camera = shapes.perspective(2.0, 1.0, 0.1, 100.0) @ shapes.look_at((5, -4, 3), (0, 0, 0))
    scene.set_camera("PERSPECTIVE", camera, 0.1, 100.0, 16, 16)
    del mesh
    scene.commit()
    depth = shapes.finish(core.Session(scene, core.Settings(samples=1))).read("Depth")
    assert depth[8, 8, 0] < 10.0


def test_the_gil_is_free_while_a_mesh_is_built() -> None:
    arrays = shapes.grid(700, 10.0)  # about a million triangles
    ticks = 0
    over = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not over.is_set():
            ticks += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    core.Mesh("grid", *arrays)
    over.set()
    thread.join()
    assert ticks > 5


def test_a_build_can_be_cancelled() -> None:
    cancel = core.Cancel()
    cancel.request()
    try:
        core.Mesh("grid", *shapes.grid(100, 10.0), cancel=cancel)
    except core.Cancelled:
        return
    raise AssertionError("the build went on")


def test_a_cancelled_render_ends_soon_and_keeps_its_tiles() -> None:
    settings = core.Settings(samples=1 << 20, tile_size=16)
    session = core.Session(shapes.scene(640, 480), settings)
    while session.progress()["sample"] < 1:
        session.wait(0.01)
    latencies = []
    for _ in range(8):  # a busy machine may take its time now and then, but not always
        start = time.monotonic()
        session.cancel()
        assert session.wait(30.0)
        latencies.append(time.monotonic() - start)
        session.resume()
        session.wait(0.05)
    session.cancel()
    assert session.wait(30.0)
    assert min(latencies) < 0.1, latencies
    assert session.error is None and 0.0 < session.progress()["fraction"] < 1.0
    assert session.read("Combined")[:, :, 3].min() == 1.0  # whole, only noisier


def test_sessions_may_be_dropped_at_any_time() -> None:
    scene = shapes.scene(320, 240)
    for _ in range(20):
        core.Session(scene, core.Settings(samples=4096))
    del scene
    gc.collect()


def test_updated_tiles_cover_the_frame_once_each() -> None:
    session = shapes.finish(core.Session(shapes.scene(), core.Settings(samples=3, tile_size=16)))
    seen = np.zeros((48, 64), int)
    for x, y, width, height in session.updated_tiles():
        seen[y : y + height, x : x + width] += 1
    assert (seen == 1).all()
    assert session.updated_tiles() == []


def test_meshes_are_shared_between_scenes_and_frames() -> None:
    mesh = core.Mesh("cube", *shapes.cube())
    pictures = []
    for _ in range(2):
        scene = core.Scene()
        scene.add_instances(scene.add_mesh(mesh), np.eye(4)[None], np.zeros(1, np.uint32))
        camera = shapes.perspective(2.0, 1.0, 0.1, 100.0) @ shapes.look_at((5, -4, 3), (0, 0, 0))
        scene.set_camera("PERSPECTIVE", camera, 0.1, 100.0, 32, 32)
        scene.commit()
        pictures.append(
            shapes.finish(core.Session(scene, core.Settings(samples=4))).read("Combined")
        )
    assert np.array_equal(*pictures)


def test_a_dump_names_the_file_it_cannot_write(tmp_path: Path) -> None:
    scene = shapes.scene()
    scene.dump(str(tmp_path / "scene.komorebi"), core.Settings())
    assert (tmp_path / "scene.komorebi").read_bytes()[:8] == b"KOMOREBI"
    try:
        scene.dump("/nowhere/scene.komorebi", core.Settings())
    except RuntimeError as error:
        assert "/nowhere/scene.komorebi" in str(error)
    else:
        raise AssertionError("written to a folder that is not there")


def test_a_scene_is_as_exact_as_can_be_where_it_is_looked_from() -> None:
    """Without an eye positions are from the middle, here 10 km off; with one pictures are those of
    a scene that has a camera of its own there."""
    where = np.array([[0.0, 0.0, 0.0], [20000.7, -9000.3, 0.1]])
    projection = shapes.perspective(2.2, 64 / 48, 0.1, 100.0)
    far, near = (
        (
            "PERSPECTIVE",
            projection @ shapes.look_at(at + np.array([6, -5, 4]), at),
            0.1,
            100.0,
            64,
            48,
        )
        for at in where
    )

    def made(eye: object = None, camera: object = None) -> core.Scene:
        scene = core.Scene()
        mesh = scene.add_mesh(core.Mesh("cube", *shapes.cube()))
        matrices = np.tile(np.eye(4), (2, 1, 1))
        matrices[:, :3, 3] = where
        scene.add_instances(mesh, matrices, np.zeros(2, np.uint32))
        scene.set_world_color((1.0, 1.0, 1.0))
        if camera is not None:
            scene.set_camera(*camera)
        if eye is not None:
            scene.set_eye(core.Camera(*eye))
        scene.commit()
        return scene

    def seen(scene: core.Scene) -> np.ndarray:
        settings = core.Settings(samples=16, passes=("Combined", "Position"))
        session = shapes.finish(core.Session(scene, settings, core.Camera(*near)))
        return np.concatenate([session.read("Combined"), session.read("Position")], axis=2)

    middle, there = made(), made(eye=near)
    assert middle.is_far_from_origin(core.Camera(*near))
    assert middle.is_far_from_origin(core.Camera(*far))
    assert there.is_far_from_origin(core.Camera(*far))
    assert not there.is_far_from_origin(core.Camera(*near))
    expected = seen(made(camera=near))
    assert np.array_equal(seen(there), expected)
    assert not np.array_equal(seen(middle), expected)
