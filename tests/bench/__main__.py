"""`./run bench`: runs the parts, prints tables, writes the result. See docs/performance.md."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bench import (
    aims,
    core,
    curves,
    export,
    instances,
    machine,
    meshes,
    motion,
    noise,
    options,
    pictures,
    ray_tables,
    scale,
    viewport,
)  # fmt: skip
from bench.progress import say
from bench.tables import Table

SCHEMA = 1
BEGIN, END = "<!-- tables -->", "<!-- end of tables -->"
Rows = list[dict[str, Any]]
Part = tuple[str, Callable[[argparse.Namespace], Rows], Callable[[Rows], list[Table]]]

PARTS: dict[str, Part] = {
    "build": ("2 to 5 minutes", core.measure_build, core.build_tables),
    "rays": ("5 minutes", core.measure_rays, ray_tables.ray_tables),
    "memory": ("as build", core.measure_build, core.memory_tables),
    "pictures": ("20 minutes, longer where references are new", pictures.measure, pictures.tables),
    "export": ("2 minutes", export.measure, export.tables),
    "instances": ("8 minutes", instances.measure, instances.tables),
    "curves": ("1 minute", curves.measure, curves.tables),
    "motion": ("1 minute", motion.measure, motion.tables),
    "scale": ("3 minutes", scale.measure, scale.tables),
    "noise": ("2 minutes", noise.measure, noise.tables),
    "viewport": ("13 minutes", viewport.measure, viewport.tables),
}


def earlier_parts(files: list[Path], part: str) -> tuple[Rows, list[str]]:
    """The rows of a part in earlier results, and the commands that made them."""
    results = [json.loads(file.read_text(encoding="utf-8")) for file in files]
    found = [r["parts"][part] for r in results if part in r["parts"]]
    rows = [row for content in found for row in content["rows"]]
    return rows, list(dict.fromkeys(c for content in found for c in content["commands"]))


def described(earlier: list[Path] | None) -> dict[str, Any]:
    """The machine now, or that of the first of earlier results."""
    if not earlier:
        return machine.describe()
    found: dict[str, Any] = json.loads(earlier[0].read_text(encoding="utf-8"))["machine"]
    return found


def command(part: str, words: list[str]) -> str:
    """What makes one part's tables alone."""
    kept, skip = [], False
    for word in words:
        if not skip and word not in options.PARTS and word not in ("--json", "--markdown"):
            kept.append(word)
        skip = not skip and word in ("--json", "--markdown")
    return " ".join(["./run bench", part, *kept])


def write_markdown(path: Path, text: str) -> None:
    """Into the place that a document keeps for it, or as a document of its own."""
    old = path.read_text(encoding="utf-8") if path.is_file() else ""
    before, found, rest = old.partition(BEGIN)
    if found:
        text = f"{before}{BEGIN}\n\n{text}\n{END}{rest.partition(END)[2]}"
    path.write_text(text, encoding="utf-8")


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
    result |= {"machine": described(chosen.earlier), "parts": {}}
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
            if chosen.earlier:
                rows, commands = earlier_parts(chosen.earlier, part)
            else:
                rows, commands = measured_rows(part, chosen, done), [command(part, words)]
        except RuntimeError as error:
            print(f"./run bench: {part}: {error}", file=sys.stderr)
            failures += 1
            continue
        made = PARTS[part][2](rows) if rows else []
        for table in made:
            print("\n" + table.text(), flush=True)
        tables += [("; ".join(commands), table) for table in made]
        seconds = time.perf_counter() - start
        done[part] = {"seconds": seconds, "commands": commands, "rows": rows}
        done[part]["tables"] = [table.as_json() for table in made]
        target.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    summary = aims.table({part: content["rows"] for part, content in done.items()})
    print("\n" + summary.text())
    if chosen.markdown is not None:
        where = ", ".join(f"{k} {about[k]}" for k in ("cpu", "cores", "revision", "load_average"))
        text = f"Machine: {where}.\n\n" + "\n".join(
            t.markdown(c) for c, t in [("./run bench", summary), *tables]
        )
        write_markdown(chosen.markdown, text)
    print(f"\nWritten to {target}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
