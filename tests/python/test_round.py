"""Curves and points through the module: what is refused, and that they are rendered and dumped."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import komorebi_core as core
import numpy as np
import pytest
import shapes

KEYS = np.array([[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1], [2, 1, 1]], np.float32)
RADII = np.full(5, 0.1, np.float32)
OFFSETS = np.array([0, 3, 5], np.int32)


def changed(array: np.ndarray, index: Any, value: float) -> np.ndarray:
    result = array.copy()
    result[index] = value
    return result


BAD_CURVES = {
    "dtype": ({"positions": KEYS.astype(np.float64)}, "positions must have dtype float32"),
    "shape": ({"radii": RADII[:, None]}, r"radii must have shape \(any\)"),
    "not finite": ({"positions": changed(KEYS, (1, 2), np.nan)}, "1 position is not finite"),
    "radii": ({"radii": RADII[1:].copy()}, "radii must have one entry a key"),
    "negative": (
        {"radii": changed(changed(RADII, 1, -0.1), 3, np.inf)},
        "2 radii are negative or not finite",
    ),
    "offsets": ({"curve_offsets": OFFSETS[:-1].copy()}, "must run from 0 to the number of keys, 5"),
    "no offsets": ({"curve_offsets": OFFSETS[:0]}, "curve_offsets needs at least one entry"),
    "falling": ({"curve_offsets": np.array([0, 4, 3, 5], np.int32)}, "1 curve ends before"),
    "out of range": ({"curve_offsets": np.array([0, 9, 5], np.int32)}, "1 curve ends before"),
    "style": ({"shape": "TUBES"}, "RIBBONS, THICK or THICK_LINEAR, not TUBES"),
    "subdivisions": ({"subdivisions": 20}, "subdivisions must be at most 8"),
    "slots": ({"curve_materials": np.zeros(3, np.int32)}, "curve_materials must have one entry"),
    "slot": ({"curve_materials": np.array([0, -1], np.int32)}, "1 curve has a material slot out"),
    "uvs": ({"curve_uvs": np.zeros((1, 2), np.float32)}, "curve_uvs must have one row a curve"),
}


@pytest.mark.parametrize("case", BAD_CURVES)
def test_bad_curves_are_refused_by_name(case: str) -> None:
    wrong, sentence = BAD_CURVES[case]
    arguments = {"positions": KEYS, "radii": RADII, "curve_offsets": OFFSETS, **wrong}
    with pytest.raises(ValueError, match=sentence) as caught:
        core.Mesh.from_curves("Fur", **arguments)
    if case != "style":
        assert 'curves "Fur"' in str(caught.value)


def test_bad_points_are_refused_by_name() -> None:
    with pytest.raises(ValueError, match='points "Cloud": 2 positions are not finite'):
        core.Mesh.from_points("Cloud", changed(KEYS, [1, 2], np.inf), RADII)
    with pytest.raises(ValueError, match='points "Cloud": 1 radius is negative or not finite'):
        core.Mesh.from_points("Cloud", KEYS, changed(RADII, 0, -1.0))


MOVED = np.stack([KEYS - 0.5, KEYS + 0.5])

BAD_MOTION = {
    "shape": ({"motion_positions": MOVED[:, 1:].copy()}, r"motion_positions must have shape"),
    "odd": ({"motion_positions": MOVED[:1].copy()}, "at an even number of times"),
    "dtype": ({"motion_positions": MOVED.astype(np.float64)}, "must have dtype float32"),
    "not finite": (
        {"motion_positions": changed(MOVED, (1, 3, 0), np.inf)},
        "1 position in time is not finite",
    ),
    "radii": (
        {"motion_positions": MOVED, "motion_radii": np.full((2, 5), -1.0, np.float32)},
        "10 radii in time are negative or not finite",
    ),
    "radii alone": (
        {"motion_radii": np.ones((2, 5), np.float32)},
        "motion_radii must have an entry a .* at the times",
    ),
    "steps": ({"step_positions": MOVED[:1].copy()}, "step_positions must have shape"),
    "step": ({"step_positions": changed(MOVED, (0, 0, 0), np.nan)}, "1 position at a step is not"),
    "both": ({"motion_positions": MOVED, "step_positions": MOVED}, "without others in time"),
}


@pytest.mark.parametrize("case", BAD_MOTION)
def test_bad_motion_is_refused_by_name(case: str) -> None:
    wrong, sentence = BAD_MOTION[case]
    with pytest.raises(ValueError, match='curves "Fur": .*' + sentence):
        core.Mesh.from_curves("Fur", KEYS, RADII, OFFSETS, **wrong)
    with pytest.raises(ValueError, match='points "Cloud": .*' + sentence):
        core.Mesh.from_points("Cloud", KEYS, RADII, **wrong)


def test_motion_is_kept_and_blurs() -> None:
    still = core.Mesh.from_points("Cloud", KEYS - 2.0, RADII * 4)
    moved = core.Mesh.from_points(
        "Cloud", KEYS - 2.0, RADII * 4, motion_positions=np.stack([KEYS - 3.0, KEYS]),
        motion_radii=np.stack([RADII, RADII * 8]),
    )  # fmt: skip
    assert moved.primitive_count == 5
    assert moved.byte_count >= still.byte_count + 2 * 5 * 16
    pictures = []
    for mesh in (still, moved):
        scene = shapes.scene(committed=False)
        scene.add_instances(scene.add_mesh(mesh), np.eye(4)[None], np.zeros(1, np.uint32))
        scene.commit()
        pictures.append(picture(scene))
    assert np.abs(pictures[0] - pictures[1]).max() > 0.1


def test_counts() -> None:
    curves = core.Mesh.from_curves("Fur", KEYS, RADII, OFFSETS)
    assert (curves.primitive_count, curves.triangle_count) == (3, 0)
    points = core.Mesh.from_points("Cloud", KEYS, RADII)
    assert points.primitive_count == 5
    empty = core.Mesh.from_curves("None", KEYS[:0], RADII[:0], OFFSETS[:1])
    assert empty.primitive_count == 0


def with_hair_and_points() -> core.Scene:
    scene = shapes.scene(committed=False)
    for mesh in (
        core.Mesh.from_curves("Fur", KEYS, RADII, OFFSETS, shape="THICK"),
        core.Mesh.from_points("Cloud", KEYS - 2.0, RADII * 4),
    ):
        scene.add_instances(scene.add_mesh(mesh), np.eye(4)[None], np.zeros(1, np.uint32))
    return scene


def picture(scene: core.Scene) -> np.ndarray:
    session = core.Session(scene, core.Settings(samples=4, passes=["Combined"]))
    assert session.wait(60.0)
    return session.read("Combined", 0, 0, 64, 48)


def test_they_are_in_the_picture_and_in_dumps(tmp_path: Path) -> None:
    scene = with_hair_and_points()
    scene.commit()
    plain = picture(shapes.scene())
    assert np.abs(picture(scene) - plain).max() > 0.1
    scene.dump(str(tmp_path / "scene.komorebi"), core.Settings(samples=4))
    assert (tmp_path / "scene.komorebi").stat().st_size > 1000
