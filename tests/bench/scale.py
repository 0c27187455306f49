"""scale: how build, bytes and rays grow, and the largest scene that 20 GiB hold."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from bench.core import Row, pick, run_part, unique
from bench.progress import say
from bench.statistics import power_fit
from bench.tables import Table, figure

BUDGET = 20 * 2**30  # bytes
SPARE = 2 * 2**30  # bytes that must stay free beside a run that fills the budget


def rows_of(
    triangles: str, instances: str, threads: int, builders: str = "LINEAR,SAH"
) -> list[Row]:
    """What the C++ part measures at these counts."""
    words = ["--triangles", triangles, "--instances", instances, "--threads", str(threads)]
    return run_part("scale", [*words, "--builders", builders])


def available_bytes() -> int:
    """Memory that could be had without swapping."""
    for line in Path("/proc/meminfo").read_text(encoding="ascii").splitlines():
        if line.startswith("MemAvailable:"):
            return 1024 * int(line.split()[1])
    return 0


def largest(rows: list[Row], tree: str) -> float:
    """Triangles whose build would peak at the budget, by the bytes a triangle of the largest."""
    top = max(pick(rows, grows="triangles", tree=tree), key=lambda row: row["count"])
    return float(BUDGET / (top["peak_bytes"] / top["count"]))


def measure(options: argparse.Namespace) -> list[Row]:
    """1 to 50 million triangles, 1 to a million instances; with --full also a scene of 20 GiB."""
    threads = int((options.threads or "2").split(",")[-1])
    if options.quick:
        return rows_of("1e4,4e4", "1,1e2", threads)
    rows = rows_of("1e6,4e6,16e6,5e7", "1,1e2,1e4,1e6", threads)
    if options.full and available_bytes() < BUDGET + SPARE:
        say(f"scale: no scene of 20 GiB: only {available_bytes() / 2**30:.1f} GiB are free")
    elif options.full:
        wanted = 0.95 * largest(rows, "LINEAR")
        say(f"scale: {wanted / 1e6:.0f} million triangles, to fill 20 GiB")
        rows += rows_of(f"{wanted:.0f}", "1", threads, "LINEAR")[:1]
    return rows


def table_of(rows: list[Row], grows: str) -> Table:
    """A line a size, and the exponents of growth below."""
    table = Table(
        f"Scale, {grows}, {rows[0]['threads']:g} threads",
        [grows, "tree", "build s", "tree's bytes each", "all, at its peak GiB", "ns a ray"],
    )
    for tree in unique(rows, "tree"):
        sizes = pick(rows, tree=tree)
        for row in sizes:
            table.add(
                f"{row['count']:,.0f}", tree, figure(row["build_seconds"]),
                f"{row['tree_bytes'] / row['count']:.1f}", f"{row['peak_bytes'] / 2**30:.2f}",
                figure(1e9 * row["ray_seconds"] / row["ray_count"]),
            )  # fmt: skip
        counts = [row["count"] for row in sizes]
        # A handful of instances builds in less than a clock can tell.
        solid = [k for k, row in enumerate(sizes) if row["build_seconds"] > 1e-3]
        growth: dict[str, list[Any]] = {
            "build": [sizes[k]["build_seconds"] for k in solid],
            "bytes": [row["tree_bytes"] for row in sizes],
            "time a ray": [row["ray_seconds"] / row["ray_count"] for row in sizes],
        }
        told = [
            f"{name} ∝ n^{power_fit([counts[k] for k in solid] if name == 'build' else counts, values)[1]:.2f}"
            for name, values in growth.items()
            if len(values) > 1
        ]
        table.notes.append(f"{tree}: {', '.join(told)}.")
        if grows == "triangles":
            most = largest(rows, tree) / 1e6
            table.notes.append(
                f"{tree}: 20 GiB hold {most:.0f} million triangles while they are built, by the "
                "peak of the largest scene here."
            )
    return table


def tables(rows: list[Row]) -> list[Table]:
    """Triangles, then instances."""
    return [table_of(pick(rows, grows=grows), grows) for grows in ("triangles", "instances")]
