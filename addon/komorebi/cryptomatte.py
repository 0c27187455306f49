"""Names → Cryptomatte ids and manifests (Friedman and Jones 2015; specification 1.2.0)."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterable
from functools import lru_cache

_MASK = 0xFFFFFFFF


def murmur3(data: bytes) -> int:
    """MurmurHash3_x86_32 with seed 0 (Appleby 2011), which the specification asks for."""
    c1, c2 = 0xCC9E2D51, 0x1B873593
    hashed = 0
    whole = len(data) // 4 * 4
    for (block,) in struct.iter_unpack("<I", data[:whole]):
        hashed ^= _rotate(block * c1 & _MASK, 15) * c2 & _MASK
        hashed = (_rotate(hashed, 13) * 5 + 0xE6546B64) & _MASK
    tail = int.from_bytes(data[whole:], "little")
    hashed ^= _rotate(tail * c1 & _MASK, 15) * c2 & _MASK
    hashed ^= len(data)
    hashed = (hashed ^ hashed >> 16) * 0x85EBCA6B & _MASK
    hashed = (hashed ^ hashed >> 13) * 0xC2B2AE35 & _MASK
    return hashed ^ hashed >> 16


def _rotate(value: int, bits: int) -> int:
    return (value << bits | value >> (32 - bits)) & _MASK


@lru_cache(maxsize=1 << 16)
def name_id(name: str) -> int:
    """The bits of the float that stands for a name: the hash, but no NaN, infinity or denormal."""
    hashed = murmur3(name.encode("utf-8", "surrogateescape"))
    exponent = hashed >> 23 & 0xFF
    return hashed ^ (1 << 23) if exponent in (0, 0xFF) else hashed


def manifest(names: Iterable[str]) -> str:
    """JSON of name → id as eight hexadecimal digits."""
    return json.dumps({name: f"{name_id(name):08x}" for name in names}, ensure_ascii=False)


def metadata(layer: str, matte: str, names: Iterable[str]) -> dict[str, str]:
    """Fields of the picture file that tell of the Cryptomatte `matte` of a view layer."""
    full_name = f"{layer}.{matte}"
    key = f"cryptomatte/{murmur3(full_name.encode('utf-8', 'surrogateescape')):08x}"[: 12 + 7]
    return {
        f"{key}/name": full_name,
        f"{key}/hash": "MurmurHash3_32",
        f"{key}/conversion": "uint32_to_float32",
        f"{key}/manifest": manifest(names),
    }
