"""Runs inside Blender: opens a file, prepares it for one engine, renders it at several seeds,
stores the pixels.

    blender -b --factory-startup --disable-autoexec -P tests/compare/inside/job.py -- JOB.json
    PYTHON_WITH_BPY tests/compare/inside/job.py -- JOB.json

JOB.json holds: file, engine, mode, samples, seeds, view_layer, flat, longest, world_image, frame,
camera, stereo, bounces, materials, fast_gi, ao_bounces, ao_distance, out. Written into the folder `out`: pixels.npy, float32 [seed, row, column, RGBA], row 0 at the
bottom, premultiplied, scene linear; and bent.npy, bool [row, column], from Cycles up to 3.x (see
bent.py); and report.json: notes (what was changed), seconds a picture, releases.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from compare.inside import bent, engines
from compare.inside.prepare import open_file, prepare
from compare.inside.saved import take


def render(scene: Any, path: Path) -> np.ndarray:
    """One picture as float32 [row, column, RGBA]."""
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return take(path)


def main() -> None:
    """Do the job named on the command line."""
    job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text(encoding="utf-8"))
    out = Path(job["out"])
    if job["engine"] == "KOMOREBI":
        import addon_utils

        if addon_utils.enable("komorebi", default_set=False) is None:
            raise RuntimeError("the add-on komorebi could not be enabled")
    notes = open_file(job["file"])
    scene, layer, more = prepare(job)
    pictures, seconds = [], []
    for seed in job["seeds"]:
        engines.set_seed(scene, job["engine"], seed)
        start = time.perf_counter()
        pictures.append(render(scene, out / f"seed-{seed}.exr"))
        seconds.append(time.perf_counter() - start)
    np.save(out / "pixels.npy", np.stack(pictures))
    if bent.needed(job["engine"], job["flat"]):
        bent.show(scene, layer)
        np.save(out / "bent.npy", render(scene, out / "bent.exr")[..., 0] > 0.0)
    report = {
        "notes": notes + more,
        "seconds": seconds,
        "blender": bpy.app.version_string,
        "view_layer": layer.name,
    }
    (out / "report.json").write_text(json.dumps(report), encoding="utf-8")


main()
