"""The whole tool with a real Blender: Cycles against itself passes, and errors are sentences."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from compare import __main__ as tool
from compare import launch, statistics

BLENDER = os.environ.get("KOMOREBI_BLENDER", launch.DEFAULT_BLENDER)
SCENES = launch.PROJECT / "blend_scenes"
needs_blender = pytest.mark.skipif(
    not Path(BLENDER).is_file(), reason=f"there is no Blender at {BLENDER}"
)


@needs_blender
def test_cycles_agrees_with_cycles_and_not_with_one_percent_more(tmp_path: Path) -> None:
    scene = str(SCENES / "text_curves_metaballs.blend")
    options = ["--second", "CYCLES", "--size", "160", "--samples", "32", "--blender", BLENDER]
    figures = tmp_path / "figures.json"
    code = tool.main([scene, *options, "--out", str(tmp_path), "--json", str(figures)])
    read = json.loads(figures.read_text(encoding="utf-8"))
    assert code == 0, read
    assert read["size"] == [160, 90]
    assert Path(read["picture"]).stat().st_size > 1000
    first = np.load(tmp_path / "first-cycles" / "pixels.npy")
    second = np.load(tmp_path / "second-cycles" / "pixels.npy")
    assert not np.array_equal(first, second), "the second side must have other seeds"
    second[..., :3] *= 1.01
    assert not statistics.judge(first, second).passed


@needs_blender
def test_a_file_that_is_no_blend_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    broken = tmp_path / "broken.blend"
    broken.write_bytes(b"this is no scene")
    code = tool.main([str(broken), "--out", str(tmp_path / "out"), "--blender", BLENDER])
    assert code == 2
    assert "CYCLES: Blender ended with exit code 3" in capsys.readouterr().err


@needs_blender
def test_a_camera_that_is_not_there_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    scene = str(SCENES / "panorama.blend")
    options = ["--camera", "Nobody", "--out", str(tmp_path), "--blender", BLENDER]
    assert tool.main([scene, *options]) == 2
    assert "the scene has no camera 'Nobody'" in capsys.readouterr().err


def test_a_missing_file_is_refused(capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit) as end:
        tool.main(["/nowhere/at-all.blend"])
    assert end.value.code == 2
    assert "there is no file /nowhere/at-all.blend" in capsys.readouterr().err
