"""The project's aims for speed, each as one figure of what was measured."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from bench.core import Row, pick, unique
from bench.ray_tables import rivals
from bench.statistics import geometric_mean, median, ratio
from bench.tables import Table, figure, times

Parts = dict[str, list[Row]]
LARGE = 200_000  # triangles, from which builds count


def pictures(parts: Parts, kind: str) -> list[float]:
    """Cycles' seconds over ours for scenes of a kind (ao, map), 24 views apart."""
    rows = [r for r in parts.get("pictures", []) if "failed" not in r]
    chosen = [r for r in rows if r["scene"].endswith(kind) and not r["views"]]
    return [ratio(r["cycles_seconds"], r["komorebi_seconds"]) for r in chosen]


def views(parts: Parts) -> list[float]:
    """The same for the views of one process."""
    rows = [r for r in parts.get("pictures", []) if r.get("views")]
    return [ratio(r["cycles_seconds"], r["komorebi_seconds"]) for r in rows]


def builds(parts: Parts, ours: str, theirs: str) -> list[float]:
    """Cold builds on the most threads of meshes that are large enough."""
    rows = [r for r in parts.get("build", []) if r["triangles"] >= LARGE]
    threads = max(unique(rows, "threads"), default=0)
    found = []
    for mesh in unique(rows, "mesh"):
        here = {r["mode"]: r for r in pick(rows, mesh=mesh, threads=threads)}
        if ours in here and theirs in here:
            found.append(ratio(here[theirs]["cold_seconds"], here[ours]["cold_seconds"]))
    return found


def rays(parts: Parts, kinds: Iterable[str], against: str, small: bool = False) -> list[float]:
    """Our best tree's rays of each mesh and kind against a rival, on one thread."""
    rows = parts.get("rays", [])
    threads = min(unique(rows, "threads"), default=0)
    found = []
    for kind in kinds:
        for mesh in unique(rows, "mesh"):
            here = pick(rows, rays=kind, mesh=mesh, threads=threads)
            ours = pick(here, engine="komorebi")
            ours = pick(ours, instructions="SSE4") if small else ours
            if not ours:
                continue
            best = min(ours, key=lambda row: median(row["seconds"]))
            found.append(ratio(rivals(here)[against]["seconds"], best["seconds"]))
    return found


def byte_shares(parts: Parts) -> list[float]:
    """Bytes of our largest tree over those of Embree's MEDIUM."""
    rows = parts.get("memory") or parts.get("build", [])
    found = []
    for mesh in unique(rows, "mesh"):
        here = pick(rows, mesh=mesh, threads=max(unique(rows, "threads")))
        ours = max(row["bytes"] for row in pick(here, engine="komorebi"))
        found.append(ours / pick(here, mode="MEDIUM")[0]["bytes"])
    return found


def exports(parts: Parts, new: bool) -> list[float]:
    """Seconds of the first export and build of a million faces, smooth or flat."""
    rows = pick(parts.get("export", []), case="first")
    return [r["seconds_per_million_faces"] for r in rows if r["blender"].startswith("4.5") == new]


def viewport(parts: Parts, case: str, key: str, scene: str = "dragon") -> list[float]:
    """The median of ours: seconds, or pictures a second."""
    rows = pick(parts.get("viewport", []), scene=scene, case=case, engine="KOMOREBI")
    return [median(row[key]) for row in rows if row[key]]


def viewport_ends(parts: Parts, key: str) -> list[float]:
    """Cycles' seconds over ours until all samples are there, or as little noise."""
    rows = pick(parts.get("viewport", []), case="all_samples")
    seconds = {row["engine"]: row[key] for row in rows}
    if len(seconds) < 2 or not all(seconds.values()):
        return []
    return [median(seconds["CYCLES"]) / median(seconds["KOMOREBI"])]


def viewport_latency(parts: Parts) -> list[float]:
    """Milliseconds that rendering adds to a timer's lateness, below which 95 % are."""
    rows = pick(parts.get("viewport", []), case="latency", engine="KOMOREBI")
    return [1e3 * median(row["p95"]) for row in rows]


Aim = tuple[str, str, str, Callable[[Parts], list[float]]]
FAR, NEAR = ("ao:16",), ("ao:16:0.1",)
AIMS: tuple[Aim, ...] = (
    ("whole picture at equal error / Cycles: white sky", "≥ 6×", "≥ 12×", lambda p: pictures(p, "-ao")),
    ("whole picture at equal error / Cycles: map", "≥ 10×", "≥ 30×", lambda p: pictures(p, "-map")),
    ("whole picture at equal error / Cycles: pictures and cut-outs, direct", "≥ 6×", "≥ 12×", lambda p: pictures(p, "-textured")),
    ("whole picture at equal error / Cycles: Sky Texture, direct", "≥ 6×", "≥ 12×", lambda p: pictures(p, "-sky")),
    ("whole picture at equal error / Cycles: 4 bounces", "≥ 4×", "≥ 8×", lambda p: pictures(p, "-bounces")),
    ("24 views in one process / Cycles", "≥ 8×", "≥ 20×", views),
    ("LINEAR build, cold / Embree LOW", "≥ 2×", "≥ 4×", lambda p: builds(p, "LINEAR", "LOW")),
    ("SAH build, cold / Embree MEDIUM", "≥ 2×", "≥ 4×", lambda p: builds(p, "SAH", "MEDIUM")),
    ("AO rays, no limit / Embree MEDIUM, 1 ray", "≥ 1.4×", "≥ 2.2×", lambda p: rays(p, FAR, "medium")),
    ("AO rays, 10 % / Embree MEDIUM, 1 ray", "≥ 1.6×", "≥ 2.5×", lambda p: rays(p, NEAR, "medium")),
    ("AO rays / Embree's best", "≥ 0.95×", "≥ 1.5×", lambda p: rays(p, FAR + NEAR, "best")),
    ("AO rays without AVX / Embree's best single rays", "≥ 1.0×", "≥ 1.3×", lambda p: rays(p, FAR + NEAR, "single", True)),
    ("bytes / Embree MEDIUM", "≤ 0.45×", "≤ 0.30×", byte_shares),
    ("export and build of a million faces, 4.5, seconds", "≤ 0.25", "≤ 0.1", lambda p: exports(p, True)),
    ("the same, 3.4.1", "≤ 0.5", "≤ 0.3", lambda p: exports(p, False)),
    ("switch to Rendered → first picture, seconds", "≤ 0.4", "≤ 0.4", lambda p: viewport(p, "switch", "first")),
    ("switch to Rendered → full resolution", "≤ 0.5", "≤ 0.5", lambda p: viewport(p, "switch", "full")),
    ("object moved → first picture", "≤ 0.12", "≤ 0.12", lambda p: viewport(p, "move_object", "first")),
    ("object moved → full resolution", "≤ 0.25", "≤ 0.25", lambda p: viewport(p, "move_object", "full")),
    ("view moved → first picture", "≤ 0.04", "≤ 0.04", lambda p: viewport(p, "move_view", "first")),
    ("one vertex of the dragon moved → first picture", "≤ 0.25", "≤ 0.25", lambda p: viewport(p, "move_vertex", "first")),
    ("one vertex of 0.2 M triangles moved → first picture", "≤ 0.12", "≤ 0.12", lambda p: viewport(p, "move_vertex", "first", "grid")),
    ("orbit, new views a second", "≥ 15", "≥ 15", lambda p: viewport(p, "orbit", "rate", "orbit")),
    ("playback of 0.1 M triangles in 3.4, frames a second", "≥ 12", "≥ 12", lambda p: viewport(p, "playback", "rate", "playback")),
    ("64 samples after an edit / Cycles", "≥ 8×", "≥ 8×", lambda p: viewport_ends(p, "last")),
    ("as little noise as Cycles' 64 samples / Cycles", "≥ 8×", "≥ 8×", lambda p: viewport_ends(p, "even")),
    ("interface latency while rendering, milliseconds more", "≤ 20", "≤ 20", viewport_latency),
)  # fmt: skip


def table(parts: Parts) -> Table:
    """A line for each aim that something was measured for."""
    made = Table(
        "Aims: geometric means (worst to best)",
        ["aim", "must", "wanted", "measured", "of"],
    )
    for name, must, wanted, measure in AIMS:
        values = measure(parts)
        if not values:
            continue
        show: Callable[[Any], str] = times if must.endswith("×") else figure
        worst, best = min(values), max(values)
        if must.startswith("≤"):
            worst, best = best, worst
        middle = geometric_mean(values) if len(values) > 1 else worst
        told = f"{show(middle)} ({show(worst)} to {show(best)})"
        made.add(name, must, wanted, told, str(len(values)))
    return made
