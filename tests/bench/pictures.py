"""pictures: whole renders by Cycles and by Komorebi, in turns, at equal error."""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from compare import statistics as agreement

from bench import meshes, render
from bench.progress import say
from bench.scenes import SCENES, Scene
from bench.statistics import median, power_fit, ratio, samples_at_error
from bench.tables import Table, figure, times

Row = dict[str, Any]
SEEDS = (1, 2)  # pictures whose errors are averaged
KOMOREBI_SAMPLES = (2, 4, 8, 16, 32, 64)
ADAPTIVE_THRESHOLDS = (0.1, 0.05, 0.025)
ADAPTIVE_FACTOR = (
    8  # times the fixed samples: the most that a pixel may get when it stops by its noise
)
IMPATIENT_SAMPLES = 8


@dataclass(frozen=True)
class Effort:
    """How long everything is measured."""

    reference: tuple[int, int] = (render.REFERENCE_SEEDS, render.REFERENCE_SAMPLES)
    rounds: int = 1
    size: tuple[int, int] | None = None  # instead of the scene's own
    quick: bool = False


@dataclass(frozen=True)
class Way:
    """Samples and settings by which an engine meets an error."""

    name: str
    samples: int
    settings: dict[str, Any]


def rmse(picture: np.ndarray, reference: np.ndarray) -> float:
    """Root mean square difference over pixels and channels."""
    return float(np.sqrt(np.mean((picture.astype(np.float64) - reference) ** 2)))


def as_large(scene: Scene, effort: Effort) -> dict[str, Any]:
    """Settings of Komorebi's that make its small pictures those of the timed size: what it decides
    by looking at the picture, which pixels four times as wide would change."""
    size = effort.size or scene.size
    done = render.render(scene, "KOMOREBI", size, [(1, 1)], False, {})
    return {"light_samples": done.light_samples[-1]}


def errors(
    scene: Scene, engine: str, truth: np.ndarray, samples: int, settings: dict[str, Any]
) -> tuple[float, float]:
    """RMSE over SEEDS at the small size, and the seconds of a picture."""
    runs = [(samples, seed) for seed in SEEDS]
    done = render.render(scene, engine, render.small_size(scene), runs, True, settings)
    squares = [rmse(picture, truth) ** 2 for picture in done.pictures]
    return float(np.sqrt(np.mean(squares))), median(done.seconds)


def fixed_way(
    scene: Scene, truth: np.ndarray, wanted: float, small: dict[str, Any]
) -> tuple[Way, list[Any]]:
    """The samples at which Komorebi's error is `wanted`: measured at rising counts until it is
    met, interpolated, rounded up. Also (samples, error) of each."""
    found: list[tuple[int, float]] = []
    for samples in KOMOREBI_SAMPLES:
        error, _ = errors(scene, "KOMOREBI", truth, samples, small)
        found.append((samples, error))
        if error <= wanted and len(found) > 1:
            break
    needed = samples_at_error([s for s, _ in found], [e for _, e in found], wanted)
    count = max(1, int(np.ceil(needed - 1e-9)))
    return Way(f"{count} samples", count, {}), found


def adaptive_way(
    scene: Scene, engine: str, truth: np.ndarray, most: int, wanted: float, small: dict[str, Any]
) -> tuple[Way, list[Any]]:
    """The noise threshold at which the engine's own adaptive sampling has the error `wanted`."""
    found: list[tuple[float, float, float]] = []
    base = {"use_adaptive_sampling": True, "adaptive_min_samples": 0}
    for threshold in ADAPTIVE_THRESHOLDS:
        settings = {**base, "adaptive_threshold": threshold}
        error, seconds = errors(scene, engine, truth, most, {**settings, **small})
        found.append((threshold, error, seconds))
        if error <= wanted and len(found) > 1:
            break
    (t0, e0, _), (t1, e1, _) = found[-2:]
    _, slope = power_fit((t0, t1), (e0, e1))
    threshold = float(np.clip(t1 * (wanted / e1) ** (1.0 / max(slope, 0.1)), 0.002, 1.0))
    settings = {**base, "adaptive_threshold": threshold}
    return Way(f"adaptive {threshold:.3f}", most, settings), found


def faster(
    scene: Scene,
    engine: str,
    truth: np.ndarray,
    fixed: Way,
    wanted: float,
    small: dict[str, Any],
) -> tuple[Way, Row]:
    """`fixed` or, where it takes less time at the small size and its error is no larger, adaptive
    sampling."""
    most = ADAPTIVE_FACTOR * fixed.samples
    adaptive, tried = adaptive_way(scene, engine, truth, most, wanted, small)
    _, fixed_seconds = errors(scene, engine, truth, fixed.samples, {**fixed.settings, **small})
    error, seconds = errors(scene, engine, truth, adaptive.samples, {**adaptive.settings, **small})
    # An adaptive render that misses the error by little is credited with the time to meet it.
    fair = seconds * max(1.0, (error / wanted) ** 2)
    figures = {"tried": tried, "seconds": seconds, "error": error, "fixed_seconds": fixed_seconds}
    return (adaptive if fair < fixed_seconds else fixed), figures


def with_alpha(parts: np.ndarray) -> np.ndarray:
    """RGB as the RGBA that `compare` judges."""
    return np.concatenate([parts, np.ones_like(parts[..., :1])], axis=-1)


def measure_scene(scene: Scene, effort: Effort) -> Row:
    """All figures of one scene."""
    say(f"pictures: {scene.name}: references")
    parts = {e: render.reference(scene, e, *effort.reference) for e in ("CYCLES", "KOMOREBI")}
    verdict = agreement.judge(with_alpha(parts["CYCLES"]), with_alpha(parts["KOMOREBI"]))
    truth = {engine: pictures.mean(axis=0, dtype=np.float64) for engine, pictures in parts.items()}

    say(f"pictures: {scene.name}: errors")
    cycles = Way(f"{scene.samples} samples", scene.samples, {})
    wanted, _ = errors(scene, "CYCLES", truth["CYCLES"], cycles.samples, {})
    small = as_large(scene, effort)
    ours, tried = fixed_way(scene, truth["KOMOREBI"], wanted, small)
    row: Row = {"scene": scene.name, "rmse": wanted, "komorebi_errors": tried, **small}
    row |= {"disagreeing_percent": 100.0 * verdict.share, "agree": verdict.passed}
    row |= {"mean_difference_in_standard_errors": verdict.mean_errors}
    if not effort.quick:
        cycles, row["cycles_adaptive"] = faster(
            scene, "CYCLES", truth["CYCLES"], cycles, wanted, {}
        )
        ours, row["komorebi_adaptive"] = faster(
            scene, "KOMOREBI", truth["KOMOREBI"], ours, wanted, small
        )
    row |= {"cycles": cycles.name, "komorebi": ours.name}
    row |= time_scene(scene, cycles, ours, effort, truth)
    return row


def impatient(scene: Scene, engine: str) -> Way:
    """Few samples and the denoiser."""
    settings: dict[str, Any] = {"use_denoising": True}
    if engine == "CYCLES":
        settings |= {"denoiser": "OPENIMAGEDENOISE"}
    return Way(f"{IMPATIENT_SAMPLES} samples, denoised", IMPATIENT_SAMPLES, settings)


def time_scene(scene: Scene, cycles: Way, ours: Way, effort: Effort, truth: dict[str, Any]) -> Row:
    """Seconds of the render operator and of the process, engines in turns, each in new processes."""
    size, views = effort.size or scene.size, min(scene.views, 2) if effort.quick else scene.views
    ways = [
        ("cycles", "CYCLES", cycles),
        ("komorebi", "KOMOREBI", ours),
        ("cycles_denoised", "CYCLES", impatient(scene, "CYCLES")),
        ("komorebi_denoised", "KOMOREBI", impatient(scene, "KOMOREBI")),
    ]
    row: Row = {"width": size[0], "height": size[1], "views": views}
    for _ in range(effort.rounds):
        for name, engine, way in ways:
            try:
                run = [(way.samples, 1)]
                done = render.render(scene, engine, size, run, False, way.settings, views)
            except render.Failed as failure:
                say(f"pictures: {scene.name}: {name}: {failure}")
                continue
            row.setdefault(f"{name}_seconds", []).append(done.seconds[0])
            row.setdefault(f"{name}_process_seconds", []).append(done.process)
            say(f"pictures: {scene.name}: {name}, {way.name}: {done.seconds[0]:.1f} s")
    for name, engine, way in ways[2:]:
        if f"{name}_seconds" in row:
            row[f"{name}_rmse"], _ = errors(scene, engine, truth[engine], way.samples, way.settings)
    return row


def measure(options: argparse.Namespace) -> list[Row]:
    """The scenes that were named, or all of them; a scene whose file is not there is left out."""
    effort = Effort(rounds=options.rounds or (3 if options.full else 1), size=options.size)
    if options.reference is not None:
        effort = replace(effort, reference=tuple(options.reference))
    chosen = [s for s in SCENES if not options.scene or s.name in options.scene]
    if options.quick:
        effort = Effort((2, 32), 1, (160, 90), True)
        chosen = chosen if options.scene else [s for s in chosen if s.kind == "interior"][:1]
    rows: list[Row] = []
    for scene in chosen:
        try:
            rows.append(measure_scene(scene, effort))
        except meshes.Missing as missing:
            say(f"pictures: {scene.name} is left out: {missing}")
        except (render.Failed, ValueError) as failure:
            say(f"pictures: {scene.name} failed: {failure}")
            rows.append({"scene": scene.name, "failed": str(failure)})
    return rows


HEADS = (
    "scene", "size", "RMSE", "Cycles", "s", "process", "Komorebi", "s", "process",
    "render operator", "whole process", "Cycles denoised s (RMSE)", "Komorebi denoised s (RMSE)",
    "references",
)  # fmt: skip


def denoised(row: Row, engine: str) -> str:
    """The cell of a denoised picture."""
    if f"{engine}_denoised_seconds" not in row:
        return "–"
    seconds = median(row[f"{engine}_denoised_seconds"])
    return f"{figure(seconds)} ({row[f'{engine}_denoised_rmse']:.4f})"


def tables(rows: list[Row]) -> list[Table]:
    """One line a scene."""
    says = {scene.name: scene.says for scene in SCENES}
    table = Table(
        "Pictures at equal error: seconds, and how many times as fast as Cycles", list(HEADS)
    )
    for row in rows:
        if "failed" in row:
            table.add(says[row["scene"]], *["–"] * (len(HEADS) - 2), row["failed"])
            continue
        pairs = [(row[f"cycles_{k}"], row[f"komorebi_{k}"]) for k in ("seconds", "process_seconds")]
        (a, b), (c, d) = pairs
        views = f", {row['views']} views" if row["views"] else ""
        table.add(
            says[row["scene"]], f"{row['width']} × {row['height']}{views}", f"{row['rmse']:.4f}",
            row["cycles"], figure(median(a)), figure(median(c)),
            row["komorebi"], figure(median(b)), figure(median(d)),
            times(ratio(a, b)), times(ratio(c, d)), denoised(row, "cycles"), denoised(row, "komorebi"),
            "agree" if row["agree"] else f"differ in {row['disagreeing_percent']:.2f} %",
        )  # fmt: skip
    table.notes = [
        "Denoised: 8 samples and OpenImageDenoise. References: whether the 4,096-sample pictures of "
        "the two engines agree by the test of ./run compare."
    ]
    return [table]
