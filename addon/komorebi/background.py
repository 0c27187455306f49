"""Runs native work on a thread while Blender's own thread asks whether to stop."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

from .errors import RenderCancelled

T = TypeVar("T")

POLL_SECONDS = 0.02  # a cancel must be seen within 50 ms


def run(work: Callable[[], T], should_stop: Callable[[], bool], cancel: Any) -> T:
    """The result of `work()`; asks `should_stop()` meanwhile and then requests `cancel`.

    Returns as soon as the work is done, and raises what it raised; RenderCancelled after a stop.
    """
    results: list[T] = []
    errors: list[BaseException] = []
    done = threading.Event()

    def body() -> None:
        try:
            results.append(work())
        except BaseException as error:
            errors.append(error)
        finally:
            done.set()

    thread = threading.Thread(target=body, name="komorebi-build", daemon=True)
    thread.start()
    stopped = False
    try:
        while not done.wait(POLL_SECONDS):
            if not stopped and should_stop():
                stopped = True
                cancel.request()
    except BaseException:  # Ctrl-C in a bpy process: leave no work behind
        cancel.request()
        raise
    finally:
        thread.join()
    if stopped:
        raise RenderCancelled
    if errors:
        raise errors[0]
    return results[0]
