"""A PNG that shows two pictures and their difference side by side. Written with zlib alone."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

MARK = np.array([1.0, 0.85, 0.0])  # the frame around a block that disagrees


def write_png(path: Path, rgb: np.ndarray) -> None:
    """Write float [row, column, RGB] in 0…1, row 0 at the bottom, as an 8-bit PNG."""
    bytes8 = (np.clip(rgb[::-1], 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
    height, width = bytes8.shape[:2]
    rows = np.concatenate(
        [np.zeros((height, 1), np.uint8), bytes8.reshape(height, width * 3)], axis=1
    )

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 6)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
    )


def display(linear: np.ndarray, exposure: float) -> np.ndarray:
    """Scene-linear values through the sRGB curve (IEC 61966-2-1)."""
    x = np.clip(linear * exposure, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1.0 / 2.4) - 0.055)


def outline(rgb: np.ndarray, marked: np.ndarray, size: int = 4) -> np.ndarray:
    """Draw the left and lower edge of each marked block of size × size pixels."""
    big = np.repeat(np.repeat(marked, size, axis=0), size, axis=1)[: rgb.shape[0], : rgb.shape[1]]
    rows, columns = np.indices(big.shape)
    result = rgb.copy()
    result[big & ((rows % size == 0) | (columns % size == 0))] = MARK
    return result


def side_by_side(path: Path, a: np.ndarray, b: np.ndarray, marked: np.ndarray) -> float:
    """Write first engine | second engine | difference, from means over seeds [row, column, RGBA].

    In the difference grey is equal, red where the second is brighter, blue where it is darker;
    blocks that disagree are outlined in yellow. Returns the difference that is drawn at full
    strength.
    """
    first, second = a[..., :3].astype(np.float64), b[..., :3].astype(np.float64)
    exposure = 1.0 / max(1.0, float(np.percentile(first, 98.0)))
    difference = (second - first).mean(axis=2)
    full = max(float(np.percentile(np.abs(difference), 99.8)), 1e-3)
    signed = np.clip(difference / full, -1.0, 1.0)[..., None]
    red, blue = np.array([0.5, -0.4, -0.5]), np.array([-0.5, -0.3, 0.5])
    third = 0.5 + np.where(signed > 0.0, signed * red, -signed * blue)
    gap = np.ones((first.shape[0], 4, 3))
    panels = [display(first, exposure), gap, display(second, exposure), gap, outline(third, marked)]
    write_png(path, np.concatenate(panels, axis=1))
    return full
