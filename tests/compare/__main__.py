"""`./run compare`: renders, tests, and reports; see options.py for the command line."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from compare import launch, options, picture, report, statistics


def compare(chosen: argparse.Namespace, scene: Path, mode: str) -> dict[str, Any]:
    """Compare one scene in one mode; returns the figures, with "passed" and where the pictures
    are."""
    first, second = options.jobs(chosen, scene, mode)
    out = options.folder(chosen, scene, mode)
    host = options.host(chosen)
    a = launch.run(first, host, out / "first-cycles", chosen.reuse)
    b = launch.run(
        second,
        host,
        out / f"second-{second.engine.lower()}",
        chosen.reuse and second.engine == "CYCLES",
    )
    verdict = statistics.judge(a.pixels, b.pixels, a.bent)
    image = out / "side-by-side.png"
    full = picture.side_by_side(
        image, a.pixels.mean(axis=0), b.pixels.mean(axis=0), verdict.disagrees
    )
    return {
        "scene": str(scene),
        "mode": mode,
        "materials": chosen.materials,
        "bounces": chosen.bounces,
        "passed": verdict.passed,
        "engines": [first.engine, second.engine],
        "blender": a.blender,
        "view_layer": a.view_layer,
        "size": [int(a.pixels.shape[2]), int(a.pixels.shape[1])],
        "samples": chosen.samples,
        "seeds": chosen.seeds,
        "flat": chosen.flat,
        "blocks": int(verdict.disagrees.size),
        "blocks_excused": int(verdict.excused.sum()),
        "disagreeing": int(verdict.disagrees.sum()),
        "disagreeing_percent": 100.0 * verdict.share,
        "means": [verdict.mean_a, verdict.mean_b],
        "mean_difference_in_standard_errors": verdict.mean_errors,
        "largest_block_difference": verdict.largest,
        "largest_alpha_difference": verdict.alpha_difference,
        "seconds_a_picture": [sorted(x.seconds)[len(x.seconds) // 2] for x in (a, b)],
        "switched_off": sorted(set(a.notes) | set(b.notes)),
        "difference_at_full_strength": full,
        "picture": str(image),
    }


def main(words: list[str]) -> int:
    """Run the comparison that the command line asks for; returns the exit code."""
    chosen = options.read(words)
    if chosen.all is not None:
        from compare.batch import run_all

        return run_all(chosen, compare)
    try:
        figures = compare(chosen, chosen.scene, chosen.mode)
    except (launch.BlenderFailed, ValueError) as error:
        print(f"compare: {error}", file=sys.stderr)
        return 2
    print(report.table(figures))
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    return 0 if figures["passed"] else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
