"""Denoises pictures with Open Image Denoise. Run as a program, of which the add-on itself takes
nothing but numbers:

    python -I -S worker.py LIBRARY THREADS  < requests  > answers

A request is HEADER and its planes, float32 [height, width, 3], linear: colour, then as many guides
as it says, albedo and then normal. Its answer is ANSWER and so many bytes: the denoised colour, or
a sentence. One comes after the other; a header without a width stops what is on, which then answers
STOPPED. The program ends with its input.

A process of its own, because a library beside Blender's would share its threads and allocator,
whichever way it is loaded: with Debian's Blender 3.4.1 the library of `pyoidn` 2.5.1 ends in
`munmap_chunk(): invalid pointer`. Only the standard library is needed.
"""

from __future__ import annotations

import ctypes
import os
import queue
import struct
import sys
import threading
from typing import Any, BinaryIO

HEADER = struct.Struct("<5I")  # width, height, guides (0 to 2), prefilter, quality
ANSWER = struct.Struct("<2I")  # state, bytes
DONE, FAILED, STOPPED = range(3)
# What becomes of guides: taken as they are, as if they had no noise; as noisy as the colour;
# denoised first.
NONE, FAST, ACCURATE = range(3)

CPU = 1  # OIDN_DEVICE_TYPE_CPU
FLOAT3 = 3  # OIDN_FORMAT_FLOAT3

_HANDLE, _TEXT, _SIZE = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
_MONITOR = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_double)
_FUNCTIONS = {
    "oidnNewDevice": (_HANDLE, (ctypes.c_int,)),
    "oidnSetDeviceInt": (None, (_HANDLE, _TEXT, ctypes.c_int)),
    "oidnSetDeviceBool": (None, (_HANDLE, _TEXT, ctypes.c_bool)),
    "oidnCommitDevice": (None, (_HANDLE,)),
    "oidnGetDeviceError": (ctypes.c_int, (_HANDLE, ctypes.POINTER(_TEXT))),
    "oidnNewFilter": (_HANDLE, (_HANDLE, _TEXT)),
    "oidnReleaseFilter": (None, (_HANDLE,)),
    "oidnSetSharedFilterImage": (
        None, (_HANDLE, _TEXT, _HANDLE, ctypes.c_int, _SIZE, _SIZE, _SIZE, _SIZE, _SIZE),
    ),
    "oidnSetFilterBool": (None, (_HANDLE, _TEXT, ctypes.c_bool)),
    "oidnSetFilterInt": (None, (_HANDLE, _TEXT, ctypes.c_int)),
    "oidnSetFilterProgressMonitorFunction": (None, (_HANDLE, _MONITOR, _HANDLE)),
    "oidnCommitFilter": (None, (_HANDLE,)),
    "oidnExecuteFilter": (None, (_HANDLE,)),
}  # fmt: skip

Request = tuple[int, tuple[int, ...], list[bytes]]  # its number, header, planes


class Failure(Exception):
    """One sentence for the user."""


class Stopped(Exception):
    """The input asked for it."""


def load(path: str) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(path, getattr(os, "RTLD_LOCAL", 0) | getattr(os, "RTLD_NOW", 0))
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise Failure(f"it is no OpenImageDenoise 2 that loads here ({error})") from error
    return library


class Input:
    """Reads requests on a thread, so that a stop is seen while one is worked on."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self.requests: queue.Queue[Request | None] = queue.Queue()
        self.newest = 0  # the number of what has come last
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while True:
            header = self._stream.read(HEADER.size)
            if len(header) < HEADER.size:
                break
            numbers = HEADER.unpack(header)
            size = 12 * numbers[0] * numbers[1]
            planes = [self._stream.read(size) for _ in range(1 + numbers[2])] if size else []
            if any(len(plane) < size for plane in planes):
                break
            self.newest += 1
            if planes:
                self.requests.put((self.newest, numbers, planes))
        self.newest += 1
        self.requests.put(None)


class Device:
    """The library's device, and the filters for the kind of picture that came last."""

    def __init__(self, library: ctypes.CDLL, threads: int, said: Input) -> None:
        self._library = library
        self._said = said
        self._number = 0  # of the request that is worked on
        self._monitor = _MONITOR(lambda _, __: self._said.newest == self._number)
        self._device = library.oidnNewDevice(CPU)
        self.check()
        library.oidnSetDeviceInt(self._device, b"numThreads", threads)
        library.oidnSetDeviceBool(self._device, b"setAffinity", False)
        library.oidnCommitDevice(self._device)
        self.check()
        self._kind: tuple[int, ...] = ()
        self._filters: list[Any] = []
        self._planes: list[Any] = []  # what the filters read
        self._output: Any = None

    def check(self) -> None:
        message = ctypes.c_char_p()
        if self._library.oidnGetDeviceError(self._device, ctypes.byref(message)):
            raise Failure((message.value or b"an unknown error").decode(errors="replace"))

    def denoise(self, request: Request) -> Any:
        """The denoised colour, as bytes."""
        self._number, kind, planes = request
        if kind != self._kind:
            self._prepare(kind)
        for buffer, plane in zip(self._planes, planes):  # noqa: B905 (all Pythons from 3.10 on)
            ctypes.memmove(buffer, plane, len(plane))
        for denoiser in self._filters:
            self._library.oidnExecuteFilter(denoiser)
            if self._said.newest != self._number:
                self._library.oidnGetDeviceError(self._device, None)  # says that it was stopped
                raise Stopped
            self.check()
        return self._output

    def _prepare(self, kind: tuple[int, ...]) -> None:
        width, height, guides, prefilter, quality = kind
        for denoiser in self._filters:
            self._library.oidnReleaseFilter(denoiser)
        self._kind, self._filters = (), []
        size = 12 * width * height
        self._planes = [ctypes.create_string_buffer(size) for _ in range(1 + guides)]
        self._output = (ctypes.c_char * size)()
        names = (b"color", b"albedo", b"normal")[: 1 + guides]
        images = dict(zip(names, self._planes))  # noqa: B905
        if prefilter == ACCURATE:
            for name in names[1:]:  # in their own place
                self._add((width, height, quality), {name: images[name], b"output": images[name]})
        clean = {b"cleanAux": prefilter != FAST and guides > 0, b"hdr": True}
        self._add((width, height, quality), {**images, b"output": self._output}, clean)
        self._kind = kind

    def _add(
        self, size: tuple[int, int, int], images: dict[bytes, Any],
        flags: dict[bytes, bool] | None = None,
    ) -> None:  # fmt: skip
        library = self._library
        denoiser = library.oidnNewFilter(self._device, b"RT")
        self._filters.append(denoiser)
        for name, buffer in images.items():
            library.oidnSetSharedFilterImage(
                denoiser, name, ctypes.addressof(buffer), FLOAT3, size[0], size[1], 0, 0, 0
            )
        for name, value in (flags or {}).items():
            library.oidnSetFilterBool(denoiser, name, value)
        if size[2]:
            library.oidnSetFilterInt(denoiser, b"quality", size[2])
        library.oidnSetFilterProgressMonitorFunction(denoiser, self._monitor, None)
        library.oidnCommitFilter(denoiser)
        self.check()


def serve(path: str, threads: int, said: Input, answers: BinaryIO) -> None:
    device = None
    while True:
        request = said.requests.get()
        if request is None:
            return
        state, text = DONE, b""
        try:
            device = device or Device(load(path), threads, said)
            text = device.denoise(request)
        except Stopped:
            state = STOPPED
        except Failure as failure:
            state, text = FAILED, str(failure).encode()
        answers.write(ANSWER.pack(state, len(text)))
        answers.write(text)
        answers.flush()


def main(arguments: list[str]) -> None:
    # What the library prints must not get among the pixels.
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    serve(arguments[0], int(arguments[1]), Input(sys.stdin.buffer), answers)
    os._exit(0)  # without the library's own end, which has nothing left to say


if __name__ == "__main__":
    main(sys.argv[1:])
