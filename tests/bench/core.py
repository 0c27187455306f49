"""build, rays and memory: runs the C++ part for each mesh and makes tables of its rows."""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from collections.abc import Iterable
from typing import Any

from bench import meshes
from bench.progress import say
from bench.sources import SOURCES, Source
from bench.statistics import geometric_mean, median, ratio, spread
from bench.tables import Table, figure, times

PROGRAM = meshes.PROJECT / "build" / "release" / "komorebi_bench"
Row = dict[str, Any]


def run_part(part: str, words: Iterable[str]) -> list[Row]:
    """The rows that one call of the C++ part prints."""
    done = subprocess.run(
        [str(PROGRAM), part, *words], stdout=subprocess.PIPE, text=True, check=False
    )
    if done.returncode != 0:
        raise RuntimeError(f"komorebi_bench {part} {' '.join(words)} failed")
    return [json.loads(line) for line in done.stdout.splitlines()]


def chosen_sources(options: argparse.Namespace) -> list[Source]:
    """Those named, or one (--quick), or all."""
    if options.mesh:
        return [s for s in SOURCES if s.name in options.mesh]
    return [s for s in SOURCES if s.name == "bunny"] if options.quick else list(SOURCES)


def run_all(part: str, options: argparse.Namespace, words: dict[str, Any]) -> list[Row]:
    """The C++ part on every mesh; a mesh that is not there is named and left out."""
    rows: list[Row] = []
    for source in chosen_sources(options):
        start = time.perf_counter()
        try:
            argument = source.argument()
        except meshes.Missing as missing:
            say(f"{part}: {source.name} is left out: {missing}")
            continue
        given = {
            "mesh": argument,
            "name": source.name,
            "up": source.up,
            "view": source.view,
            **words,
        }
        rows += run_part(part, [w for k, v in given.items() if v != "" for w in (f"--{k}", str(v))])
        say(f"{part}: {source.name}, {time.perf_counter() - start:.0f} s")
    return rows


def measure_build(options: argparse.Namespace) -> list[Row]:
    """Cold and warm builds; about 15 s a mesh of a million triangles and round."""
    rounds = options.rounds or (1 if options.quick else 7 if options.full else 3)
    modes = "LOW,MEDIUM,MEDIUM+COMPACT,HIGH"
    if options.full:
        modes += ",LOW+COMPACT,HIGH+COMPACT,MEDIUM+ROBUST"
    return run_all(
        "build",
        options,
        {"rounds": rounds, "threads": options.threads or "1,2", "modes": modes},
    )


def measure_rays(options: argparse.Namespace) -> list[Row]:
    """Our traversal and Embree's in turns; about 10 s a mesh, kind of rays and number of threads."""
    kinds = options.kinds or "ao:16,ao:16:0.1,map:16"
    words: dict[str, Any] = {
        "rounds": options.rounds or (1 if options.quick else 7 if options.full else 3),
        "threads": options.threads or ("1,2" if options.full else "1"),
        "tiles": 2 if options.quick else 4,
    }
    if options.full:
        kinds = options.kinds or "camera," + ",".join(
            f"{name}:{count}{reach}"
            for name, reach in (("ao", ""), ("ao", ":0.1"), ("map", ""))
            for count in (1, 16, 64)
        )
        words |= {
            "queries": "1,4,4c,8,8c,16,16c,1M,1Mc",
            "all": 1,
            "modes": "LOW,MEDIUM,MEDIUM+ROBUST,MEDIUM+COMPACT,HIGH",
            "instructions": "AVX2,SSE4",
        }
    try:
        words["map"] = meshes.shared_file("hdri/rooitou_park_1k.hdr")
    except meshes.Missing as missing:
        say(f"rays: no environment rays: {missing}")
        kinds = ",".join(k for k in kinds.split(",") if not k.startswith("map"))
    return run_all("rays", options, {**words, "kinds": kinds})


def pick(rows: list[Row], **wanted: Any) -> list[Row]:
    """The rows with these values."""
    return [row for row in rows if all(row[k] == v for k, v in wanted.items())]


def unique(rows: list[Row], key: str) -> list[Any]:
    """The values of a column in the order of their first appearance."""
    return list(dict.fromkeys(row[key] for row in rows))


def build_tables(rows: list[Row]) -> list[Table]:
    """Million triangles a second, cold (warm), and ratios in the same run."""
    tables = []
    ours = unique(pick(rows, engine="komorebi"), "mode")
    modes = unique(pick(rows, engine="embree"), "mode")
    rivals = {mode: "LOW" if mode == "LINEAR" else "MEDIUM" for mode in ours}
    for threads in unique(rows, "threads"):
        table = Table(
            f"Build, {threads:g} thread{'s' if threads > 1 else ''}: million triangles a second, cold (warm)",
            ["mesh", "triangles", *ours, *(f"Embree {m}" for m in modes)]
            + [f"{mode} / {rivals[mode]} {t}" for mode in ours for t in ("cold", "warm")],
        )
        ratios: dict[str, list[float]] = {}
        worst = 0.0
        for mesh in unique(rows, "mesh"):
            here = {row["mode"]: row for row in pick(rows, mesh=mesh, threads=threads)}
            count = here[ours[0]]["triangles"]
            cells = []
            for mode in [*ours, *modes]:
                cold, warm = here[mode]["cold_seconds"], here[mode]["warm_seconds"]
                worst = max(worst, spread(cold))
                cells.append(
                    f"{figure(count / median(cold) / 1e6)} ({figure(count / median(warm) / 1e6)})"
                )
            for mode in ours:
                for heat in ("cold_seconds", "warm_seconds"):
                    value = ratio(here[rivals[mode]][heat], here[mode][heat])
                    ratios.setdefault(mode + heat, []).append(value)
                    cells.append(times(value))
            table.add(mesh, f"{count:,.0f}", *cells)
        table.add(
            "geometric mean",
            "",
            *[""] * (len(ours) + len(modes)),
            *(times(geometric_mean(v)) for v in ratios.values()),
        )
        table.notes = [
            f"Cold: the first build in a fresh process. Largest spread {100 * worst:.0f} %."
        ]
        tables.append(table)
    return tables


def memory_tables(rows: list[Row]) -> list[Table]:
    """Bytes a triangle of the trees, vertices included where the tracer reads them."""
    rows = pick(rows, threads=max(unique(rows, "threads")))
    modes = unique(rows, "mode")
    ours = unique(pick(rows, engine="komorebi"), "mode")
    table = Table(
        "Memory: bytes a triangle of the finished tree (peak while it is built)",
        [
            "mesh",
            *(m if m in ours else f"Embree {m}" for m in modes),
            *(f"{m} / MEDIUM" for m in ours),
        ],
    )
    ratios: dict[str, list[float]] = {}
    for mesh in unique(rows, "mesh"):
        here = {row["mode"]: row for row in pick(rows, mesh=mesh)}
        cells = [
            f"{here[m]['bytes'] / here[m]['triangles']:.1f} ({here[m]['peak_bytes'] / here[m]['triangles']:.0f})"
            for m in modes
        ]
        for mode in ours:
            value = here[mode]["bytes"] / here["MEDIUM"]["bytes"]
            ratios.setdefault(mode, []).append(value)
            cells.append(times(value))
        table.add(mesh, *cells)
    table.add(
        "geometric mean", *[""] * len(modes), *(times(geometric_mean(v)) for v in ratios.values())
    )
    return [table]
