"""The document of what agrees in which release."""

from __future__ import annotations

from typing import Any

import pytest

from compare import colours, compatibility, launch


def result(name: str, mode: str, passed: bool, blender: str = "3.4.1") -> dict[str, Any]:
    figures = {
        "blender": blender,
        "samples": 16,
        "seeds": 8,
        "passed": passed,
        "disagreeing_percent": 0.25,
        "mean_difference_in_standard_errors": 1.24,
    }
    return {"name": f"{name}.blend", "mode": mode, "figures": figures}


def test_every_scene_of_ours_is_explained() -> None:
    scenes = {path.stem for path in (launch.PROJECT / "blend_scenes").glob("*.blend")}
    assert scenes == set(compatibility.features())


def test_a_row_a_scene_and_a_column_a_release() -> None:
    old = [result("convex", "ao", True), result("convex", "world", False)]
    new = [result("convex", "ao", True, "4.5.0"), result("room", "ao", True, "4.5.0")]
    text = compatibility.table([old, new])
    assert "Blender 3.4.1 | Blender 4.5.0" in text
    convex = next(line for line in text.splitlines() if "`convex`" in line)
    assert "0.25 %, 1.2 · **differs**: 0.25 %, 1.2 | 0.25 %, 1.2 · not run" in convex
    room = next(line for line in text.splitlines() if "`room`" in line)
    assert "| not run · not run | 0.25 %, 1.2 · not run |" in room


def test_a_scene_without_a_word_is_refused() -> None:
    with pytest.raises(ValueError, match="does not say what nowhere proves"):
        compatibility.table([[result("nowhere", "ao", True)]])


def test_scenes_of_colours_have_a_row_a_number_of_bounces() -> None:
    old, new = (
        result("colors", "world", p, r)["figures"] for p, r in ((True, "3.4"), (False, "4.5"))
    )
    common = {"scene": "blend_scenes/colors.blend", "size": [160, 90]}
    text = colours.table([{**old, **common, "bounces": 0}, {**new, **common, "bounces": 2}])
    assert "Blender 3.4 | Blender 4.5" in text
    first, second = (line for line in text.splitlines() if "`colors`" in line)
    assert first.endswith("| 0 | 0.25 %, 1.2 (16 samples, 160 px) | not run |")
    assert second.endswith("| 2 | not run | **differs**: 0.25 %, 1.2 (16 samples, 160 px) |")
