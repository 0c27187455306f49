"""What the module refuses: every wrong array or number is a ValueError that names the thing."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import komorebi_core as core
import numpy as np
import pytest
import shapes

POSITIONS, CORNERS, OFFSETS = shapes.cube()


def mesh_arguments(**changed: Any) -> dict[str, Any]:
    arguments = {"positions": POSITIONS, "corner_verts": CORNERS, "face_offsets": OFFSETS}
    return {**arguments, **changed}


BAD_MESHES = {
    "dtype": (
        {"positions": POSITIONS.astype(np.float64)},
        "positions must have dtype float32, not float64",
    ),
    "shape": (
        {"positions": POSITIONS.ravel()},
        r"positions must have shape \(any, 3\), not \(24,\)",
    ),
    "order": ({"positions": np.asfortranarray(POSITIONS)}, "positions must be contiguous"),
    "stride": ({"corner_verts": np.repeat(CORNERS, 2)[::2]}, "corner_verts must be contiguous"),
    "list": ({"corner_verts": CORNERS.tolist()}, "corner_verts must be a NumPy array"),
    "index dtype": (
        {"corner_verts": CORNERS.astype(np.int64)},
        "corner_verts must have dtype int32",
    ),
    "index": ({"corner_verts": CORNERS + 1}, "3 corners name a vertex that is not there"),
    "offsets": ({"face_offsets": OFFSETS[:-1]}, "face_offsets must run from 0"),
    "no offsets": ({"face_offsets": OFFSETS[:0]}, "face_offsets needs at least one entry"),
    "normals": ({"corner_normals": POSITIONS}, "corner_normals must have one row a corner"),
    "vertex normals": (
        {"vertex_normals": POSITIONS[1:].copy()},
        "vertex_normals must have one row a vertex",
    ),
    "both normals": (
        {"vertex_normals": POSITIONS, "corner_normals": np.ones((24, 3), np.float32)},
        "normals are either by vertex or by corner",
    ),
    "smooth": ({"smooth_faces": np.ones(5, bool)}, "smooth_faces must have one entry a face"),
    "material": ({"face_materials": np.full(6, -1, np.int32)}, "6 faces have a material slot"),
    "builder": ({"builder": "FAST"}, "FAST"),
}


@pytest.mark.parametrize("case", BAD_MESHES)
def test_a_bad_mesh_is_refused_by_name(case: str) -> None:
    changed, sentence = BAD_MESHES[case]
    with pytest.raises(ValueError, match=sentence) as caught:
        core.Mesh("Tree.003", **mesh_arguments(**changed))
    if case != "builder":
        assert str(caught.value).startswith('mesh "Tree.003": ')


def test_non_finite_vertices_are_counted() -> None:
    positions = POSITIONS.copy()
    positions[[1, 4], [0, 2]] = np.nan, np.inf
    with pytest.raises(ValueError, match='mesh "木": 2 vertices are not finite'):
        core.Mesh("木", **mesh_arguments(positions=positions))


def set_panorama(scene: core.Scene, panorama: object, lens: object = None) -> None:
    scene.set_camera("PANORAMA", np.eye(4), 0.1, 10.0, 8, 8, panorama=panorama, lens=lens)


BAD_INSTANCES: dict[str, Callable[[core.Scene, int], None]] = {
    r"matrices must have shape": lambda s, m: s.add_instances(m, np.eye(4), np.zeros(4, np.uint32)),
    r"object_index must have shape \(1\)": lambda s, m: s.add_instances(
        m, np.eye(4)[None], np.zeros(2, np.uint32)
    ),
    r"1 matrix is not finite": lambda s, m: s.add_instances(
        m, np.full((1, 4, 4), np.nan), np.zeros(1, np.uint32)
    ),
    r"there is no mesh 7": lambda s, m: s.add_instances(7, np.eye(4)[None], np.zeros(1, np.uint32)),
    r"its mapping must be a rotation": lambda s, m: s.set_world_environment(
        core.Environment.from_pixels("sky", np.ones((2, 4, 3), np.float32)),
        1.0,
        np.diag([1.0, 2.0, 1.0]),
    ),
    r"colour times its strength": lambda s, m: s.set_world_color((0.0, float("nan"), 0.0)),
    r"needs a panorama": lambda s, m: set_panorama(s, None),
    r"a panorama needs a kind": lambda s, m: set_panorama(s, {}),
    r"no panorama of kind TUNNEL": lambda s, m: set_panorama(s, {"kind": "TUNNEL"}),
    r'panorama has no "focus"': lambda s, m: set_panorama(s, {"kind": "MIRRORBALL", "focus": 1.0}),
    r'panorama\["fov"\] is no number': lambda s, m: set_panorama(
        s, {"kind": "FISHEYE_EQUIDISTANT", "fov": "wide"}
    ),
    r"sensor must have a width": lambda s, m: set_panorama(
        s, {"kind": "FISHEYE_EQUISOLID", "sensor_width": 0.0}
    ),
    r"focal length of more than 0": lambda s, m: set_panorama(
        s, {"kind": "FISHEYE_EQUISOLID", "focal_length": 0.0}
    ),
    r"lens must be a dict": lambda s, m: set_panorama(s, {"kind": "MIRRORBALL"}, lens=0.1),
    r"focus distance must be more than 0": lambda s, m: set_panorama(
        s, {"kind": "MIRRORBALL"}, lens={"radius": 0.1, "focus_distance": 0.0}
    ),
    r"camera kind": lambda s, m: s.set_camera("FISHEYE", np.eye(4), 0.1, 10.0, 8, 8),
}


@pytest.mark.parametrize("sentence", BAD_INSTANCES)
def test_a_bad_part_of_a_scene_is_refused(sentence: str) -> None:
    scene = core.Scene()
    mesh = scene.add_mesh(core.Mesh("cube", **mesh_arguments()))
    with pytest.raises(ValueError, match=sentence):
        BAD_INSTANCES[sentence](scene, mesh)


def test_a_committed_scene_is_closed() -> None:
    with pytest.raises(ValueError, match="is committed"):
        shapes.scene().set_world_color((0.0, 0.0, 0.0))


BAD_SETTINGS = {
    "samples must": {"samples": 0},
    "light_samples must": {"light_samples": 4097},
    "adaptive_threshold must": {"adaptive_threshold": float("nan")},
    "do not add up": {"use_adaptive_sampling": True, "sample_offset": 1},
    "time_limit must": {"time_limit": -1.0},
    "ao_distance must": {"ao_distance": -1.0},
    "clay_color": {"clay_color": (0.5, 2.0, 0.5)},
    "filter_width": {"filter_width": float("nan")},
    "region must": {"region": (0, 0, 65, 48)},
    "there is no pass": {"passes": ("Combined", "Glossy")},
    "2\\^32": {"samples": 1 << 24, "light_samples": 4096},
}


@pytest.mark.parametrize("sentence", BAD_SETTINGS)
def test_a_setting_out_of_range_is_refused(sentence: str) -> None:
    settings = core.Settings(**BAD_SETTINGS[sentence])
    with pytest.raises(ValueError, match=sentence):
        core.Session(shapes.scene(), settings)


def test_an_unknown_choice_lists_the_known_ones() -> None:
    with pytest.raises(ValueError, match="MIS, COSINE, ENVIRONMENT, PRODUCT, not LUCK"):
        core.Settings(environment_sampling="LUCK")


def test_a_session_needs_a_committed_scene_with_a_camera() -> None:
    with pytest.raises(ValueError, match="not committed"):
        core.Session(shapes.scene(committed=False), core.Settings())
    empty = core.Scene()
    empty.commit()
    with pytest.raises(ValueError, match="no camera"):
        core.Session(empty, core.Settings())


def test_a_session_may_be_cancelled_before_it_starts() -> None:
    scene = shapes.scene(committed=False)
    pixels = np.random.default_rng(1).random((8, 16, 3)).astype(np.float32)
    scene.set_world_environment(core.Environment.from_pixels("sky", pixels))
    scene.commit()
    settings = core.Settings(method="WORLD_LIGHT", samples=1)
    raised = core.Cancel()
    raised.request()
    with pytest.raises(core.Cancelled):
        core.Session(scene, settings, cancel=raised)
    session = core.Session(scene, settings, cancel=core.Cancel())  # what was broken off is made
    assert session.wait(60.0)
    assert not session.error


def test_a_missing_image_is_named() -> None:
    with pytest.raises(RuntimeError, match="/nowhere/sky.hdr"):
        core.Environment.from_file("/nowhere/sky.hdr")


def test_nothing_is_lost_silently_in_a_map() -> None:
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[0, 0] = np.nan
    pixels[1, 2, 1] = -3.0
    pixels[2, 3] = -1.0
    environment = core.Environment.from_pixels("sky", pixels)
    assert (environment.nonfinite_texels, environment.negative_texels) == (1, 2)


def test_content_tags_tell_any_two_arrays_apart() -> None:
    rng = np.random.default_rng(1)
    data = rng.integers(0, 256, 3 * 4096 + 5, dtype=np.uint8)
    tags = core.content_tags(data)
    assert len(tags) == 4 * 32
    assert core.content_tags(data.copy(), threads=1) == tags, "the same content, the same tags"
    for at in (0, 4095, 4096, data.size - 1):
        other = data.copy()
        other[at] ^= 1
        changed = core.content_tags(other)
        different = [b for b in range(4) if changed[32 * b :][:32] != tags[32 * b :][:32]]
        assert different == [at // 4096]
    swapped = data.copy()
    swapped[0:8], swapped[16:24] = data[16:24], data[0:8]
    assert core.content_tags(swapped)[:32] != tags[:32], "the order counts"
    with pytest.raises(ValueError, match="contiguous"):
        core.content_tags(np.zeros((4, 4))[:, :2])


def test_an_unknown_instruction_set_is_told_at_import() -> None:
    environment = {**os.environ, "KOMOREBI_ISA": "MMX"}
    command = [sys.executable, "-c", "import komorebi_core"]
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert said.returncode != 0
    assert re.search(r'ImportError: KOMOREBI_ISA: there is no instruction set "MMX"', said.stderr)
