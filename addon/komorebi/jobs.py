"""Knows which scenes Blender is rendering, from its render handlers.

A scene strip starts a render within a render; a second scene that the compositor reads is
rendered without handlers. Everything else (a still, a frame, an animation) is one job.
"""

from __future__ import annotations

from typing import Any

from bpy.app.handlers import persistent

from . import cache, discard, handlers, reporting

_stack: list[Any] = []


def is_running() -> bool:
    """True from the start of a job to its end, whatever engine renders it."""
    return bool(_stack)


def is_nested(scene: Any) -> bool:
    """True when `scene` is rendered on behalf of another scene, which ignores its reports."""
    return len(_stack) > 1 or (bool(_stack) and _stack[-1] != scene)


def framing_scene(scene: Any) -> Any:
    """The scene whose render border counts: the compositor's, when it asked for `scene`."""
    return _stack[-1] if _stack else scene


@persistent
def _on_init(scene: Any, *_: Any) -> None:
    if not _stack:
        reporting.begin()
    _stack.append(scene)


@persistent
def _on_pre(*_: Any) -> None:
    reporting.count_frame()
    cache.next_generation()


@persistent
def _on_write(scene: Any, *_: Any) -> None:
    discard.after_write(scene)


@persistent
def _on_end(*_: Any) -> None:
    if _stack:
        _stack.pop()
    if not _stack:
        reporting.end()


@persistent
def _on_load(*_: Any) -> None:
    _stack.clear()


_HANDLERS = (
    ("render_init", _on_init),
    ("render_pre", _on_pre),
    ("render_write", _on_write),
    ("render_complete", _on_end),
    ("render_cancel", _on_end),
    ("load_pre", _on_load),
)


def register() -> None:
    handlers.add(_HANDLERS)


def unregister() -> None:
    _stack.clear()
    handlers.remove(_HANDLERS)
