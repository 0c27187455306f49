"""Renders of one engine in a Blender 4.5 process of its own, and references that are kept."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from compare import launch

from bench import meshes
from bench.scenes import MAP, PYTHON, Scene, blend_file

JOB = Path(__file__).resolve().parent / "inside" / "picture_job.py"
SMALL = (320, 180)  # pixels, where errors are measured
REFERENCE_SEEDS, REFERENCE_SAMPLES = 8, 512  # together 4,096 samples a pixel


class Failed(RuntimeError):
    """A Blender ended without its report; the message says what it said last."""


@dataclass(frozen=True)
class Outcome:
    """Seconds of each run's render operator and of the whole process; the kept pictures; the light
    samples that Komorebi decided on."""

    seconds: list[float]
    process: float
    notes: list[str]
    pictures: list[np.ndarray]
    light_samples: list[int]


def small_size(scene: Scene) -> tuple[int, int]:
    """The size at which a scene's errors are measured."""
    return SMALL if scene.size[0] != scene.size[1] else (SMALL[1], SMALL[1])


def render(
    scene: Scene,
    engine: str,
    size: tuple[int, int],
    runs: list[tuple[int, int]],
    keep: bool,
    settings: dict[str, Any] | None = None,
    views: int = 0,
) -> Outcome:
    """Render `runs` of (samples, seed) one after the other in one new process."""
    folder = meshes.FOLDER / "jobs" / f"{os.getpid()}"
    folder.mkdir(parents=True, exist_ok=True)
    kept = [folder / f"{scene.name}-{engine}-{k}.npy" if keep else None for k in range(len(runs))]
    out, job_file = folder / "report.json", folder / "job.json"
    out.unlink(missing_ok=True)
    job = {
        "file": str(blend_file(scene)),
        "engine": engine,
        "mode": "ao" if scene.mode == "ao" else "world",
        "world_image": str(meshes.shared_file(MAP)) if scene.has_map else None,
        "width": size[0],
        "height": size[1],
        "views": views,
        "bounces": scene.bounces,
        "lamps": False,
        "materials": scene.materials,
        "fast_gi": None,
        "cycles": {},
        "komorebi": {},
        engine.lower(): settings or {},
        "runs": [
            {"samples": samples, "seed": seed, "keep": str(path) if path else None}
            for (samples, seed), path in zip(runs, kept, strict=True)
        ],
        "out": str(out),
    }
    job_file.write_text(json.dumps(job, indent=1), encoding="utf-8")
    log = folder / f"{scene.name}-{engine}.log"
    start = time.perf_counter()
    with log.open("wb") as sink:
        code = subprocess.run(
            [PYTHON, str(JOB), "--", str(job_file)],
            stdin=subprocess.DEVNULL,
            stdout=sink,
            stderr=subprocess.STDOUT,
            env=launch.environment(),
        ).returncode
    seconds = time.perf_counter() - start
    if not out.is_file():
        raise Failed(f"{engine} ended with code {code}: {launch.complaint(log)} ({log})")
    report = json.loads(out.read_text(encoding="utf-8"))
    pictures = [np.load(path) for path in kept if path is not None]
    shutil.rmtree(folder)
    return Outcome(report["seconds"], seconds, report["notes"], pictures, report["light_samples"])


def module_version() -> str:
    """Of the module that Komorebi renders with; Cycles has the version of its Blender."""
    package = meshes.PROJECT / "build" / "release" / "package" / "komorebi_core"
    digest = hashlib.sha1()
    for path in sorted(package.glob("_*.so")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:8]


def reference_file(scene: Scene, engine: str, samples: int, seed: int) -> Path:
    """Where one seed's part of a reference is kept."""
    who = module_version() if engine == "KOMOREBI" else "4.5"
    name = f"{blend_file(scene).stem}-{scene.mode}-{scene.bounces}-{small_size(scene)[0]}-{engine}-{who}-{samples}-{seed}.npy"
    return meshes.FOLDER / "references" / name


def reference_part(scene: Scene, engine: str, samples: int, seed: int) -> np.ndarray:
    """`samples` of one seed, float32 [row, column, RGB]; rendered once and kept."""
    path = reference_file(scene, engine, samples, seed)
    if not path.is_file():
        path.parent.mkdir(parents=True, exist_ok=True)
        # Seeds far from those of the measured pictures.
        # A sample of Komorebi's casts eight light rays: an eighth has as many.
        ours = engine == "KOMOREBI"
        run = (max(1, samples // 8) if ours else samples, 1000 + seed + (500 if ours else 0))
        np.save(path, render(scene, engine, small_size(scene), [run], True).pictures[0])
    return np.asarray(np.load(path))


def reference(scene: Scene, engine: str, seeds: int, samples: int) -> np.ndarray:
    """All parts, float32 [seed, row, column, RGB]; their mean is the reference."""
    return np.stack([reference_part(scene, engine, samples, seed) for seed in range(seeds)])
