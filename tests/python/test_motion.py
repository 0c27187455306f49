"""Motion blur as a host hands it over: what is taken, what is refused, and that pictures show it."""

from __future__ import annotations

from typing import Any

import komorebi_core as core
import numpy as np
import pytest
import shapes

ONE = np.zeros(1, np.uint32)
VIEW = shapes.look_at((0, -8, 0), (0, 0, 0))
CAMERA = shapes.perspective(2.0, 1.0, 0.1, 100.0) @ VIEW


def shifted(x: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[0, 3] = x
    return matrix


def poses(*xs: float) -> np.ndarray:
    return np.array([shifted(x) for x in xs])


def alpha(scene: core.Scene, camera: dict[str, Any] | None = None) -> np.ndarray:
    """The middle row's coverage, of a transparent film."""
    scene.set_camera("PERSPECTIVE", CAMERA, 0.1, 100.0, 64, 64, **(camera or {}))
    scene.commit(keep_inputs=False)
    settings = core.Settings(samples=256, light_samples=1, film_transparent=True)
    picture = shapes.finish(core.Session(scene, settings)).read("Combined")
    return np.asarray(picture[32, :, 3])


def cube_scene(motion: np.ndarray | None = None, **mesh: Any) -> core.Scene:
    scene = core.Scene()
    index = scene.add_mesh(core.Mesh("cube", *shapes.cube(), **mesh))
    scene.add_instances(index, np.eye(4)[None], ONE, motion=motion)
    return scene


def test_object_camera_and_mesh_blur_alike() -> None:
    positions = shapes.cube()[0]
    step = np.array([1, 0, 0], np.float32)
    still = alpha(cube_scene())
    moved = alpha(cube_scene(poses(-1, 0, 1)[None]))
    deformed = alpha(cube_scene(motion_positions=np.stack([positions - step, positions + step])))
    world_from_camera = np.linalg.inv(VIEW)
    followed = alpha(cube_scene(), {"motion": {"matrices": poses(1, 0, -1) @ world_from_camera}})
    assert abs(still - moved).max() > 0.3
    np.testing.assert_allclose(deformed, moved, atol=1e-3)
    np.testing.assert_allclose(followed, moved, atol=1e-3)


def test_the_shutter_weighs_time() -> None:
    late = {"shutter": {"curve": np.array([0, 0, 0, 0, 1], np.float32)}}
    row = alpha(cube_scene(poses(-1, 0, 1)[None]), late)
    assert row[:32].sum() < row[32:].sum() - 5
    zoomed = alpha(
        cube_scene(),
        {
            "motion": {
                "matrices": poses(0, 0, 0) @ np.linalg.inv(VIEW),
                "zoom_open": 0.5,
                "zoom_close": 0.5,
            }
        },
    )
    assert zoomed.sum() > alpha(cube_scene()).sum() + 3


def test_rolling_shutter_leans_what_passes() -> None:
    scene = cube_scene(poses(-2, 0, 2)[None])
    scene.set_camera("PERSPECTIVE", CAMERA, 0.1, 100.0, 64, 64, shutter={"rolling_duration": 0.0})
    scene.commit()
    settings = core.Settings(samples=16, light_samples=1, film_transparent=True)
    picture = shapes.finish(core.Session(scene, settings)).read("Combined")[:, :, 3]
    columns = np.arange(64)
    centre = [(row * columns).sum() / row.sum() for row in picture[24:41]]
    assert centre[0] > centre[-1] + 2  # the top is exposed first


def vectors(scene: core.Scene, camera: dict[str, Any]) -> np.ndarray:
    """The pass of the middle pixel under a shutter that stays shut."""
    scene.set_camera(
        "PERSPECTIVE", CAMERA, 0.1, 100.0, 64, 64, shutter={"still": 1}, **camera
    )  # fmt: skip
    scene.commit(keep_inputs=False)
    settings = core.Settings(samples=4, light_samples=1, passes=("Combined", "Vector"))
    return np.asarray(shapes.finish(core.Session(scene, settings)).read("Vector")[32, 32])


def test_the_vector_pass_compares_poses_in_time() -> None:
    positions = shapes.cube()[0]
    step = np.array([0.5, 0, 0], np.float32)
    pixels = 2.0 * 32 / 7 * 0.5  # the cube's face is 7 m away
    expected = [-pixels, 0, -pixels, 0]
    moved = vectors(cube_scene(poses(-0.5, 0, 0.5)[None]), {})
    deformed = vectors(
        cube_scene(step_positions=np.stack([positions - step, positions + step])), {}
    )
    around = {"motion": {"matrices": poses(0.5, 0, -0.5) @ np.linalg.inv(VIEW)}}
    followed = vectors(cube_scene(), around)
    for result in (moved, deformed, followed):
        np.testing.assert_allclose(result, expected, atol=1e-3)
    np.testing.assert_allclose(vectors(cube_scene(), {}), np.zeros(4))
    # What moves is taken at rest.
    np.testing.assert_array_equal(
        alpha(cube_scene(poses(-1, 0, 1)[None]), {"shutter": {"still": True}}), alpha(cube_scene())
    )


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(ValueError, match="middle one"):
        cube_scene(poses(0, 1, 2)[None])
    with pytest.raises(ValueError, match="odd number"):
        cube_scene(poses(0, 0)[None])
    with pytest.raises(ValueError, match="motion must have shape"):
        cube_scene(poses(0, 0, 0))
    with pytest.raises(ValueError, match="even number of times"):
        cube_scene(motion_positions=shapes.cube()[0][None])
    with pytest.raises(ValueError, match="step_positions must have shape"):
        cube_scene(step_positions=shapes.cube()[0][None])
    scene = cube_scene()
    still = poses(0, 0, 0) @ np.linalg.inv(VIEW)
    for camera, sentence in (
        ({"motion": {}}, "needs matrices"),
        ({"motion": {"matrices": poses(0, 1, 2)}}, "not where the camera is"),
        ({"motion": {"matrices": still, "zoom": 1.0}}, "has no"),
        ({"shutter": {"curve": np.zeros(4, np.float32)}}, "shutter curve"),
        ({"shutter": {"rolling_duration": 2.0}}, "rolling shutter"),
        ({"shutter": {"rolling_duration": 0.1, "still": True}}, "stays shut"),
        ({"shutter": {"still": 1, "curve": np.ones(4, np.float32)}}, "stays shut"),
    ):
        with pytest.raises(ValueError, match=sentence):
            scene.set_camera("PERSPECTIVE", CAMERA, 0.1, 100.0, 64, 64, **camera)


def test_a_scene_that_kept_no_inputs_says_so_when_dumped(tmp_path: Any) -> None:
    scene = shapes.scene(committed=False)
    scene.commit(keep_inputs=False)
    with pytest.raises(ValueError, match="without keeping"):
        scene.dump(str(tmp_path / "scene.komorebi"), core.Settings())
