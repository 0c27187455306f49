"""Denoises one picture with Open Image Denoise. Run as a program, never imported:

    python -I -S worker.py LIBRARY WIDTH HEIGHT THREADS  < colour, albedo, normal  > colour

Each is float32 [HEIGHT, WIDTH, 3], linear. A process of its own, because a library beside Blender's
would share its threads and allocator, whichever way it is loaded: with Debian's Blender 3.4.1 the
library of `pyoidn` 2.5.1 ends in `munmap_chunk(): invalid pointer`. Says what failed on its error
output and exits with 1. Only the standard library is needed.
"""

from __future__ import annotations

import ctypes
import os
import sys

CPU = 1  # OIDN_DEVICE_TYPE_CPU
FLOAT3 = 3  # OIDN_FORMAT_FLOAT3

_HANDLE, _TEXT, _SIZE = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
_FUNCTIONS = {
    "oidnNewDevice": (_HANDLE, (ctypes.c_int,)),
    "oidnSetDeviceInt": (None, (_HANDLE, _TEXT, ctypes.c_int)),
    "oidnSetDeviceBool": (None, (_HANDLE, _TEXT, ctypes.c_bool)),
    "oidnCommitDevice": (None, (_HANDLE,)),
    "oidnGetDeviceError": (ctypes.c_int, (_HANDLE, ctypes.POINTER(_TEXT))),
    "oidnNewFilter": (_HANDLE, (_HANDLE, _TEXT)),
    "oidnSetSharedFilterImage": (
        None, (_HANDLE, _TEXT, _HANDLE, ctypes.c_int, _SIZE, _SIZE, _SIZE, _SIZE, _SIZE),
    ),
    "oidnSetFilterBool": (None, (_HANDLE, _TEXT, ctypes.c_bool)),
    "oidnCommitFilter": (None, (_HANDLE,)),
    "oidnExecuteFilter": (None, (_HANDLE,)),
}  # fmt: skip


class Failure(Exception):
    """One sentence for the user."""


def load(path: str) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(path, getattr(os, "RTLD_LOCAL", 0) | getattr(os, "RTLD_NOW", 0))
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise Failure(f"it is no OpenImageDenoise 2 that loads here ({error})") from error
    return library


def denoise(
    library: ctypes.CDLL, planes: list[bytearray], width: int, height: int, threads: int
) -> bytearray:
    """The denoised colour as a bytearray; `planes` are colour, albedo and normal."""

    def check(device: int | None) -> None:
        message = ctypes.c_char_p()
        if library.oidnGetDeviceError(device, ctypes.byref(message)):
            raise Failure((message.value or b"an unknown error").decode(errors="replace"))

    device = library.oidnNewDevice(CPU)
    check(device)
    library.oidnSetDeviceInt(device, b"numThreads", threads)
    library.oidnSetDeviceBool(device, b"setAffinity", False)
    library.oidnCommitDevice(device)
    check(device)
    denoiser = library.oidnNewFilter(device, b"RT")
    output = bytearray(len(planes[0]))
    names = (b"color", b"albedo", b"normal", b"output")
    buffers = [(ctypes.c_char * len(p)).from_buffer(p) for p in (*planes, output)]
    for name, buffer in zip(names, buffers):  # noqa: B905 (all Pythons from 3.10 on)
        library.oidnSetSharedFilterImage(
            denoiser, name, ctypes.addressof(buffer), FLOAT3, width, height, 0, 0, 0
        )
    library.oidnSetFilterBool(denoiser, b"hdr", True)
    library.oidnSetFilterBool(denoiser, b"cleanAux", True)  # first hits: their noise is of edges
    library.oidnCommitFilter(denoiser)
    library.oidnExecuteFilter(denoiser)
    check(device)
    return output


def main(arguments: list[str]) -> int:
    # What the library prints must not get among the pixels.
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    path = arguments[0]
    width, height, threads = map(int, arguments[1:])
    planes = []
    for _ in range(3):
        plane = bytearray(sys.stdin.buffer.read(width * height * 12))
        if len(plane) != width * height * 12:
            print("the picture did not arrive", file=sys.stderr)
            return 1
        planes.append(plane)
    try:
        output = denoise(load(path), planes, width, height, threads)
    except Failure as failure:
        print(failure, file=sys.stderr)
        return 1
    answer.write(output)
    answer.flush()
    os._exit(0)  # without the library's own end, which has nothing left to say


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
