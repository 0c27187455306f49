"""export: seconds from Blender's depsgraph to the committed scene."""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
from pathlib import Path

from compare import launch

from bench.core import Row, pick, unique
from bench.progress import say
from bench.scenes import PYTHON
from bench.tables import Table, figure

SCRIPT = Path(__file__).resolve().parent / "export_bench.py"
CASES = ("first", "unchanged", "moved", "changed", "kept")


def hosts(script: Path) -> list[list[str]]:
    """How to run a script in the system's Blender where there is one, and in Blender 4.5 as a
    module."""
    blender = shutil.which(os.environ.get("KOMOREBI_BLENDER") or launch.DEFAULT_BLENDER)
    found = [[PYTHON, str(script)]]
    if blender:
        options = ["-b", "--factory-startup", "--python-exit-code", "1", "-P", str(script), "--"]
        found.append([blender, *options])
    return found


def run_in_each_blender(part: str, script: Path, *numbers: int) -> list[Row]:
    """The rows that a script prints as its last line."""
    rows: list[Row] = []
    for command in hosts(script):
        done = subprocess.run(
            [*command, *map(str, numbers)],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            stdin=subprocess.DEVNULL,
            text=True,
            env=launch.environment(),
        )
        lines = [line for line in done.stdout.splitlines() if line.startswith("[{")]
        if not lines:
            raise RuntimeError(f"{command[0]} measured nothing: {done.stdout[-300:]}")
        rows += json.loads(lines[-1])
        say(f"{part}: {rows[-1]['blender']}")
    return rows


def measure(options: argparse.Namespace) -> list[Row]:
    """A million faces, three repetitions: a minute a Blender."""
    faces, repeats = (2000, 1) if options.quick else (1_000_000, options.rounds or 3)
    return run_in_each_blender("export", SCRIPT, faces, repeats)


def tables(rows: list[Row]) -> list[Table]:
    """A line a mesh and release."""
    table = Table(
        "Export and build: seconds from depsgraph to committed scene, a million triangles (a million faces)",
        ["mesh", "Blender", *CASES],
    )
    for release in unique(rows, "blender"):
        for kind in unique(rows, "mesh"):
            for smooth in (False, True):
                here = {r["case"]: r for r in pick(rows, blender=release, mesh=kind, smooth=smooth)}
                cells = [
                    f"{figure(here[c]['seconds_per_million_triangles'])} "
                    f"({figure(here[c]['seconds_per_million_faces'])})"
                    for c in CASES
                ]
                table.add(f"{kind}, {'smooth' if smooth else 'flat'}", release, *cells)
    return [table]
