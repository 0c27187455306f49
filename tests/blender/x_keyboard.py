"""Presses keys of an X display as a person does: requests of the extension XTEST, over its socket.

Blender's own simulated events do not reach what a real Esc sets while a render runs.
"""

import contextlib
import os
import re
import socket
import struct

KEYSYMS = {"Escape": 0xFF1B, "F12": 0xFFC9, "Control": 0xFFE3}
QUERY_EXTENSION, GET_KEYBOARD_MAPPING, FAKE_INPUT = 98, 101, 2
PRESS, RELEASE = 2, 3  # of a key, as events are numbered


class Keyboard:
    """The keyboard of the display that DISPLAY names (":7"), for as long as the program runs."""

    def __init__(self):
        number = re.fullmatch(r":(\d+)(\.0)?", os.environ["DISPLAY"]).group(1)
        self._socket = socket.socket(socket.AF_UNIX)
        try:
            self._socket.connect(f"/tmp/.X11-unix/X{number}")
        except OSError:  # Linux' abstract names are there, too, where /tmp is another
            self._socket.connect(f"\0/tmp/.X11-unix/X{number}")
        self._socket.sendall(struct.pack("<BxHHHHxx", ord("l"), 11, 0, 0, 0))
        (length,) = struct.unpack("<6xH", self._read(8))
        setup = self._read(4 * length)
        first, last = setup[26], setup[27]  # keycodes
        name = b"XTEST"
        present, self._xtest = struct.unpack_from(
            "<8xBB",
            self._ask(struct.pack("<BxHHxx8s", QUERY_EXTENSION, 4, len(name), name)),
        )
        assert present, "the X server has no XTEST"
        count = last - first + 1
        answer = self._ask(struct.pack("<BxHBBxx", GET_KEYBOARD_MAPPING, 2, first, count))
        each = answer[1]  # keysyms of a key
        symbols = struct.unpack(f"<{each * count}I", answer[32:])
        self._codes = {
            name: first + symbols.index(symbol) // each for name, symbol in KEYSYMS.items()
        }

    def press(self, *names):
        """Presses keys one after the other, and lets them go."""
        for name in names:
            self._send(PRESS, name)
        for name in reversed(names):
            self._send(RELEASE, name)

    def close(self):
        with contextlib.suppress(OSError):
            self._socket.close()

    def _send(self, kind, name):
        self._socket.sendall(
            struct.pack("<BBHBBxxII8xhh7xB", self._xtest, FAKE_INPUT, 9, kind, self._codes[name],
                        0, 0, 0, 0, 0)
        )  # fmt: skip

    def _read(self, count):
        parts = bytearray()
        while len(parts) < count:
            part = self._socket.recv(count - len(parts))
            assert part, "the X server went away"
            parts += part
        return bytes(parts)

    def _ask(self, request):
        """The reply to a request; of events a program without windows gets news of keys at most."""
        self._socket.sendall(request)
        reply = self._read(32)
        while reply[0] > 1:
            reply = self._read(32)
        assert reply[0] == 1, reply
        (more,) = struct.unpack_from("<4xI", reply)
        return reply + self._read(4 * more)
