"""The film's picture through the worker and back."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import numpy as np

from ..errors import RenderError
from ..scene_data import FloatArray

GUIDES = ("Diffuse Color", "Normal")  # the core's passes that help to denoise
WORKER = os.path.join(os.path.dirname(__file__), "worker.py")


class Kill:
    """What `background.run` calls to stop the worker."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[bytes] | None = None
        self._requested = False

    def request(self) -> None:
        self._requested = True
        if self.process is not None:
            self.process.kill()

    def started(self, process: subprocess.Popen[bytes]) -> None:
        self.process = process
        if self._requested:
            process.kill()


def guides(session: Any, width: int, height: int) -> tuple[FloatArray, FloatArray]:
    """Albedo and normal [height, width, 3] of what the camera sees first; zero of the sky."""
    albedo, normal = (session.read(name, 0, 0, width, height) for name in GUIDES)
    return albedo, normal


def denoised(
    library: str, picture: FloatArray, albedo: FloatArray, normal: FloatArray, threads: int,
    kill: Kill,
) -> FloatArray:  # fmt: skip
    """`picture` [height, width, 4] with its colour denoised; RenderError when that fails."""
    height, width = picture.shape[:2]
    planes = [np.ascontiguousarray(p[:, :, :3], np.float32) for p in (picture, albedo, normal)]
    command = [sys.executable, "-I", "-S", WORKER, library, str(width), str(height), str(threads)]
    try:
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
    except OSError as error:
        raise RenderError(f"Denoising failed: {sys.executable} does not start ({error})") from error
    kill.started(process)
    with process:
        output, said = process.communicate(b"".join(p.tobytes() for p in planes))
    if process.returncode != 0 or len(output) != planes[0].nbytes:
        lines = said.decode(errors="replace").strip().splitlines()
        reason = lines[-1] if lines else f"it ended with code {process.returncode}"
        raise RenderError(f"Denoising with {library} failed: {reason}")
    result = picture.copy()
    result[:, :, :3] = np.frombuffer(output, np.float32).reshape(height, width, 3)
    return result
