"""`./run bench`: runs the parts, prints tables, writes the result. See docs/performance.md."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bench import aims, core, export, machine, meshes, options, pictures, ray_tables, scale
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


def earlier_rows(files: list[Path], part: str) -> Rows:
    """The rows of a part in earlier results."""
    results = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    return [row for r in results if part in r["parts"] for row in r["parts"][part]["rows"]]


def measured_rows(part: str, chosen: argparse.Namespace, done: dict[str, Any]) -> Rows:
    """Measure a part now; memory is measured with the builds."""
    budget, measure, _ = PARTS[part]
    say(f"{part}: {'seconds' if chosen.quick else 'hours' if chosen.full else budget}")
    if part == "memory" and "build" in done:
        return list(done["build"]["rows"])
    return measure(chosen)


def main(words: list[str]) -> int:
    """Run what the command line asks for; returns the exit code."""
    chosen = options.read(words)
    result: dict[str, Any] = {"schema": SCHEMA, "command": " ".join(["./run bench", *words])}
    result |= {"machine": machine.describe(), "parts": {}}
    about, done = result["machine"], result["parts"]
    print(f"{about['cpu']}, {about['cores']} cores, {about['compiler']}, {about['instruction_set']}, "
          f"revision {about['revision']}, load {about['load_average']:.1f}")  # fmt: skip
    target = chosen.json or meshes.FOLDER / "result.json"
    target.parent.mkdir(parents=True, exist_ok=True)
    tables: list[tuple[str, Table]] = []
    failures = 0
    for part in chosen.parts:
        start = time.perf_counter()
        try:
            rows = (
                earlier_rows(chosen.earlier, part)
                if chosen.earlier
                else measured_rows(part, chosen, done)
            )
        except RuntimeError as error:
            print(f"./run bench: {part}: {error}", file=sys.stderr)
            failures += 1
            continue
        made = PARTS[part][2](rows) if rows else []
        for table in made:
            print("\n" + table.text(), flush=True)
        tables += [(f"./run bench {part}", table) for table in made]
        seconds = time.perf_counter() - start
        done[part] = {"seconds": seconds, "rows": rows, "tables": [t.as_json() for t in made]}
        target.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    summary = aims.table({part: content["rows"] for part, content in done.items()})
    print("\n" + summary.text())
    if chosen.markdown is not None:
        text = "\n".join(t.markdown(c) for c, t in [("./run bench", summary), *tables])
        chosen.markdown.write_text(text, encoding="utf-8")
    print(f"\nWritten to {target}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
