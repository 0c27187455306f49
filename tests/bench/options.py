"""The command line of `./run bench`."""

from __future__ import annotations

import argparse
from pathlib import Path

from bench.scenes import SCENES
from bench.sources import SOURCES

PARTS = (
    "build",
    "rays",
    "memory",
    "pictures",
    "export",
    "instances",
    "curves",
    "motion",
    "scale",
    "noise",
    "viewport",
)


def size(word: str) -> tuple[int, int]:
    """`640x360`."""
    width, height = (int(part) for part in word.split("x"))
    return width, height


def parser() -> argparse.ArgumentParser:
    """All options with their defaults."""
    made = argparse.ArgumentParser(
        prog="./run bench",
        description="Measure Komorebi beside Embree and Cycles; see docs/performance.md.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    made.add_argument(
        "parts", nargs="*", metavar="PART", help=f"{', '.join(PARTS)}; all by default"
    )
    depth = made.add_mutually_exclusive_group()
    depth.add_argument(
        "--quick", action="store_true", help="one small case a part, one round: does it run?"
    )
    depth.add_argument("--full", action="store_true", help="everything: hours")
    made.add_argument(
        "--mesh",
        action="append",
        choices=[s.name for s in SOURCES],
        help="this mesh (may be repeated)",
    )
    made.add_argument("--kinds", help="rays: as ao:16,ao:16:0.1,map:16,camera")
    made.add_argument("--threads", help="as 1,2")
    made.add_argument("--rounds", type=int, help="repetitions")
    made.add_argument(
        "--scene",
        action="append",
        choices=[s.name for s in SCENES],
        help="pictures: this scene (may be repeated)",
    )
    made.add_argument(
        "--size",
        type=size,
        metavar="WIDTHxHEIGHT",
        help="pictures: timed at this size instead; noise: measured at it",
    )
    made.add_argument(
        "--from",
        dest="earlier",
        type=Path,
        action="append",
        metavar="RESULT",
        help="tables of an earlier result, or of several together; nothing is measured",
    )
    made.add_argument(
        "--reference", type=int, nargs=2, metavar=("SEEDS", "SAMPLES"),
        help="pictures: of the references that errors are measured against (8 512)",
    )  # fmt: skip
    made.add_argument("--json", type=Path, help="write the result here too")
    made.add_argument("--markdown", type=Path, help="write the tables here")
    return made


def read(words: list[str]) -> argparse.Namespace:
    """Parse and check; ends with exit code 2 and a sentence for what makes no sense."""
    made = parser()
    options = made.parse_args(words)
    strange = [part for part in options.parts if part not in PARTS]
    if strange:
        made.error(f"no part {', '.join(strange)}: there are {', '.join(PARTS)}")
    options.parts = [part for part in PARTS if part in options.parts or not options.parts]
    return options
