"""Runs inside Blender: opens a file, prepares it for one engine and renders it against the clock.

    PYTHON_WITH_BPY tests/bench/inside/picture_job.py -- JOB.json

JOB.json holds file, engine, mode (ao, world), world_image, width, height, views (0: the file's own
camera; n: that many cameras on a circle around the scene's middle), cycles and komorebi (settings
over those of `compare`), runs (a list of samples, seed and keep, the .npy file that takes the
picture or null) and out, the file that takes the report: seconds of each run's render operator and
of opening and preparing, notes on what was switched off, release, and the light samples that
Komorebi decided on. Pictures are float32 [row,
column, RGB], row 0 at the bottom, scene linear.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from compare.inside import engines
from compare.inside.prepare import open_file, prepare
from compare.inside.saved import take
from compare.inside.settle import require, settle_all


def set_samples(scene: Any, engine: str, samples: int, seed: int) -> None:
    """`samples` a pixel, from the place in Cycles' sequence that `compare` found to be best."""
    if engine == "CYCLES":
        require(scene.cycles, samples=samples)
        if not scene.cycles.use_adaptive_sampling:
            engines.take_samples(scene.cycles, samples, 0)
    else:
        require(scene.komorebi, samples=samples)
    engines.set_seed(scene, engine, seed)


def own_defaults(scene: Any) -> None:
    """Komorebi as a user has it who changes nothing but method, samples and pixel filter: what
    `compare` sets for the sake of comparison goes back to its default."""
    for name in (
        "light_samples",
        "environment_sampling",
        "use_progressive",
        "use_adaptive_sampling",
    ):
        if name in scene.komorebi.bl_rna.properties:
            scene.komorebi.property_unset(name)
    settle_all(scene.komorebi, use_adaptive_sampling=False)


def cameras(scene: Any, count: int) -> list[Matrix]:
    """Places around the vertical axis through the scene's origin, at the camera's own distance."""
    start = scene.camera.matrix_world.copy()
    turn = Vector((0.0, 0.0, 1.0))
    return [Matrix.Rotation(math.tau * k / count, 4, turn) @ start for k in range(count)]


def render(scene: Any, run: dict[str, Any], places: list[Matrix]) -> float:
    """Seconds of the render operator, of all views together."""
    keep = run["keep"]
    if keep is not None:
        scene.render.filepath = str(Path(keep).with_suffix(".exr"))
    seconds = 0.0
    for place in places or [None]:
        if place is not None:
            scene.camera.matrix_world = place
        start = time.perf_counter()
        bpy.ops.render.render(write_still=keep is not None)
        seconds += time.perf_counter() - start
    if keep is not None:
        np.save(keep, take(Path(keep).with_suffix(".exr"))[..., :3])
    return seconds


def watch_light_samples() -> list[int]:
    """The light rays a camera sample of each render of Komorebi's to come, as it decides them."""
    from komorebi import driver

    told: list[int] = []
    update = driver.Progress.update

    def watched(self: Any, session: Any, final: bool = False) -> None:
        update(self, session, final=final)
        if final:
            told.append(session.resolved["light_samples"])

    driver.Progress.update = watched
    return told


def main() -> None:
    """Do the job named on the command line."""
    start = time.perf_counter()
    job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text(encoding="utf-8"))
    if job["engine"] == "KOMOREBI":
        import addon_utils

        if addon_utils.enable("komorebi", default_set=False) is None:
            raise RuntimeError("the add-on komorebi could not be enabled")
    notes = open_file(job["file"])
    longest = max(job["width"], job["height"])
    common = {
        "frame": None,
        "camera": None,
        "stereo": None,
        "view_layer": None,
        "flat": False,
        "samples": 1,
        "longest": longest,
    }
    scene, layer, more = prepare({**common, **job})
    settle_all(scene.render, resolution_x=job["width"], resolution_y=job["height"])
    if job["engine"] == "CYCLES":
        require(scene.cycles, **job["cycles"])
        # Cycles asks its view layers too, and `prepare` has told them not to.
        require(layer.cycles, use_denoising=scene.cycles.use_denoising)
    else:
        own_defaults(scene)
        require(scene.komorebi, **job["komorebi"])
    # Both keep what outlives a frame where several frames of one scene follow each other.
    settle_all(scene.render, use_persistent_data=job["views"] > 0)
    places = cameras(scene, job["views"]) if job["views"] else []
    light_samples = watch_light_samples() if job["engine"] == "KOMOREBI" else []
    report: dict[str, Any] = {"prepare": time.perf_counter() - start, "seconds": []}
    for run in job["runs"]:
        set_samples(scene, job["engine"], run["samples"], run["seed"])
        report["seconds"].append(render(scene, run, places))
    report |= {"notes": notes + more, "blender": bpy.app.version_string}
    report |= {"light_samples": light_samples}
    Path(job["out"]).write_text(json.dumps(report), encoding="utf-8")


main()
