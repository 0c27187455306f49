"""Denoises a viewport's pictures while it renders on: on a thread of its own, the newest one wins.

No bpy in here. A picture of an older view is never shown: each view `begin`s, and what was on for
the one before is given up.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ..denoise.run import Denoiser
from ..errors import RenderCancelled, RenderError
from ..scene_data import FloatArray

if TYPE_CHECKING:
    from .worker import Picture

# Once a view has a denoised picture, the next one waits for so many times what the last one took;
# the processors are the renderer's meanwhile.
DUTY = 2.0
POLL_SECONDS = 0.01


@dataclass(frozen=True, slots=True)
class DenoisingRequest:
    """How a viewport is to be denoised; equal ones need nothing anew."""

    library: str
    threads: int
    guides: tuple[str, ...]  # the core's passes, of denoise.run.GUIDES the first ones
    prefilter: str
    quality: str
    start_sample: int


class ViewDenoiser:
    """One a viewport; `show` is called with each denoised picture, from the thread."""

    def __init__(self, show: Callable[[Picture], None]) -> None:
        self._show = show
        self._condition = threading.Condition()
        self._request: DenoisingRequest | None = None
        self._denoiser: Denoiser | None = None
        self._thread: threading.Thread | None = None
        self._view = 0  # counts them
        self._waiting: tuple[Picture, Sequence[FloatArray]] | None = None
        self._is_busy = False
        self._next = 0.0  # when another picture is worth it
        self.has_shown = False  # a picture of this view
        self.error = ""

    def configure(self, request: DenoisingRequest | None) -> None:
        """From now on so; None: not at all."""
        if request == self._request and not self.error:
            return
        self.close()
        self._request, self.error = request, ""

    @property
    def guides(self) -> tuple[str, ...]:
        """The core's passes that `offer` takes."""
        return self._request.guides if self._request is not None else ()

    def begin(self) -> None:
        """Another view is to be seen."""
        with self._condition:
            self._view += 1
            self._waiting, self._next, self.has_shown = None, 0.0, False
            if self._is_busy and self._denoiser is not None:
                self._denoiser.stop()

    def takes(self, sample: int, is_last: bool) -> bool:
        """Whether a picture of so many samples is to be offered now."""
        if self._request is None or self.error:
            return False
        if is_last:
            return True
        with self._condition:
            is_free = not self._is_busy and time.monotonic() >= self._next
        return is_free and sample >= max(self._request.start_sample, 1)

    def offer(self, picture: Picture, guides: Sequence[FloatArray]) -> None:
        """Has it denoised, in place of what was offered and not begun."""
        with self._condition:
            self._waiting = picture, guides
            if self._thread is None:
                assert self._request is not None
                self._denoiser = Denoiser(self._request.library, self._request.threads)
                self._thread = threading.Thread(
                    target=self._run, args=(self._denoiser, self._request),
                    name="komorebi-denoiser", daemon=True,
                )  # fmt: skip
                self._thread.start()
            self._condition.notify_all()

    def is_finished(self, is_over: Callable[[], bool]) -> bool:
        """Waits until all that was offered is shown; False as soon as `is_over`."""
        while not is_over():
            with self._condition:
                if self._waiting is None and not self._is_busy:
                    return True
                self._condition.wait(POLL_SECONDS)
        return False

    def close(self) -> None:
        """Ends thread and process."""
        with self._condition:
            self._view += 1
            self._waiting, denoiser, thread = None, self._denoiser, self._thread
            self._denoiser = self._thread = None
            self._condition.notify_all()
        if denoiser is not None:
            denoiser.end()
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def _run(self, denoiser: Denoiser, request: DenoisingRequest) -> None:
        with denoiser:
            while True:
                with self._condition:
                    self._condition.wait_for(
                        lambda: self._waiting is not None or self._denoiser is not denoiser
                    )
                    if self._denoiser is not denoiser or self._waiting is None:
                        return
                    (picture, guides), self._waiting = self._waiting, None
                    view, self._is_busy = self._view, True
                start = time.monotonic()
                try:
                    pixels = denoiser.denoise(
                        picture.pixels, guides, request.prefilter, request.quality
                    )
                    self._shown(replace(picture, pixels=pixels, is_denoised=True), view)
                except RenderCancelled:
                    pass
                except RenderError as error:
                    self.error = str(error)
                    self._shown(picture, view)  # says why
                except Exception as error:
                    self.error = f"Denoising failed: {type(error).__name__}: {error}"
                    self._shown(picture, view)
                finally:
                    end = time.monotonic()
                    with self._condition:
                        self._is_busy = False
                        if view == self._view:
                            self._next = end + DUTY * (end - start)
                        self._condition.notify_all()

    def _shown(self, picture: Picture, view: int) -> None:
        with self._condition:
            if view == self._view:
                self.has_shown = picture.is_denoised
                self._show(picture)
