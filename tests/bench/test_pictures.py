"""The pictures and the export part run in Blender 4.5, on next to nothing."""

import argparse
import os
from pathlib import Path

import numpy as np
import pytest

from bench import core, export, meshes, noise, pictures, render, scenes

USER = Path(os.environ.get("KOMOREBI_USER", meshes.PROJECT / "build" / "user"))
if not Path(scenes.PYTHON).is_file() or not (USER / "scripts/addons/komorebi").exists():
    pytest.skip("no Blender 4.5 with the add-on", allow_module_level=True)


@pytest.fixture
def scene(monkeypatch, tmp_path) -> scenes.Scene:
    """A pyramid where the bench has its dragon."""
    monkeypatch.setenv("KOMOREBI_SHARED", str(tmp_path / "shared"))
    monkeypatch.setattr(meshes, "FOLDER", tmp_path / "bench")
    positions = np.array([[1, 0, 0], [-1, 0, 1], [-1, 0, -1], [0, 1, 0]], np.float32)
    corners = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.uint32)
    file = tmp_path / "shared" / "data" / "meshes" / "pyramid.ply"
    meshes.write_ply(file, meshes.Mesh(positions, corners))
    return scenes.Scene("pyramid", "a pyramid", "ao", "dragon", "meshes/pyramid.ply", 16)


def test_both_engines_are_brought_to_equal_error_and_timed(scene, monkeypatch):
    monkeypatch.setattr(pictures, "SCENES", (scene,))
    monkeypatch.setattr(render, "SMALL", (64, 36))
    effort = pictures.Effort(reference=(2, 64), size=(32, 18), quick=True)
    row = pictures.measure_scene(scene, effort)
    assert 0.0 < row["rmse"] < 0.2
    found = [error for _, error in row["komorebi_errors"]]
    assert found == sorted(found, reverse=True), "more samples, less error"
    for engine in ("cycles", "komorebi"):
        assert 0.0 < row[f"{engine}_seconds"][0] < row[f"{engine}_process_seconds"][0]
    assert len(pictures.tables([row])[0].rows) == 1
    # References are kept: the second time nothing is rendered.
    monkeypatch.setattr(render, "render", None)
    assert render.reference(scene, "CYCLES", 2, 64).shape == (2, 36, 64, 3)


def test_noise_needs_no_references(scene, monkeypatch):
    monkeypatch.setattr(noise, "SCENES", (scene,))
    monkeypatch.setattr(render, "SMALL", (64, 36))
    few, many = (noise.measure_scene(scene, n, render.SMALL) for n in (2, 16))
    for engine in ("cycles", "komorebi"):
        assert many[f"{engine}_variance"] < few[f"{engine}_variance"] / 4
        assert many[f"{engine}_seconds"] > 0.0
    assert len(noise.tables([few])[0].rows) == 1


def test_export_measures_every_case_in_every_blender():
    options = argparse.Namespace(quick=True, rounds=None)
    rows = export.measure(options)
    for release in core.unique(rows, "blender"):
        cases = {(r["mesh"], r["smooth"], r["case"]) for r in core.pick(rows, blender=release)}
        assert len(cases) == 2 * 2 * len(export.CASES)
    assert all(row["seconds"] > 0.0 for row in rows)
    assert export.tables(rows)[0].rows
