"""The second table of docs/compatibility.md: scenes with their own materials, worlds and lamps.

    ./run compare SCENE.blend --mode world --materials [--bounces N] ... --json A.json    (for each)
    cd tests && ../build/venv/test/bin/python -m compare.colours A.json B.json ...

prints it; it stands below `HEAD` in that document.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from compare.compatibility import features

HEAD = "## Materials, worlds of nodes, lamps and bounces"


def cell(figures: dict[str, Any] | None) -> str:
    """What came out in one release."""
    if figures is None:
        return "not run"
    share, errors = figures["disagreeing_percent"], figures["mean_difference_in_standard_errors"]
    numbers = f"{share:.2f} %, {errors:.1f} ({figures['samples']} samples, {figures['size'][0]} px)"
    return numbers if figures["passed"] else f"**differs**: {numbers}"


def table(figures: list[dict[str, Any]]) -> str:
    """A row for each scene and number of bounces, a column for each release."""
    releases = sorted({f["blender"] for f in figures})
    told = features()
    rows: dict[tuple[str, int], dict[str, dict[str, Any]]] = {}
    for f in figures:
        rows.setdefault((Path(f["scene"]).stem, f["bounces"]), {})[f["blender"]] = f
    lines = [
        "| feature | scene | bounces | " + " | ".join(f"Blender {r}" for r in releases) + " |",
        "|---|---|---|" + "---|" * len(releases),
    ]
    for (scene, bounces), found in sorted(rows.items()):
        cells = " | ".join(cell(found.get(release)) for release in releases)
        lines.append(f"| {told[scene]} | `{scene}` | {bounces} | {cells} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table([json.loads(Path(p).read_text(encoding="utf-8")) for p in sys.argv[1:]]), end="")
