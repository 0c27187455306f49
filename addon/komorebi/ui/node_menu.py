"""Shader nodes in the node editor's Add menu of releases that hide them from other engines.

Up to 3.4 the menu and its search are made from a table, Blender's `nodeitems_builtins`, whose
entries each have a function `poll`: those of shaders ask whether Cycles or EEVEE is chosen. While
this add-on is on, they are told of Cycles when this engine is chosen. Later releases hide nothing
but EEVEE's own nodes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .base import ENGINE_ID

try:
    from nodeitems_builtins import shader_node_categories  # type: ignore[attr-defined]
except ImportError:
    shader_node_categories = ()

_polls: list[tuple[Any, Any]] = []  # the entries changed, and what they had before


class AsCycles:
    """The context as it would be with Cycles chosen."""

    engine = "CYCLES"

    def __init__(self, context: Any) -> None:
        self._context = context

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)


def _asking(poll: Callable[[Any], bool]) -> Callable[[Any], bool]:
    def asking(context: Any) -> bool:
        return poll(AsCycles(context) if context.engine == ENGINE_ID else context)

    return asking


def register() -> None:
    for category in shader_node_categories:
        for item in category.items(None):  # of all engines
            poll = getattr(item, "poll", None)
            if poll is not None:
                _polls.append((item, poll))
                item.poll = _asking(poll)


def unregister() -> None:
    while _polls:
        item, poll = _polls.pop()
        item.poll = poll
