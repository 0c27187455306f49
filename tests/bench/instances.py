"""instances: seconds and bytes from Blender's instances to the committed scene, a million of them."""

from __future__ import annotations

import argparse
from pathlib import Path

from bench.core import Row
from bench.export import run_in_each_blender
from bench.statistics import median
from bench.tables import Table, figure

SCRIPT = Path(__file__).resolve().parent / "instances_bench.py"
READ = {True: "one by one", False: "all at once"}


def measure(options: argparse.Namespace) -> list[Row]:
    """A million instances of each kind, three renders each: four minutes a Blender."""
    count, repeats = (2000, 1) if options.quick else (1_000_000, options.rounds or 3)
    return run_in_each_blender("instances", SCRIPT, count, repeats)


def tables(rows: list[Row]) -> list[Table]:
    """A line a kind of instancer, way of reading and release."""
    table = Table(
        "Instances: processor seconds a million, and peak bytes each above what was there before",
        ["instances", "Blender", "read", "export s", "its peak", "build s", "its peak"],
    )
    for row in rows:
        table.add(
            f"{row['instances']:,.0f} of {row['kind']}",
            row["blender"],
            READ[row["instancer_first"]],
            figure(median(row["export_seconds_per_million"])),
            figure(row["export_peak_bytes"]),
            figure(median(row["build_seconds_per_million"])),
            figure(row["build_peak_bytes"]),
        )
    return [table]
