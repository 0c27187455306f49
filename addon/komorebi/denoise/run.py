"""Pictures through the worker and back."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import RenderCancelled, RenderError
from ..scene_data import FloatArray
from . import worker

GUIDES = ("Diffuse Color", "Normal")  # the core's passes that help to denoise
WORKER = os.path.join(os.path.dirname(__file__), "worker.py")
# By Blender's names of them.
PREFILTERS = {"NONE": worker.NONE, "FAST": worker.FAST, "ACCURATE": worker.ACCURATE}
QUALITIES = {"HIGH": 6, "BALANCED": 5, "FAST": 4}  # OIDN_QUALITY_*


class Denoiser:
    """A process that takes one picture after the other; it starts with the first of them."""

    def __init__(self, library: str, threads: int) -> None:
        self.library = library
        self.threads = threads
        self._process: subprocess.Popen[bytes] | None = None
        self._said: Any = None  # the file of what it prints
        self._writing = threading.Lock()
        self._ended = False

    def denoise(
        self, picture: FloatArray, guides: Sequence[FloatArray], prefilter: str = "NONE",
        quality: str = "",
    ) -> FloatArray:  # fmt: skip
        """`picture` [height, width, 3 or 4] with its colour denoised; `guides`, [height, width, 3],
        are of GUIDES, the first ones. RenderError when that fails, RenderCancelled after `stop` or
        `end`."""
        height, width = picture.shape[:2]
        planes = [np.ascontiguousarray(p[:, :, :3], np.float32) for p in (picture, *guides)]
        header = worker.HEADER.pack(
            width, height, len(guides), PREFILTERS[prefilter], QUALITIES.get(quality, 0)
        )
        state, text = self._ask([header, *(plane.data for plane in planes)])
        if state == worker.STOPPED:
            raise RenderCancelled
        if state == worker.FAILED or len(text) != planes[0].nbytes:
            self.end()
            reason = text.decode(errors="replace")
            raise RenderError(f"Denoising with {self.library} failed: {reason}")
        result = picture.copy()
        result[:, :, :3] = np.frombuffer(text, np.float32).reshape(height, width, 3)
        return result

    def stop(self) -> None:
        """From any thread: gives up the picture that is on, within some milliseconds."""
        with self._writing, contextlib.suppress(OSError, ValueError):
            if self._process is not None and self._process.stdin is not None:
                self._process.stdin.write(worker.HEADER.pack(0, 0, 0, 0, 0))
                self._process.stdin.flush()

    def end(self) -> None:
        """From any thread: ends the process for good."""
        self._ended = True
        if self._process is not None:
            self._process.kill()

    request = end  # what `background.run` calls

    def _ask(self, request: list[Any]) -> tuple[int, bytes]:
        process = self._started()
        assert process.stdin is not None
        assert process.stdout is not None
        with contextlib.suppress(OSError, ValueError):  # it has ended, which its answer tells
            with self._writing:
                for part in request:
                    process.stdin.write(part)
                process.stdin.flush()
            answer = process.stdout.read(worker.ANSWER.size)
            if len(answer) == worker.ANSWER.size:
                state, size = worker.ANSWER.unpack(answer)
                return state, process.stdout.read(size)
        if self._ended:
            raise RenderCancelled
        return worker.FAILED, self._last_words(process).encode()

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is None:
            command = [sys.executable, "-I", "-S", WORKER, self.library, str(self.threads)]
            self._said = tempfile.TemporaryFile()  # noqa: SIM115 (as long as the process)
            try:
                self._process = subprocess.Popen(
                    command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said
                )
            except OSError as error:
                raise RenderError(
                    f"Denoising failed: {sys.executable} does not start ({error})"
                ) from error
            if self._ended:  # meanwhile
                self._process.kill()
        return self._process

    def _last_words(self, process: subprocess.Popen[bytes]) -> str:
        process.kill()
        code = process.wait()
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        return str(lines[-1]) if lines else f"it ended with code {code}"

    def __enter__(self) -> Denoiser:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
        process = self._process
        if process is None:
            return
        process.wait()
        for stream in (process.stdin, process.stdout, self._said):
            if stream is not None:
                with contextlib.suppress(OSError, ValueError):
                    stream.close()


def guides(session: Any, width: int, height: int) -> tuple[FloatArray, FloatArray]:
    """Albedo and normal [height, width, 3] of what the camera sees first; zero of the sky."""
    albedo, normal = (session.read(name, 0, 0, width, height) for name in GUIDES)
    return albedo, normal
