"""motion: what it costs a picture that something moves while the shutter is open."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from bench import meshes
from bench.core import Row
from bench.statistics import median, ratio, spread
from bench.tables import Table, figure, times

JOB = Path(__file__).resolve().parent / "motion_job.py"
PACKAGE = meshes.PROJECT / "build" / "release" / "package"


def measure(options: argparse.Namespace) -> list[Row]:
    """A propeller of 102,966 triangles: 10 s a round."""
    rounds, side = (1, 8) if options.quick else (options.rounds or 5, 131)
    path = os.pathsep.join([str(PACKAGE), str(meshes.PROJECT / "tests" / "python")])
    done = subprocess.run(
        [sys.executable, str(JOB), str(rounds), str(side)],
        stdout=subprocess.PIPE,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": path},
    )
    if done.returncode != 0:
        raise RuntimeError(f"{JOB.name} failed")
    rows: list[Row] = json.loads(done.stdout.splitlines()[-1])
    return rows


def tables(rows: list[Row]) -> list[Table]:
    """A line a kind of motion."""
    still = rows[0]["seconds"]
    table = Table(
        f"Motion, {rows[0]['triangles']:,.0f} triangles: processor seconds of a picture",
        ["", "seconds", "/ nothing moves"],
    )
    for row in rows:
        table.add(row["case"], figure(median(row["seconds"])), times(ratio(row["seconds"], still)))
    worst = max(spread(row["seconds"]) for row in rows)
    table.notes = [f"Largest spread {100 * worst:.0f} %."]
    return [table]
