"""Corners and faces of meshes as Blender 3.4 and 3.5 keep them: arrays of C structures.

foreach_get reads their fields item by item, 17 ms for whether a million faces are smooth; a view of
the memory is three to ten times as fast. The structures are MLoop {uint v, e} and MPoly {int
loopstart, totloop; short mat_nr; char flag, pad}. Their size, and the first and last item, have to
be what Blender's own properties say, or foreach_get it is.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray

CORNER = np.dtype([("vertex", "<u4"), ("edge", "<u4")])
FACE = np.dtype(
    [("start", "<i4"), ("total", "<i4"), ("material", "<i2"), ("flag", "u1"), ("unused", "u1")]
)
SMOOTH = 1  # of FACE's flag


def corners(mesh: Any) -> NDArray[Any] | None:
    """Of type CORNER, valid while nothing touches the mesh; None: not as expected."""
    found = _view(mesh.loops, CORNER)
    if found is None:
        return None
    for i in (0, -1):
        loop = mesh.loops[i]
        if (found[i]["vertex"], found[i]["edge"]) != (loop.vertex_index, loop.edge_index):
            return None
    return found


def faces(mesh: Any) -> NDArray[Any] | None:
    """Of type FACE, valid while nothing touches the mesh; None: not as expected."""
    found = _view(mesh.polygons, FACE)
    if found is None:
        return None
    for i in (0, -1):
        face, said = found[i], mesh.polygons[i]
        if (face["start"], face["total"]) != (said.loop_start, said.loop_total):
            return None
        if bool(face["flag"] & SMOOTH) != said.use_smooth:
            return None
    return found


def ints(items: Any) -> NDArray[Any] | None:
    """The memory of a generic attribute's integers, as Blender 3.6 and later keep them; None: not
    as expected."""
    found = _view(items, np.dtype("<i4"))
    if found is None or (found[0], found[-1]) != (items[0].value, items[len(items) - 1].value):
        return None
    return found


def _view(items: Any, kind: np.dtype[Any]) -> NDArray[Any] | None:
    """The memory of a mesh's collection, if its items lie one after the other."""
    count = len(items)
    if count < 2:
        return None
    first = items[0].as_pointer()
    if first == 0 or items[count - 1].as_pointer() - first != (count - 1) * kind.itemsize:
        return None
    memory: Any = (ctypes.c_char * (count * kind.itemsize)).from_address(first)
    return np.frombuffer(memory, kind)
