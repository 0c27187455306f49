"""What an OpenEXR file says of its colours. No bpy."""

from __future__ import annotations

import struct

MAGIC = b"\x76\x2f\x31\x01"
HEADER_BYTES = 1 << 16  # far more than headers have
REC_709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)


def chromaticities(file: bytes) -> tuple[float, ...] | None:
    """Red's, green's, blue's and white's x and y, by the beginning of a file; None: it does not
    say, which means Rec.709 ("Technical Introduction to OpenEXR"), or is no such file."""
    if not file.startswith(MAGIC):
        return None
    at = 8
    while at < len(file) and file[at] != 0:  # attributes: name, type, size, value
        name, _, rest = file[at : at + 512].partition(b"\0")
        kind, found, _ = rest.partition(b"\0")
        begin = at + len(name) + len(kind) + 2
        if not found or len(file) < begin + 4:
            return None
        (size,) = struct.unpack_from("<i", file, begin)
        if size < 0:
            return None
        if (name, kind, size) == (b"chromaticities", b"chromaticities", 32):
            return struct.unpack_from("<8f", file, begin + 4) if len(file) >= begin + 36 else None
        at = begin + 4 + size
    return None


def is_rec_709(colors: tuple[float, ...]) -> bool:
    """As near as the digits that files are written with."""
    return all(abs(a - b) < 2e-3 for a, b in zip(colors, REC_709, strict=True))
