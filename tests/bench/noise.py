"""noise: what a picture's samples are worth, in minutes: variance between seeds times time.

Beside `pictures`, which brings both engines to the same error against references, this needs none:
the variance of independent pictures falls with the samples, so that variance times seconds is what
an equal error costs, if there is no bias (which `compare` tests).
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np

from bench import meshes, render
from bench.pictures import SCENES
from bench.progress import say
from bench.scenes import Scene
from bench.statistics import median
from bench.tables import Table, figure, times

Row = dict[str, Any]
SAMPLES, SEEDS = 16, (1, 2, 3)
WARM_UP = (2, 9)  # samples and seed of the picture that is not counted
KINDS = ("-textured", "-bounces", "-sky")  # what is measured when no scene is named


def measure_scene(scene: Scene, samples: int, size: tuple[int, int]) -> Row:
    """Variance of a channel and seconds of a picture, for both engines."""
    row: Row = {"scene": scene.name, "samples": samples, "width": size[0], "height": size[1]}
    for engine in ("CYCLES", "KOMOREBI"):
        say(f"noise: {scene.name}: {engine}")
        runs = [WARM_UP, *((samples, seed) for seed in SEEDS)]
        done = render.render(scene, engine, size, runs, True, {})
        pictures = np.stack(done.pictures[1:]).astype(np.float64)
        row[f"{engine.lower()}_variance"] = float(pictures.var(axis=0, ddof=1).mean())
        row[f"{engine.lower()}_seconds"] = median(done.seconds[1:])
    return row


def measure(options: argparse.Namespace) -> list[Row]:
    """The scenes that were named, or those with materials and bounces."""
    named = options.scene or ()
    chosen = [s for s in SCENES if s.name in named or (not named and s.name.endswith(KINDS))]
    rows: list[Row] = []
    for scene in chosen[:1] if options.quick else chosen:
        try:
            size = options.size or render.small_size(scene)
            rows.append(measure_scene(scene, 2 if options.quick else SAMPLES, size))
        except meshes.Missing as missing:
            say(f"noise: {scene.name} is left out: {missing}")
    return rows


def tables(rows: list[Row]) -> list[Table]:
    """One line a scene."""
    says = {scene.name: scene.says for scene in SCENES}
    table = Table(
        "Noise: 16 samples a pixel, and how many times as fast as Cycles at equal error",
        ["scene", "size", "Cycles s", "Komorebi s", "faster a picture", "variance", "equal error"],
    )
    for row in rows:
        faster = row["cycles_seconds"] / row["komorebi_seconds"]
        quieter = row["cycles_variance"] / row["komorebi_variance"]
        table.add(
            says[row["scene"]], f"{row['width']} × {row['height']}",
            figure(row["cycles_seconds"]), figure(row["komorebi_seconds"]),
            times(faster), times(quieter), times(faster * quieter),
        )  # fmt: skip
    return [table]
