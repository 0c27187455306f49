"""Whether a picture fits into the memory that is free, asked before the work begins."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from . import core
from .errors import RenderError
from .passes import Pass, sources

_FLOAT = 4
_GIB = 1 << 30
_CGROUP = Path("/sys/fs/cgroup")  # of a container, version 2


def picture_bytes(pixels: int, passes: Sequence[Pass]) -> int:
    """Memory for the core's sums and for Blender's picture of so many pixels."""
    of_core: int = core.load().film_bytes_per_pixel(sources(passes))
    of_blender = _FLOAT * sum(p.channels for p in passes)
    return pixels * (of_core + of_blender)


def available_bytes() -> int | None:
    """Memory that this process may still take; None where the system does not tell (not Linux)."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        fields = dict(line.split(":", 1) for line in lines)
        free = int(fields["MemAvailable"].split()[0]) * 1024
    except (OSError, KeyError, ValueError):
        return None
    try:
        limit = int((_CGROUP / "memory.max").read_text())
        used = int((_CGROUP / "memory.current").read_text())
        free = min(free, max(limit - used, 0))
    except (OSError, ValueError):  # no container, or one without a limit ("max")
        pass
    return free


def require(pixels: int, passes: Sequence[Pass], width: int, height: int) -> None:
    """RenderError when the picture cannot fit."""
    needed, free = picture_bytes(pixels, passes), available_bytes()
    if free is not None and needed > free:
        raise RenderError(
            f"{width} × {height} pixels with {len(passes)} passes need {needed / _GIB:.1f} GiB "
            f"of memory, {free / _GIB:.1f} are free: render a smaller picture or parts of it"
        )
