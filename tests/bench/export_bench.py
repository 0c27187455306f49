"""Seconds from Blender's depsgraph to the committed scene, as JSON on the last line.

    blender -b --factory-startup -P tests/bench/export_bench.py -- [FACES [REPEATS]]
    build/venv/bpy/bin/python tests/bench/export_bench.py [FACES [REPEATS]]

The add-on and its module are found as in the tests: in the folder BLENDER_USER_SCRIPTS. Each mesh
is a wavy grid of FACES (1,000,000) triangles or quads, flat or smooth, rendered REPEATS (3) times:
`first` (nothing is known of it, the mesh's data are new), `unchanged`, `moved` (another matrix),
`changed` (one vertex moved, so Blender's normals are computed again and the tree is built anew) and
`kept` (moved, with Persistent Data).
The picture has 8 × 8 pixels, of which nothing is measured. Without Persistent Data each render
gets a depsgraph of its own; what Blender does to evaluate it is not in the figures, normals are.
"""

from __future__ import annotations

import json
import statistics
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "blender"))
import support


def wavy_grid(kind: str, faces: int, smooth: bool) -> Any:
    """A mesh of about `faces` faces; `kind` is "triangles" or "quads"."""
    side = round((faces if kind == "quads" else faces / 2) ** 0.5)
    y, x = np.mgrid[0 : side + 1, 0 : side + 1].astype(np.float32) / np.float32(side) * 4 - 2
    z = (0.2 * np.sin(5 * x) * np.cos(7 * y)).astype(np.float32)
    index = np.arange((side + 1) ** 2, dtype=np.uint32).reshape(side + 1, side + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    corners = (a, b, c, d) if kind == "quads" else (a, b, c, a, c, d)
    verts = np.stack([k.ravel() for k in corners], -1).reshape(-1, 4 if kind == "quads" else 3)
    mesh = bpy.data.meshes.new(kind)
    mesh.vertices.add((side + 1) ** 2)
    mesh.vertices.foreach_set("co", np.stack([x, y, z], -1).ravel())
    mesh.loops.add(verts.size)
    mesh.loops.foreach_set("vertex_index", verts.ravel())
    mesh.polygons.add(len(verts))
    starts = np.arange(0, verts.size, verts.shape[1], dtype=np.uint32)
    mesh.polygons.foreach_set("loop_start", starts)
    if bpy.app.version < (3, 6, 0):
        totals = np.full(len(verts), verts.shape[1], np.uint32)
        mesh.polygons.foreach_set("loop_total", totals)
    mesh.polygons.foreach_set("use_smooth", np.full(len(verts), smooth, np.bool_))
    mesh.update(calc_edges=True)
    return mesh


class Stopwatch:
    """Adds up the seconds of some functions of the add-on while it is on."""

    def __init__(self, *names: tuple[Any, str]) -> None:
        self.seconds: dict[str, float] = {}
        for module, name in names:
            setattr(module, name, self._timed(name, getattr(module, name)))

    def _timed(self, name: str, function: Any) -> Any:
        def timed(*args: Any, **kwargs: Any) -> Any:
            start = time.perf_counter()
            try:
                return function(*args, **kwargs)
            finally:
                passed = time.perf_counter() - start
                self.seconds[name] = self.seconds.get(name, 0.0) + passed

        return timed

    def take(self) -> dict[str, float]:
        seconds, self.seconds = self.seconds, {}
        return seconds


def measure(kind: str, smooth: bool, faces: int, repeats: int, watch: Stopwatch) -> list[Any]:
    from komorebi import cache

    scene = support.fresh_scene(size=(8, 8), samples=1)
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    mesh = wavy_grid(kind, faces, smooth)
    obj = support.add_object(kind, mesh)
    triangles = len(mesh.loops) - 2 * len(mesh.polygons)
    cases: dict[str, list[dict[str, float]]] = {}

    def render(case: str) -> None:
        watch.take()
        bpy.ops.render.render(scene=scene.name)
        cases.setdefault(case, []).append(watch.take())

    for repeat in range(repeats):
        cache.clear()
        obj.data = mesh = mesh.copy()
        render("first")
        render("unchanged")
        obj.location.x = 0.1 * (repeat + 1)
        render("moved")
        mesh.vertices[0].co.z = repeat + 1
        mesh.update()
        render("changed")
        scene.render.use_persistent_data = True
        bpy.ops.render.render(scene=scene.name)
        for turn in range(3):
            obj.rotation_euler.z = turn
            render("kept")
        scene.render.use_persistent_data = False
    rows = []
    for case, runs in cases.items():
        totals = [sum(run.values()) for run in runs]
        rows.append(
            {
                "blender": bpy.app.version_string, "mesh": kind, "smooth": smooth, "case": case,
                "faces": len(mesh.polygons), "triangles": triangles,
                "seconds": statistics.median(totals), "least": min(totals), "most": max(totals),
                "export_seconds": statistics.median(r.get("export_frame", 0) for r in runs),
                "build_seconds": statistics.median(
                    r.get("load", 0) + r.get("build", 0) for r in runs
                ),
                "seconds_per_million_triangles": statistics.median(totals) / triangles * 1e6,
                "seconds_per_million_faces": statistics.median(totals) / len(mesh.polygons) * 1e6,
            }
        )  # fmt: skip
    return rows


def main(arguments: list[str]) -> None:
    faces = int(arguments[0]) if arguments else 1_000_000
    repeats = int(arguments[1]) if len(arguments) > 1 else 3
    support.enable()
    from komorebi import driver, native_scene

    watch = Stopwatch((driver, "export_frame"), (native_scene, "load"), (native_scene, "build"))
    rows = []
    for kind in ("triangles", "quads"):
        for smooth in (False, True):
            rows += measure(kind, smooth, faces, repeats, watch)
    for row in rows:
        print(f"{row['mesh']:9} {'smooth' if row['smooth'] else 'flat':6} {row['case']:9} "
              f"export {row['export_seconds']:.3f} build {row['build_seconds']:.3f} "
              f"whole {row['seconds']:.3f} s")  # fmt: skip
    print(json.dumps(rows))


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
