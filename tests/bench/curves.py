"""Hair: ours beside Embree's curves, which Cycles traces one ray at a time."""

from __future__ import annotations

import argparse
from typing import Any

from bench import core
from bench.statistics import median, ratio
from bench.tables import Table, figure, times

Row = dict[str, Any]


def measure(options: argparse.Namespace) -> list[Row]:
    """Fur of 200,000 strands of 8 segments, ribbons and thick; about 20 s a round."""
    rounds = options.rounds or (1 if options.quick else 7 if options.full else 5)
    strands = 2000 if options.quick else 200000
    words = ["--rounds", str(rounds), "--strands", str(strands)]
    return core.run_part("curves", words)


def tables(rows: list[Row]) -> list[Table]:
    """Builds and memory, and rays on one thread."""
    built = Table(
        "Curves: build, and memory of the finished tree with its keys",
        ["strands × segments", "tree", "seconds", "MB"],
    )
    for row in core.pick(rows, kind="build"):
        tree = f"{row['engine']} {row['tree']}".strip()
        name = f"{row['strands']:,.0f} × {row['segments']:.0f}, {row['shape'].lower()}"
        built.add(name, tree, figure(row["build_seconds"]), figure(row["bytes"] / 1e6))
    traced = Table(
        "Curves, one ray after the other, 1 thread: million rays a second",
        ["shape, rays", "tree", "komorebi", "Embree", "ratio", "differ"],
    )
    for row in core.pick(rows, kind="rays", engine="komorebi"):
        (their,) = core.pick(
            rows, kind="rays", engine="embree", shape=row["shape"], rays=row["rays"],
            beside=row["tree"],
        )  # fmt: skip
        traced.add(
            f"{row['shape'].lower()}, {row['rays']}",
            row["tree"],
            *(figure(r["count"] / median(r["seconds"]) / 1e6) for r in (row, their)),
            times(ratio(their["seconds"], row["seconds"])),
            f"{100.0 * row['differing_share']:.3f} %",
        )
    return [built, traced]
