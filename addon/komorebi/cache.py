"""The one place for what outlives a frame: native meshes and environments, found by content.

A key is a digest of everything that the object was made from, so an entry can be old but never
wrong. Entries that two frames in a row did not use go, and before new ones are made so do the
longest unused ones beyond the limit. All go when a file is loaded and when the add-on, the engine
or Persistent Data is switched off (`keeping.py`). After a render in a window they stay only if
Persistent Data asks for it; in background the next render of a batch finds them, unless they are
beyond the limit.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Collection
from typing import Any

LIMIT_BYTES = 2 << 30

_entries: OrderedDict[bytes, tuple[Any, int]] = OrderedDict()
_lock = threading.RLock()  # renders and viewports come here from threads of their own
_generation = 0
hits = 0
misses = 0


def get(key: bytes, make: Callable[[], Any]) -> Any:
    """The object of `key`, from `make()` when it is not here; it must tell its `byte_count`."""
    global hits, misses
    with _lock:
        entry = _entries.get(key)
        if entry is None:
            misses += 1
        else:
            hits += 1
    value = make() if entry is None else entry[0]
    with _lock:
        _entries[key] = (value, _generation)
        _entries.move_to_end(key)
    return value


def peek(key: bytes) -> Any | None:
    """The object of `key`, if it is here; nothing counts as used."""
    entry = _entries.get(key)
    return None if entry is None else entry[0]


def next_generation() -> None:
    """A frame begins: what the last one did not use goes."""
    global _generation
    with _lock:
        for key in [k for k, (_, used) in _entries.items() if used < _generation]:
            del _entries[key]
        _generation += 1


def make_room(wanted: set[bytes | None]) -> None:
    """Drops the longest unused entries beyond the limit, but none that is wanted now."""
    with _lock:
        total = byte_count()
        for key in [k for k in _entries if k not in wanted]:
            if total <= LIMIT_BYTES:
                break
            total -= _entries.pop(key)[0].byte_count


def drop(keys: Collection[bytes]) -> None:
    """These are not wanted any more."""
    with _lock:
        for key in keys:
            _entries.pop(key, None)


def end_job(keep: bool) -> None:
    """A still or an animation is done: nothing stays, or with `keep` what is within the limit."""
    if keep:
        make_room(set())
    else:
        clear()


def byte_count() -> int:
    with _lock:
        return sum(value.byte_count for value, _ in _entries.values())


def entry_count() -> int:
    return len(_entries)


def clear() -> None:
    with _lock:
        _entries.clear()
