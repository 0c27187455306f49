"""Warnings: each one once a job (a still or a whole animation), with a count at its end.

A viewport, which no job renders, collects its own.
"""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_counts: dict[str, int] = {}
_frames = 0
_local = threading.local()


def begin() -> None:
    """A job starts: every warning may appear again."""
    global _frames
    _counts.clear()
    _frames = 0


def count_frame() -> None:
    global _frames
    _frames += 1


def warn(engine: Any, sentence: str) -> None:
    """Shows `sentence` unless this job has shown it. A warning never stops a render.

    Farms look for the word "Error" in the log, so a warning never holds it, not even when a node
    or an object has it in its name.
    """
    if engine.is_preview:  # of something that is still being made
        return
    collected = getattr(_local, "collected", None)
    if collected is not None:
        collected.append(sentence)
        return
    text = "Komorebi: " + re.sub("error", "err.", sentence, flags=re.IGNORECASE)
    known = text in _counts
    _counts[text] = _counts.get(text, 0) + 1
    if not known:
        engine.report({"WARNING"}, text)


@contextmanager
def collected() -> Iterator[list[str]]:
    """What is warned of meanwhile, on this thread, goes into the list and nowhere else."""
    before = getattr(_local, "collected", None)
    sentences: list[str] = []
    _local.collected = sentences
    try:
        yield sentences
    finally:
        _local.collected = before


def end() -> None:
    """A job is over: says how many warnings it had."""
    if _counts:
        times = sum(_counts.values())
        plural = "" if len(_counts) == 1 else "s"
        frames = f"{_frames} frame{'' if _frames == 1 else 's'}"
        print(f"Komorebi: {len(_counts)} warning{plural}, {times} times in {frames}", flush=True)
    _counts.clear()
