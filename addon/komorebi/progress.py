"""What the user reads while a frame renders: sample, tile, time left and memory."""

from __future__ import annotations

import time
from typing import Any

import bpy

CLOSED = 0.98  # share of rays for ambient occlusion that hit, from which a picture is black

INTERVAL_WINDOW = 0.1  # seconds between two lines in a window
INTERVAL_BACKGROUND = 1.0  # at least; in background each is a line in the log


class Progress:
    """Passes the session's progress on to Blender, not more often than anyone can read."""

    def __init__(self, engine: Any, label: str, said: str) -> None:
        self._engine = engine
        self._label = label
        self._said = said
        self._interval = INTERVAL_BACKGROUND if bpy.app.background else INTERVAL_WINDOW
        self._next = 0.0

    def stage(self, text: str) -> None:
        """Announces what is no sampling."""
        self._engine.update_stats("", f"{self._label} | {text}")

    def update(self, session: Any, final: bool = False) -> None:
        now = time.monotonic()
        if now < self._next and not final:
            return
        state = session.progress()
        # The longer the render, the fewer the lines: 2 % of what has passed.
        self._next = now + max(self._interval, 0.02 * state["elapsed"])
        self._engine.update_progress(min(max(state["fraction"], 0.0), 1.0))
        memory = session.byte_count / 2**20
        self._engine.update_memory_stats(memory_used=memory, memory_peak=memory)
        parts = [self._label, f"Sample {state['sample']}/{state['samples']}"]
        if final:
            parts += _decided(session, state)
            parts.append(f"{state['rays'] / 1e6:.1f}M rays")
        else:
            parts.append(f"Tile {state['tile']}/{state['tiles']}")
            parts.append(f"Remaining {_clock(state['remaining'])}")
        parts.append(f"Memory {memory:.1f}M")
        if final and self._said:
            parts.append(self._said)
        self._engine.update_stats("", " | ".join(parts))


def _decided(session: Any, state: Any) -> list[str]:
    """What was left to the core: how many samples there were, and what stopped them."""
    resolved = session.resolved
    light = resolved["light_samples"]
    parts = [f"{light} light sample{'' if light == 1 else 's'} each"]
    if "adaptive_threshold" in resolved:
        parts.append(f"Noise threshold {resolved['adaptive_threshold']:.4g}")
    if state["mean_samples"] != state["samples"]:
        parts.append(f"{state['mean_samples']:.1f} samples a pixel")
    if state["ambient_rays_blocked"] > CLOSED * state["ambient_rays"] > 0.0:
        parts.append("Closed scene: nearly all occlusion rays hit, set AO Distance")
    return parts


def _clock(seconds: float) -> str:
    """As Blender writes times: 01:02.50, or 1:01:02.50 from an hour on."""
    if not 0.0 <= seconds < 1e7:
        return "unknown"
    minutes, rest = divmod(seconds, 60.0)
    hours, minutes = divmod(int(minutes), 60)
    clock = f"{minutes:02d}:{rest:05.2f}"
    return f"{hours}:{clock}" if hours else clock
