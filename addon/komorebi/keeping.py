"""When what outlives a frame (`cache.py`) is given back.

It is gone as soon as no scene uses Komorebi any more, and when Persistent Data, with which it was
rendered, is switched off. Blender says so by an update of its dependency graph: in a window within
a moment, in background before the next render at the latest. `jobs.py` has to be registered first.
"""

from __future__ import annotations

from typing import Any

import bpy
from bpy.app.handlers import persistent

from . import cache, handlers, jobs
from .engine import ENGINE_ID
from .viewport import keys

_was_persistent = False  # the last job was rendered with Persistent Data


def _is_wanted() -> bool:
    """Whether a later render may find again what is kept."""
    if keys.any_shown():
        return True
    renders = [scene.render for scene in bpy.data.scenes if scene.render.engine == ENGINE_ID]
    if bpy.app.background and not _was_persistent:
        return bool(renders)
    return any(render.use_persistent_data for render in renders)


@persistent
def _on_change(*_: Any) -> None:
    # Often called, and in a window while a render fills the cache.
    if cache.entry_count() and not jobs.is_running() and not _is_wanted():
        cache.clear()


@persistent
def _on_end(scene: Any, *_: Any) -> None:
    global _was_persistent
    if jobs.is_running():
        return
    _was_persistent = scene.render.use_persistent_data
    cache.end_job(keep=bpy.app.background or _was_persistent)


@persistent
def _on_load(*_: Any) -> None:
    cache.clear()


_HANDLERS = (
    ("depsgraph_update_post", _on_change),
    ("render_complete", _on_end),
    ("render_cancel", _on_end),
    ("load_pre", _on_load),
)


def register() -> None:
    cache.clear()
    handlers.add(_HANDLERS)


def unregister() -> None:
    cache.clear()
    handlers.remove(_HANDLERS)
