"""The side-by-side PNG, read back by hand."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from compare import picture


def read_png(path: Path) -> np.ndarray:
    """8-bit RGB [row, column, 3], row 0 at the bottom, of a PNG without row filters."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, body, size = 8, b"", (0, 0)
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        chunk = data[at + 8 : at + 8 + length]
        (checksum,) = struct.unpack(">I", data[at + 8 + length : at + 12 + length])
        assert checksum == zlib.crc32(kind + chunk)
        size = struct.unpack(">II", chunk[:8]) if kind == b"IHDR" else size
        body += chunk if kind == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(body), np.uint8).reshape(size[1], 1 + 3 * size[0])
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(size[1], size[0], 3)[::-1]


def test_panels_and_difference(tmp_path: Path) -> None:
    a = np.full((8, 12, 4), 0.5, np.float32)
    b = a.copy()
    b[:4, :4, :3], b[4:, 8:, :3] = 0.6, 0.4
    marked = np.zeros((2, 3), bool)
    marked[0, 0] = True
    full = picture.side_by_side(tmp_path / "x.png", a, b, marked)
    assert abs(full - 0.1) < 1e-6
    seen = read_png(tmp_path / "x.png").astype(int)
    assert seen.shape == (8, 3 * 12 + 2 * 4, 3)
    assert (seen[:, :12] == 188).all()  # 0.5 by the sRGB curve
    third = seen[:, 32:]
    assert tuple(third[6, 0]) == (128, 128, 128)
    assert third[2, 2][0] > third[2, 2][2] + 100, "brighter is red"
    assert third[6, 10][2] > third[6, 10][0] + 100, "darker is blue"
    assert tuple(third[0, 2]) == (255, 217, 0), "a block that disagrees has a yellow edge"
