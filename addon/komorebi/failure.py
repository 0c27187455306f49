"""Makes a failed frame end the process with a non-zero code, whoever asked for the frame.

`engine.report({'ERROR'})` does so for a scene that Blender renders itself. For a scene strip of
the sequencer, and for a second scene that the compositor reads, Blender ignores the report
(measured: exit code 0 and a picture). In background the frame is then broken off as Ctrl-C would
do it: Blender itself writes no picture and exits with 1. Where Blender listens to no signal (the
`bpy` module) or has used up its first one, the picture is deleted after it was written
(`discard.py`) and the process is given its exit code at its very end.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from typing import Any

import bpy

from . import discard, jobs

_break_sent = False


def fail(engine: Any, depsgraph: Any, sentence: str) -> None:
    """Reports why the frame failed and sees to it that the process will not end in success."""
    if engine.is_preview:
        print(f"Komorebi: no preview: {sentence}", flush=True)
        return
    engine.report({"ERROR"}, f"Komorebi: {sentence}")
    if bpy.app.background and jobs.is_nested(depsgraph.scene.original):
        _break_off()


def _break_off() -> None:
    global _break_sent
    if not _break_sent and _blender_handles_interrupt():
        _break_sent = True  # a second signal would kill Blender on the spot
        sys.stdout.flush()
        signal.raise_signal(signal.SIGINT)
        return
    discard.pictures_since(time.time())
    _exit_with_failure()


def _blender_handles_interrupt() -> bool:
    """True when SIGINT goes to a handler that was not installed by Python: Blender's own."""
    return signal.getsignal(signal.SIGINT) is None


class _FailureAtExit:
    """Ends the process with code 1 when the interpreter, last of all, drops its modules.

    By then every exit function has run and every file is closed.
    """

    def __init__(self) -> None:
        self._exit = os._exit

    def __del__(self) -> None:
        self._exit(1)


def _exit_with_failure() -> None:
    if not hasattr(sys, "_komorebi_failure"):
        sys._komorebi_failure = _FailureAtExit()  # type: ignore[attr-defined]
