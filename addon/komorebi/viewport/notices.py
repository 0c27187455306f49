"""What a viewport warns of: each sentence once in the Info editor and so in the console, and how
many there are, with the first of them, in the viewport's own text.
"""

from __future__ import annotations

from collections.abc import Sequence

import bpy

_waiting: list[str] = []  # for the Info editor


class Notices:
    """Those of one viewport."""

    def __init__(self) -> None:
        self.sentences: list[str] = []  # of what it shows now
        self._said: set[str] = set()

    def hold(self, sentences: Sequence[str]) -> None:
        """From now on these are the ones; says those that it has not said before."""
        self.sentences = list(dict.fromkeys(sentences))
        new = [s for s in self.sentences if s not in self._said]
        self._said.update(new)
        _report(new)

    @property
    def text(self) -> str:
        """One line; empty without any."""
        if not self.sentences:
            return ""
        count = len(self.sentences)
        return f"{count} warning{'' if count == 1 else 's'}: {self.sentences[0]}"


def _report(sentences: Sequence[str]) -> None:
    """An engine's own reports are lost in a viewport, and an operator's that Python calls, too:
    only a modal one's come to the Info editor, and it cannot be called while a region is drawn."""
    if not sentences or bpy.app.background:
        return
    _waiting.extend(sentences)
    if not bpy.app.timers.is_registered(_call):
        bpy.app.timers.register(_call)


def _call() -> None:
    windows = bpy.context.window_manager.windows
    if not windows or not _waiting:
        return
    with bpy.context.temp_override(window=windows[0]):
        bpy.ops.komorebi.report_warnings("INVOKE_DEFAULT")  # type: ignore[attr-defined]


def taken() -> list[str]:
    """What the operator is to report."""
    sentences, _waiting[:] = _waiting[:], []
    return sentences


def drop() -> None:
    """The operator goes away."""
    _waiting.clear()
    if bpy.app.timers.is_registered(_call):
        bpy.app.timers.unregister(_call)
