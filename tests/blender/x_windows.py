"""What a window manager does to windows, of which there is none under Xvfb: an X client of its own,
through libX11. Used inside the Blender whose windows they are.
"""

import ctypes
import os


class Display:
    """The display that DISPLAY names."""

    def __init__(self):
        self._x = ctypes.CDLL("libX11.so.6")
        self._x.XOpenDisplay.restype = ctypes.c_void_p
        self._x.XDefaultRootWindow.restype = ctypes.c_ulong
        self._display = ctypes.c_void_p(self._x.XOpenDisplay(os.environ["DISPLAY"].encode()))
        assert self._display, "no display"
        self._root = ctypes.c_ulong(self._x.XDefaultRootWindow(self._display))

    def windows(self):
        """Ids of all top windows with a size, the oldest first while none was raised."""
        root, parent = ctypes.c_ulong(), ctypes.c_ulong()
        children, number = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_uint()
        self._x.XQueryTree(
            self._display, self._root, ctypes.byref(root), ctypes.byref(parent),
            ctypes.byref(children), ctypes.byref(number),
        )  # fmt: skip
        found = [children[i] for i in range(number.value)]
        self._x.XFree(children)
        return [window for window in found if self.size(window)[0] > 16]

    def size(self, window):
        """Width and height in pixels."""
        root = ctypes.c_ulong()
        x, y = ctypes.c_int(), ctypes.c_int()
        numbers = [ctypes.c_uint() for _ in range(4)]
        self._x.XGetGeometry(
            self._display, ctypes.c_ulong(window), ctypes.byref(root), ctypes.byref(x),
            ctypes.byref(y), *(ctypes.byref(n) for n in numbers),
        )  # fmt: skip
        return numbers[0].value, numbers[1].value

    def place(self, window, x, y, width, height):
        """x and y count from the top left of the display."""
        self._x.XMoveResizeWindow(self._display, ctypes.c_ulong(window), x, y, width, height)
        self._x.XSync(self._display, 0)

    def hide(self, window):
        """As a window manager does with a minimised window."""
        self._x.XUnmapWindow(self._display, ctypes.c_ulong(window))
        self._x.XSync(self._display, 0)

    def show(self, window):
        self._x.XMapWindow(self._display, ctypes.c_ulong(window))
        self._x.XSync(self._display, 0)
