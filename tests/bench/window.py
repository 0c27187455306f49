"""A Blender window under Xvfb, driven over a socket and watched from outside.

The screen is a file (`Xvfb -fbdir`), read with mmap: no X client and no GIL is in the way, and the
pixels are those that a person would see. Blender runs inside/window_job.py, whose functions are
called by name. CLOCK_MONOTONIC is the same for both sides.
"""

from __future__ import annotations

import json
import mmap
import os
import shutil
import socket
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from compare import launch

JOB = Path(__file__).resolve().parent / "inside" / "window_job.py"
SIZE = (960, 540)
POLL_SECONDS = 0.004
START_SECONDS = 120.0
TEXT = (slice(0, 90), slice(0, 420))  # where Blender writes what the engine says


class Window:
    """One Blender with one window, which fills its screen."""

    def __init__(self) -> None:
        """Raises RuntimeError without Xvfb or Blender, or when Blender ends at once."""
        xvfb, blender = shutil.which("Xvfb"), os.environ.get("KOMOREBI_BLENDER")
        blender = shutil.which(blender or launch.DEFAULT_BLENDER)
        if xvfb is None or blender is None:
            raise RuntimeError(f"{'Blender' if xvfb else 'Xvfb'} is not installed")
        self._folder = tempfile.mkdtemp(prefix="komorebi-window-")
        reading, writing = os.pipe()
        self._server = subprocess.Popen(
            [xvfb, "-displayfd", str(writing), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24",
             "-nocursor", "-terminate", "-fbdir", self._folder, "-nolisten", "tcp"],
            pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(writing)
        with os.fdopen(reading) as numbers:
            display = ":" + numbers.readline().strip()
        with open(f"{self._folder}/Xvfb_screen0", "rb") as file:
            self._map = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(f"{self._folder}/socket")
        self._listener.listen(1)
        self.log = Path(self._folder) / "log"
        with self.log.open("w") as log:
            self._blender = subprocess.Popen(
                [blender, "--factory-startup", "--no-window-focus", "-p", "0", "0",
                 *map(str, SIZE), "--python-exit-code", "3", "-P", str(JOB), "--",
                 f"{self._folder}/socket"],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                env={**launch.environment(), "DISPLAY": display, "LIBGL_ALWAYS_SOFTWARE": "1"},
            )  # fmt: skip
        self._socket = self._accept()
        self._socket.settimeout(START_SECONDS)

    def _accept(self) -> socket.socket:
        """The connection that Blender makes when its window is there."""
        self._listener.settimeout(1.0)
        end = time.monotonic() + START_SECONDS
        while True:
            try:
                return self._listener.accept()[0]
            except TimeoutError:
                if self._blender.poll() is not None or time.monotonic() > end:
                    said = self.log.read_text(errors="replace")[-300:]
                    self.close()
                    raise RuntimeError(f"Blender has no window: {said}") from None

    def send(self, function: str, *arguments: Any) -> None:
        """Has a function of inside/window_job.py called as soon as Blender's timers run."""
        self._socket.sendall(json.dumps([function, *arguments]).encode() + b"\0")

    def answer(self) -> dict[str, Any]:
        """Of the function sent last: `began` (seconds, monotonic) and `value`."""
        received = b""
        while not received.endswith(b"\0"):
            more = self._socket.recv(1 << 16)
            if not more:
                raise RuntimeError(f"Blender ended: {self.log.read_text(errors='replace')[-300:]}")
            received += more
        answer: dict[str, Any] = json.loads(received[:-1])
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer

    def call(self, function: str, *arguments: Any) -> Any:
        """Sends, waits, and gives back what the function returned."""
        self.send(function, *arguments)
        return self.answer()["value"]

    def raw(self) -> bytes:
        """The screen's bytes, BGRX, top row first."""
        return self._map[-SIZE[0] * SIZE[1] * 4 :]

    def watch(
        self, quiet: float, limit: float = 90.0, first: float = 0.0
    ) -> list[tuple[float, np.ndarray]]:
        """Every distinct picture with its time, until none has come for `quiet` seconds, of which
        the first may take `first` seconds; no longer than `limit`."""
        found: list[tuple[float, np.ndarray]] = []
        last = self.raw()
        seen = start = time.monotonic()
        while (now := time.monotonic()) < start + (limit if found else max(limit, first)):
            if now > seen + (quiet if found else max(first, quiet)):
                break
            raw = self.raw()
            if raw != last:
                time.sleep(0.002)
                while (again := self.raw()) != raw:  # it is being drawn: until two looks agree
                    raw = again
                    time.sleep(0.002)
                found.append((now, picture(raw)))
                last, seen = raw, now
            time.sleep(POLL_SECONDS)
        return found

    def close(self) -> None:
        """Ends Blender and the screen."""
        for open_one in (self._listener, getattr(self, "_socket", None), self._map):
            if open_one is not None:
                open_one.close()
        self._blender.terminate()
        self._blender.wait()
        self._server.terminate()
        self._server.wait()
        shutil.rmtree(self._folder, ignore_errors=True)


def picture(raw: bytes) -> np.ndarray:
    """uint8 [rows, columns, 3], without the text in the corner."""
    pixels = np.frombuffer(raw, np.uint8).reshape(SIZE[1], SIZE[0], 4)[:, :, :3].copy()
    pixels[TEXT] = 0
    return pixels


def block_size(pixels: np.ndarray) -> int:
    """How wide the picture's pixels are on the screen: 1, 2, 4 …, by how many rows differ from the
    one above."""
    part = pixels[100:].astype(np.int16)
    differing = (np.abs(np.diff(part, axis=0)).max(axis=2) > 2).mean(axis=1) > 0.002
    count, rows = int(differing.sum()), len(differing)
    return next((k for k in (32, 16, 8, 4, 2) if count <= 1.2 * rows / k), 1)
