"""Each part of the bench runs, on a tiny mesh, and its rows are what the schema says."""

import json
import math
import struct
from pathlib import Path

import numpy as np
import pytest

from bench import core, curves, meshes, ray_tables, scale
from bench.meshes import Mesh, read_glb, read_ply, write_ply
from bench.tables import Table, figure

if not core.PROGRAM.is_file():
    pytest.skip("komorebi_bench is not built (KOMOREBI_BENCH)", allow_module_level=True)


@pytest.fixture
def tetrahedron() -> Mesh:
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    corners = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32)
    return Mesh(positions, corners)


@pytest.fixture
def file(tetrahedron: Mesh, tmp_path: Path) -> str:
    write_ply(tmp_path / "tetrahedron.ply", tetrahedron)
    return str(tmp_path / "tetrahedron.ply")


def test_meshes_come_back_from_a_ply_as_they_were(tetrahedron, file):
    again = read_ply(Path(file))
    assert (again.positions == tetrahedron.positions).all()
    assert (again.corners == tetrahedron.corners).all()


def test_all_parts_of_a_glb_are_joined(tetrahedron, tmp_path):
    points = tetrahedron.positions.tobytes()
    data = points + tetrahedron.corners.astype(np.uint16).tobytes()
    part = {"attributes": {"POSITION": 0}, "indices": 1}
    content = {
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [part, part]}],
        "bufferViews": [
            {"byteLength": len(points)},
            {"byteOffset": len(points), "byteLength": len(data) - len(points)},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4},
            {"bufferView": 1, "componentType": 5123, "count": 12},
        ],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    path = tmp_path / "two.glb"
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(data), 0x004E4942) + data
    path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)
    mesh = read_glb(path)
    assert (mesh.positions == np.tile(tetrahedron.positions, (2, 1))).all()
    assert (mesh.corners[4:] == tetrahedron.corners + 4).all()


def test_build_measures_all_on_one_and_two_threads(file):
    modes = ["LOW", "MEDIUM", "MEDIUM+COMPACT", "HIGH"]
    words = ["--mesh", file, "--rounds", "2", "--modes", ",".join(modes)]
    rows = core.run_part("build", words)
    assert {(r["mode"], r["threads"]) for r in rows if r["engine"] == "embree"} == {
        (mode, threads) for mode in modes for threads in (1, 2)
    }
    for row in rows:
        assert row["triangles"] == 4
        assert len(row["cold_seconds"]) == len(row["warm_seconds"]) == 2
        assert min(row["cold_seconds"] + row["warm_seconds"]) > 0.0
        assert row["bytes"] > 0
    tables = core.build_tables(rows) + core.memory_tables(rows)
    assert [len(table.rows) for table in tables] == [2, 2, 2]


def test_both_engines_answer_rays_alike_whatever_way_they_are_asked(file):
    words = {
        "mesh": file, "name": "tetrahedron", "rounds": "1", "tiles": "1", "all": "1",
        "kinds": "camera,ao:1,ao:16:0.1,map:64", "queries": "1,4,4c,8,16,16c,1M,1Mc",
        "modes": "LOW,MEDIUM,MEDIUM+ROBUST,MEDIUM+COMPACT,HIGH", "threads": "1,2",
    }  # fmt: skip
    rows = core.run_part("rays", [w for k, v in words.items() for w in (f"--{k}", v)])
    assert {row["rays"] for row in rows} == {"camera", "ao:1", "ao:16:0.1", "map:64"}
    for row in rows:
        assert row["ray_count"] > 0
        assert row["seconds"][0] > 0.0
        # A tetrahedron shades nothing of itself, and its edges are all that may be answered
        # differently.
        limit = 0.01 if row["rays"] == "camera" else 0.0
        assert row["differing_share"] <= limit, row
        assert (row["blocked_share"] > 0.1) == (row["rays"] == "camera")
    tables = ray_tables.ray_tables(rows)
    assert len(tables) == 8
    trees = core.unique(core.pick(rows, engine="komorebi"), "tree")
    assert {len(table.rows) for table in tables} == {2 * len(trees)}


def test_scale_counts_what_it_grows():
    rows = scale.rows_of("2e3,8e3", "1,16", 1)
    grown = [r["count"] for r in rows if r["grows"] == "triangles" and r["tree"] == "LINEAR"]
    assert grown == pytest.approx([2e3, 8e3], rel=0.1)
    assert [r["count"] for r in rows if r["grows"] == "instances"] == [1, 16]
    assert len(scale.tables(rows)) == 2


def test_a_wrong_part_and_a_missing_mesh_are_named(tmp_path, capfd):
    with pytest.raises(RuntimeError, match="failed"):
        core.run_part("build", ["--mesh", str(tmp_path / "none.ply")])
    assert "none.ply" in capfd.readouterr().err
    with pytest.raises(RuntimeError, match="failed"):
        core.run_part("nonsense", [])


def test_missing_shared_data_is_said_with_its_path(monkeypatch, tmp_path):
    monkeypatch.setenv("KOMOREBI_SHARED", str(tmp_path))
    with pytest.raises(meshes.Missing, match="bunny"):
        meshes.shared_file("meshes/bunny_hr.obj")


def test_tables_keep_their_columns():
    table = Table("Title", ["name", "value"])
    table.add("one", "1.5")
    with pytest.raises(ValueError, match="3 cells"):
        table.add("a", "b", "c")
    assert table.text().splitlines() == ["Title", "  name  value", "  one     1.5"]
    assert "| one | 1.5 |" in table.markdown("./run bench")


@pytest.mark.parametrize(
    ("value", "text"), [(0.0, "0"), (1234.5, "1,234"), (12.345, "12.3"), (0.01234, "0.0123")]
)
def test_figures_have_three_significant_digits(value, text):
    assert figure(value) == text
    assert math.isfinite(value)


def test_curves_are_traced_beside_embree():
    words = [
        "--strands",
        "300",
        "--segments",
        "4",
        "--width",
        "0.02",
        "--size",
        "16",
        "--rounds",
        "2",
    ]
    rows = core.run_part("curves", words)
    built, traced = curves.tables(rows)
    # Two shapes: two trees and Embree's; from the camera and towards the light on each of ours.
    assert (len(built.rows), len(traced.rows)) == (6, 8)
    for row in core.pick(rows, kind="rays"):
        assert row["met_share"] > 0.05
        assert row["differing_share"] < 0.02
