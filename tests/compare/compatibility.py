"""Which features agree with Cycles in which releases of Blender, as a document.

    ./run compare --all blend_scenes --samples 32 --size 160 --json 3.4.json
    ./run compare --all blend_scenes --samples 32 --size 160 --json 4.5.json --python PYTHON_WITH_BPY
    cd tests && ../build/venv/test/bin/python -m compare.compatibility 3.4.json 4.5.json > ../docs/compatibility.md

What each scene stands for is said in blend_scenes/README.md.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

from compare import launch

HEAD = """# What agrees with Cycles, and where

Each scene of `blend_scenes/` is rendered by both engines with matched settings, {samples} samples a pixel at {seeds} seeds,
and tested block by block (Welch's test, light and alpha; [compare.md](compare.md) explains it). A cell has the share of
blocks that disagree (more than 0.5 % would fail) and the distance of the means in standard errors (more than 3 would
fail): ambient occlusion, then light from the scene's world. Pictures are 160 pixels wide, in which a few blocks by chance
are over the limit: such a scene is rendered again at 320 with other seeds, and those figures stand. Made by
`tests/compare/compatibility.py`, which says how. Blender 4.2, 4.3, 5.0 and 5.2 run the same tests (`./run matrix`); which
scenes were held against Cycles 5.0 and 5.2 is said in [compare.md](compare.md).
"""


def features() -> dict[str, str]:
    """Scene → what it proves, from the table in blend_scenes/README.md."""
    text = (launch.PROJECT / "blend_scenes" / "README.md").read_text(encoding="utf-8")
    found: dict[str, str] = {}
    for names, what in re.findall(r"^\| (`.*?) \| (.*?) \|$", text, re.MULTILINE):
        for name in re.findall(r"`([^`]+)`", names):
            found[name] = what
    return found


def cell(results: dict[str, Any]) -> str:
    """What came out for a scene in one release, ambient occlusion first."""
    said = []
    for mode in ("ao", "world"):
        figures = results.get(mode)
        if figures is None:
            said.append("not run")
        elif isinstance(figures, str):
            said.append(f"**none**: {figures}".replace("|", "/"))
        else:
            numbers = (
                f"{figures['disagreeing_percent']:.2f} %, "
                f"{figures['mean_difference_in_standard_errors']:.1f}"
            )
            said.append(numbers if figures["passed"] else f"**differs**: {numbers}")
    return " · ".join(said)


def table(runs: list[list[dict[str, Any]]]) -> str:
    """The document for these runs, one a release."""
    releases: dict[str, dict[str, dict[str, Any]]] = {}
    samples, seeds = set(), set()
    for run in runs:
        known = next(r["figures"] for r in run if not isinstance(r["figures"], str))
        scenes = releases.setdefault(known["blender"], {})
        samples.add(known["samples"])
        seeds.add(known["seeds"])
        for result in run:
            scenes.setdefault(Path(result["name"]).stem, {})[result["mode"]] = result["figures"]
    if len(samples) != 1 or len(seeds) != 1:
        raise ValueError("the runs have different numbers of samples or seeds")
    lines = [
        HEAD.format(samples=samples.pop(), seeds=seeds.pop()),
        "| feature | scene | " + " | ".join(f"Blender {r}" for r in releases) + " |",
        "|---|---|" + "---|" * len(releases),
    ]
    told = features()
    names = sorted({name for scenes in releases.values() for name in scenes})
    missing = [name for name in names if name not in told]
    if missing:
        raise ValueError(f"blend_scenes/README.md does not say what {', '.join(missing)} proves")
    for name in sorted(names, key=list(told).index):
        cells = " | ".join(cell(scenes.get(name, {})) for scenes in releases.values())
        lines.append(f"| {told[name]} | `{name}` | {cells} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table([json.loads(Path(p).read_text(encoding="utf-8")) for p in sys.argv[1:]]), end="")
