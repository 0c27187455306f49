"""Which meshes the live viewports show. What none of them does any more leaves the cache, which
sculpting would fill with every stroke. No bpy in here.
"""

from __future__ import annotations

import threading

from .. import cache

_lock = threading.Lock()
_shown: dict[int, set[bytes]] = {}  # keys of geometry by viewport


def show(viewport: int, keys: set[bytes]) -> None:
    """From now on this viewport shows these."""
    with _lock:
        before = _shown.get(viewport, set())
        _shown[viewport] = keys
        _drop(before)


def any_shown() -> bool:
    return bool(_shown)


def close(viewport: int) -> None:
    with _lock:
        _drop(_shown.pop(viewport, set()))


def _drop(keys: set[bytes]) -> None:
    cache.drop(keys - set().union(*_shown.values()))
