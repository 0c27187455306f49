"""`./run compare --all FOLDER`: every .blend below a folder, each mode, into a Markdown table."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from compare import launch

MODES = ("ao", "world")
HEAD = (
    "| scene | mode | pixels | blocks | excused | disagree | means | seconds | verdict | changed |",
    "|---|---|---|---|---|---|---|---|---|---|",
)


def row(name: str, mode: str, figures: dict[str, Any] | str) -> str:
    """One line of the table: the figures, or why there are none."""
    if isinstance(figures, str):
        return f"| {name} | {mode} | | | | | | | no comparison | {figures} |"
    width, height = figures["size"]
    times = " / ".join(f"{t:.2f}" for t in figures["seconds_a_picture"])
    cells = [
        name,
        mode,
        f"{width} × {height}",
        str(figures["blocks"]),
        str(figures["blocks_excused"] or ""),
        f"{figures['disagreeing_percent']:.2f} %",
        f"{figures['mean_difference_in_standard_errors']:.1f} SE",
        times,
        "agree" if figures["passed"] else "**differ**",
        "; ".join(figures["switched_off"]).replace("|", "/"),
    ]
    return "| " + " | ".join(cells) + " |"


def run_all(
    chosen: argparse.Namespace, compare: Callable[[argparse.Namespace, Path, str], dict[str, Any]]
) -> int:
    """Compare every scene below `chosen.all` in each mode; exit code 1 when any of them differs."""
    scenes = sorted(chosen.all.rglob("*.blend"))
    results: list[dict[str, Any]] = []
    failed = False
    for mode, scene in [(mode, scene) for mode in MODES for scene in scenes]:
        name = str(scene.relative_to(chosen.all))
        try:
            figures: dict[str, Any] | str = compare(chosen, scene, mode)
        except (launch.BlenderFailed, ValueError) as error:
            figures = str(error)
        failed |= isinstance(figures, str) or not figures["passed"]
        results.append({"name": name, "mode": mode, "figures": figures})
        print(row(name, mode, figures), flush=True)
    results.sort(key=lambda result: (result["name"], result["mode"]))
    rows = [row(result["name"], result["mode"], result["figures"]) for result in results]
    if chosen.markdown is not None:
        chosen.markdown.write_text("\n".join([*HEAD, *rows]) + "\n", encoding="utf-8")
    if chosen.json is not None:
        chosen.json.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if not scenes:
        print(f"compare: there is no .blend below {chosen.all}", file=sys.stderr)
        return 2
    return 1 if failed else 0
