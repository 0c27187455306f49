"""viewport: seconds from an edit to pixels on the screen, beside Cycles, in real windows.

Both engines have a Blender 3.4 of their own under Xvfb and take turns. A picture counts when it is
in the framebuffer: the first one (coarse), the first at full resolution, the last of 64 samples.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from bench import meshes
from bench.core import Row, pick, unique
from bench.progress import say
from bench.statistics import median, ratio, spread
from bench.tables import Table, figure, times
from bench.window import Window, block_size, picture

ENGINES = ("CYCLES", "KOMOREBI")
BARE = "BENCH_BARE"  # inside/bare_engine.py, which shows what Blender and the screen take
EDITS = ("switch", "move_object", "move_view", "move_vertex", "change_color", "change_world")
SAYS = {
    "switch": "switch to Rendered", "move_object": "object moved", "move_view": "view moved",
    "move_vertex": "one vertex moved", "change_color": "material colour",
    "change_world": "world strength",
}  # fmt: skip
FEW, MANY = 4, 64  # samples: of most edits, and of one that is watched to its end
QUIET = {FEW: 1.5, MANY: 4.0}  # seconds without a new picture, by which it is done
FIRST_SECONDS = 30.0  # what the first picture may take


def is_rendered(pixels: np.ndarray) -> bool:
    """The white sky is there and something else too, which Solid shading does not show."""
    return bool(pixels[20:60, -60:].mean() > 250.0 and pixels[200:].std() > 1.0)


def noise(pixels: np.ndarray) -> float:
    """How much neighbours differ on the ground in front, which is even but for noise."""
    ground = pixels[430:530, :, 1].astype(np.float32)
    return float(np.abs(np.diff(ground, n=2, axis=1)).mean())


def edit(window: Window, name: str, samples: int) -> dict[str, Any]:
    """Seconds from an edit to its `first`, `full` and `last` picture, the first one's `block` size,
    and when there was how much noise at full resolution; nothing of what was never seen."""
    before = picture(window.raw())
    window.send(name)
    seen = window.watch(QUIET[samples], first=FIRST_SECONDS)
    began = window.answer()["began"]

    def is_full(when: float, pixels: np.ndarray) -> bool:
        counts = name != "switch" or is_rendered(pixels)
        return when > began and counts and block_size(pixels) == 1

    more = seen
    while more and not any(is_full(*one) for one in seen):
        more = window.watch(QUIET[samples], first=FIRST_SECONDS)  # a slow machine
        seen = seen + more
    changed = []
    for when, pixels in seen:
        shows = (pixels != before).any() and (name != "switch" or is_rendered(pixels))
        if when > began and shows:
            changed.append((when - began, block_size(pixels), noise(pixels)))
        before = pixels
    if not changed:
        return {}
    found: dict[str, Any] = {"first": changed[0][0], "block": changed[0][1]}
    full = [(when, grain) for when, block, grain in changed if block == 1]
    if full:
        found |= {"full": full[0][0], "last": changed[-1][0], "noises": full}
    return found


def rate(window: Window, start: str, seconds: float) -> dict[str, float]:
    """New views or frames that were seen, a second, and how coarse their pictures are: of all
    pictures between two turns of the view (or two frames) only one counts."""
    window.call(start)
    before = window.watch(0.5, limit=1.0, first=FIRST_SECONDS)  # until it runs evenly
    pictures = window.watch(seconds, limit=seconds)
    ticks = np.array(window.call("stop"))
    window.watch(1.0)
    times_seen = np.array([when for when, _ in pictures])
    interval = np.unique(np.searchsorted(ticks, times_seen))
    blocks = sorted(block_size(pixels) for _, pixels in pictures or before) or [0]
    inside = (ticks > times_seen[0]) & (ticks < times_seen[-1]) if len(pictures) else ticks < 0.0
    return {
        "rate": len(interval) / seconds,
        "asked_rate": int(inside.sum()) / seconds,
        "block": blocks[len(blocks) // 2],
    }


def late(window: Window, seconds: float) -> list[float]:
    """Mean and 95th percentile of a timer's lateness, in seconds."""
    window.call("start_lateness")
    time.sleep(seconds)
    while window.call("late_count") < 20:  # Blender draws
        time.sleep(0.1)
    lateness = sorted(window.call("stop_lateness"))
    return [sum(lateness) / len(lateness), lateness[math.ceil(0.95 * len(lateness)) - 1]]


class _Rounds:
    """Collects what the engines' turns gave."""

    def __init__(self, windows: dict[str, Window]) -> None:
        self.windows = windows
        self.rows: list[Row] = []

    def scene(self, kind: str, file: str = "", faces: int = 0, method: str = "WORLD_LIGHT") -> int:
        """A new one in both, in Solid shading."""
        triangles = 0
        for engine, window in self.windows.items():
            window.call("set_up", engine, method)
            triangles = window.call("new_scene", kind, file, faces)
            window.watch(0.5)
        return triangles

    def edits(self, scene: str, triangles: int, names: tuple[str, ...], rounds: int) -> None:
        """Some edits, with few samples each; Rendered shading is switched on and off for them."""
        found: dict[tuple[str, str], list[dict[str, Any]]] = {}
        for window in self.windows.values():
            window.call("samples", FEW)
        for _ in range(rounds):
            for name in ("switch", *names):
                for engine, window in self.windows.items():
                    found.setdefault((name, engine), []).append(edit(window, name, FEW))
            for window in self.windows.values():
                window.call("shade", "SOLID")
                window.watch(0.5)
        with self._bare() as window:
            for _ in range(rounds):
                for name in names:
                    found.setdefault((name, BARE), []).append(edit(window, name, FEW))
        self._add(scene, triangles, found)

    @contextmanager
    def _bare(self) -> Iterator[Window]:
        """Komorebi's window in Rendered shading by the engine that renders nothing."""
        window = self.windows["KOMOREBI"]
        window.call("engine", BARE)
        window.call("switch")
        window.watch(0.5)
        yield window
        window.call("shade", "SOLID")
        window.call("engine", "KOMOREBI")
        window.watch(0.5)

    def to_the_end(self, scene: str, triangles: int, rounds: int) -> None:
        """All samples after an object has moved, and `even`, when there was no more noise than
        Cycles leaves at its last."""
        found: dict[tuple[str, str], list[dict[str, Any]]] = {}
        for _ in range(rounds):
            for engine, window in self.windows.items():
                window.call("samples", MANY)
                window.call("switch")
                window.watch(QUIET[FEW], limit=3.0)
                done = edit(window, "move_object", MANY)
                found.setdefault(("all_samples", engine), []).append(done)
                window.call("shade", "SOLID")
                window.watch(0.5)
        cycles, komorebi = (found["all_samples", engine] for engine in ENGINES)
        for theirs, ours in zip(cycles, komorebi, strict=True):
            if "last" in theirs and "last" in ours:
                left = theirs["noises"][-1][1]
                theirs["even"] = theirs["last"]
                ours["even"] = next((t for t, grain in ours["noises"] if grain <= left), math.inf)
        self._add(scene, triangles, found)

    def _add(self, scene: str, triangles: int, found: dict[Any, list[dict[str, Any]]]) -> None:
        for (name, engine), runs in found.items():
            row: Row = {"scene": scene, "triangles": triangles, "case": name, "engine": engine}
            for key in ("first", "full", "last", "even", "block"):
                row[key] = [run[key] for run in runs if key in run]
            self.rows.append(row)

    def rates(self, case: str, start: str, triangles: int, seconds: float, rounds: int) -> None:
        found: dict[str, list[dict[str, float]]] = {}
        for _ in range(rounds):
            for engine, window in self.windows.items():
                window.call("samples", MANY)
                window.call("switch")
                window.watch(QUIET[FEW], limit=2.0)
                found.setdefault(engine, []).append(rate(window, start, seconds))
                window.call("shade", "SOLID")
        with self._bare() as window:
            found[BARE] = [rate(window, start, seconds) for _ in range(rounds)]
        for engine, runs in found.items():
            row: Row = {"scene": case, "triangles": triangles, "case": case, "engine": engine}
            self.rows.append(row | {key: [run[key] for run in runs] for key in runs[0]})

    def latency(self, triangles: int, seconds: float, rounds: int) -> None:
        """How much later timers come while there is rendering than while there is none."""
        for engine, window in self.windows.items():
            added: list[list[float]] = []
            for _ in range(rounds):
                idle = late(window, seconds)
                window.call("samples", 4096)
                window.call("switch")
                time.sleep(2.0)
                busy = late(window, seconds)
                window.call("shade", "SOLID")
                window.watch(0.5)
                added.append([b - i for b, i in zip(busy, idle, strict=True)])
            row: Row = {"scene": "latency", "triangles": triangles, "case": "latency"}
            row |= {"engine": engine, "mean": [a[0] for a in added], "p95": [a[1] for a in added]}
            self.rows.append(row)


@contextmanager
def both() -> Iterator[dict[str, Window]]:
    """A window an engine, with nothing but the viewport in it."""
    with ExitStack() as stack:
        windows = {}
        for engine in ENGINES:
            windows[engine] = window = Window()
            stack.callback(window.close)
            window.call("full_screen")
            window.watch(1.0)
        yield windows


def dragon_file() -> str:
    """The dragon as inside/window_job.py reads it. Raises meshes.Missing."""
    mesh = meshes.read(meshes.shared_file("meshes/dragon_vrip.ply.gz"))
    packed: Path = meshes.FOLDER / "dragon.npz"
    packed.parent.mkdir(parents=True, exist_ok=True)
    np.savez(packed, positions=mesh.positions, corners=mesh.corners.astype(np.int32))
    return str(packed)


def measure(options: argparse.Namespace) -> list[Row]:
    """About thirteen minutes, most of them Cycles'."""
    rounds = 1 if options.quick else options.rounds or 5
    seconds = 1.0 if options.quick else 4.0
    with both() as windows:
        turns = _Rounds(windows)
        if not options.quick:
            try:
                triangles = turns.scene("file", dragon_file())
            except meshes.Missing as missing:
                say(f"viewport: dragon is left out: {missing}")
            else:
                say("viewport: dragon")
                turns.edits("dragon", triangles, EDITS[1:], rounds)
                turns.to_the_end("dragon", triangles, max(1, rounds // 2))
                turns.latency(triangles, seconds, max(1, rounds // 2))
                triangles = turns.scene("file", dragon_file(), method="AMBIENT_OCCLUSION")
                turns.rates("orbit", "start_orbit", triangles, seconds, max(1, rounds // 2))
        say("viewport: a mesh of 0.2 M triangles")
        triangles = turns.scene("grid", faces=2000 if options.quick else 200_000)
        turns.edits("grid", triangles, EDITS[1:4], rounds)
        say("viewport: playback")
        triangles = turns.scene("waves", faces=2000 if options.quick else 100_000)
        turns.rates("playback", "start_playback", triangles, seconds, max(1, rounds // 2))
    return turns.rows


def tables(rows: list[Row]) -> list[Table]:
    """Edits, and what goes on by itself."""
    return [_edit_table(rows), _rate_table(rows)]


def _edit_table(rows: list[Row]) -> Table:
    table = Table(
        "Viewport, 960 × 540: seconds from edit to pixels on the screen, Cycles / Komorebi",
        ["edit", "bare", "first picture", "", "full resolution", "", "64 samples", "", "as even", ""],
    )  # fmt: skip
    spreads = [0.0]
    timed = [r for r in rows if "first" in r]
    for scene in unique(timed, "scene"):
        for case in unique(pick(timed, scene=scene), "case"):
            here = {r["engine"]: r for r in pick(timed, scene=scene, case=case)}
            name = f"{SAYS.get(case, 'object moved')}, {scene} of {here['KOMOREBI']['triangles']:,}"
            cells = [figure(median(here[BARE]["first"])) if BARE in here else ""]
            for key in ("first", "full", "last", "even"):
                cycles, komorebi = (here[engine][key] for engine in ENGINES)
                ends = key in ("last", "even")
                wanted = ends == (case == "all_samples") and cycles and komorebi
                cells += [_pair(cycles, komorebi), _times(cycles, komorebi)] if wanted else ["", ""]
                spreads += [spread(komorebi)] if wanted else []
            table.add(name, *cells)
    table.notes = [
        f"Largest spread of Komorebi's {100 * max(spreads):.0f} %. Bare: an engine that renders "
        "nothing, which is what Blender, its OpenGL and the screen take. As even: with no more noise than "
        "Cycles leaves after 64 samples, each of which has one light ray."
    ]
    return table


def _pair(cycles: list[float], komorebi: list[float]) -> str:
    return f"{figure(median(cycles))} / {figure(median(komorebi))}"


def _times(cycles: list[float], komorebi: list[float]) -> str:
    if len(cycles) == len(komorebi):
        return times(ratio(cycles, komorebi))
    return times(median(cycles) / median(komorebi))  # one was not seen in a round


def _rate_table(rows: list[Row]) -> Table:
    table = Table(
        "Viewport: new pictures a second (of views or frames that there were; pixel width), and "
        "milliseconds that rendering adds to a timer's lateness",
        ["", "triangles", "bare", *ENGINES],
    )
    for case, says in (("orbit", "orbit, ambient occlusion"), ("playback", "playback")):
        here = {r["engine"]: r for r in pick(rows, case=case)}
        if here:
            cells = [
                f"{figure(median(here[e]['rate']))} ({figure(median(here[e]['asked_rate']))}; "
                f"{median(here[e]['block']):.0f})"
                for e in (BARE, *ENGINES)
            ]
            table.add(says, f"{here['KOMOREBI']['triangles']:,}", *cells)
    for key, says in (("mean", "lateness, mean"), ("p95", "lateness, 95 % are below")):
        here = {r["engine"]: r for r in pick(rows, case="latency")}
        if here:
            cells = [f"{1e3 * median(here[e][key]):.1f}" for e in ENGINES]
            table.add(says, f"{here['KOMOREBI']['triangles']:,}", "", *cells)
    return table
