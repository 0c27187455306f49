"""TextureImage → the core's Texture, within a limit of memory. No bpy."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable
from functools import partial
from typing import Any

from . import cache
from .scene_data import TextureImage

LIMIT_BYTES = 1 << 30
MOST_SKIPPED = 16


def load(
    core: Any,
    images: Iterable[TextureImage],
    limit: int,
    threads: int,
    warn: Callable[[str], None],
    averaged: Container[bytes] = (),
    cancel: Any = None,
) -> dict[bytes, Any]:
    """The core.Texture of each image, by its key: those that the cache knows, or new ones. Those
    whose keys are `averaged` have coarser levels.

    Pictures of which all levels together take more than `limit` bytes lose their finest levels,
    the largest first, and `warn` is told so. A broken file is magenta, and told as well. Raises
    core.Cancelled.
    """
    wanted = {image.key: image for image in images}
    pictures = _pictures(wanted.values())
    coarser = set(_pictures(i for i in wanted.values() if i.key in averaged))
    made: dict[bytes, Any] = {}
    skips = _skips(core, pictures, coarser, limit, warn)
    for key, image in pictures.items():
        if key in skips:
            known_as = _known_as(key, skips[key], key in coarser)
            make = partial(_native, core, image, skips[key], key in coarser, threads, cancel)
            try:
                made[key] = cache.get(known_as, make)
                continue
            except core.Cancelled:  # a RuntimeError, too
                raise
            except RuntimeError as error:
                warn(f"{error}, rendered in magenta")
        made[key] = core.Texture.missing(image.name)
    for key, image in wanted.items():
        if image.tiles is not None:
            tiles = {number: made[tile.key] for number, tile in image.tiles.items()}
            made[key] = core.Texture.from_tiles(image.name, tiles)
    return {key: made[key] for key in wanted}


def cache_keys(images: Iterable[TextureImage]) -> set[bytes | None]:
    """What cache.make_room must not drop before these are loaded."""
    pictures = _pictures({image.key: image for image in images}.values())
    ways = [(skip, coarser) for skip in range(MOST_SKIPPED) for coarser in (False, True)]
    return {_known_as(key, *way) for key in pictures for way in ways}


def _known_as(key: bytes, skip: int, coarser: bool) -> bytes:
    return b"texture" + bytes([skip, coarser]) + key


def _pictures(images: Iterable[TextureImage]) -> dict[bytes, TextureImage]:
    """Without tiles, which are pictures of their own; in an order that names decide."""
    found: dict[bytes, TextureImage] = {}
    for image in images:
        for part in [image] if image.tiles is None else image.tiles.values():
            found[part.key] = part
    return dict(sorted(found.items(), key=lambda item: (item[1].name, item[0])))


def _skips(
    core: Any,
    pictures: dict[bytes, TextureImage],
    coarser: set[bytes],
    limit: int,
    warn: Callable[[str], None],
) -> dict[bytes, int]:
    """How many levels of each picture are left out; none for a picture that cannot be read."""
    sizes: dict[bytes, int] = {}
    for key, image in pictures.items():
        try:
            sizes[key] = _byte_count(core, image, key in coarser)
        except RuntimeError as error:
            warn(f"{error}, rendered in magenta")
    skips = dict.fromkeys(sizes, 0)
    while sum(sizes.values()) > limit and any(skip < MOST_SKIPPED - 1 for skip in skips.values()):
        largest = max(sizes, key=lambda key: (sizes[key], key))
        if sizes[largest] < 1024:
            break
        sizes[largest] //= 4
        skips[largest] += 1
    for key, skip in skips.items():
        if skip > 0:
            warn(
                f'image "{pictures[key].name}": textures take more than {limit >> 20} MiB, '
                f"rendered at 1/{1 << skip} of its width"
            )
    return skips


def _byte_count(core: Any, image: TextureImage, coarser: bool) -> int:
    if image.path is not None:
        return int(core.Texture.file_bytes(image.path, image.matrix, coarser))
    if image.pixels is not None:
        return int(image.pixels.nbytes) * (4 if coarser else 3) // 3
    return int(core.Texture.packed_bytes(image.name, image.packed, image.matrix, coarser))


def _native(
    core: Any, image: TextureImage, skip: int, coarser: bool, threads: int, cancel: Any
) -> Any:
    how = {
        "color_space": image.color_space, "alpha_mode": image.alpha_mode, "matrix": image.matrix,
        "skip": skip, "coarser": coarser, "threads": threads, "cancel": cancel,
    }  # fmt: skip
    if image.path is not None:
        return core.Texture.from_file(image.path, **how)
    if image.packed is not None:
        return core.Texture.from_bytes(image.name, image.packed, **how)
    return core.Texture.from_pixels(image.name, image.pixels, **how)
