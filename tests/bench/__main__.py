"""`./run bench`: runs the parts, prints tables, writes the result. See docs/performance.md."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from typing import Any

from bench import core, export, machine, meshes, options, pictures, ray_tables, scale
from bench.progress import say
from bench.tables import Table

SCHEMA = 1
Rows = list[dict[str, Any]]
Part = tuple[str, Callable[[argparse.Namespace], Rows], Callable[[Rows], list[Table]]]

PARTS: dict[str, Part] = {
    "build": ("2 to 5 minutes", core.measure_build, core.build_tables),
    "rays": ("5 minutes", core.measure_rays, ray_tables.ray_tables),
    "memory": ("as build", core.measure_build, core.memory_tables),
    "pictures": ("20 minutes, longer where references are new", pictures.measure, pictures.tables),
    "export": ("2 minutes", export.measure, export.tables),
    "scale": ("3 minutes", scale.measure, scale.tables),
}


def main(words: list[str]) -> int:
    """Run what the command line asks for; returns the exit code."""
    chosen = options.read(words)
    result: dict[str, Any] = {"schema": SCHEMA, "command": " ".join(["./run bench", *words])}
    result |= {"machine": machine.describe(), "parts": {}}
    about = result["machine"]
    print(f"{about['cpu']}, {about['cores']} cores, {about['compiler']}, revision {about['revision']}, "
          f"load {about['load_average']:.1f}")  # fmt: skip
    tables: list[Table] = []
    measured: Rows = []
    for part in chosen.parts:
        budget, measure, tabulate = PARTS[part]
        say(f"{part}: {'seconds' if chosen.quick else 'hours' if chosen.full else budget}")
        start = time.perf_counter()
        # Memory is measured with the builds.
        rows = measured if part == "memory" and measured else measure(chosen)
        measured = rows if part == "build" else measured
        made = tabulate(rows) if rows else []
        for table in made:
            print("\n" + table.text(), flush=True)
        tables += made
        result["parts"][part] = {
            "seconds": time.perf_counter() - start,
            "rows": rows,
            "tables": [table.as_json() for table in made],
        }
    target = chosen.json or meshes.FOLDER / "result.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    if chosen.markdown is not None:
        text = "\n".join(table.markdown(result["command"]) for table in tables)
        chosen.markdown.write_text(text, encoding="utf-8")
    print(f"\nWritten to {target}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
