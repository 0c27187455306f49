"""An image data-block → TextureImage: files, packed files or pixels, for the core's Texture."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ..scene_data import DoubleArray, FloatArray, TextureImage
from .color_spaces import known_space
from .exr import HEADER_BYTES, chromaticities, is_rec_709
from .names import name_of

Warn = Callable[[str], None]
Shape = tuple[str, str, DoubleArray | None]  # colour space, alpha mode, matrix


def export_texture(image: Any, user: Any, frame: int, warn: Warn) -> TextureImage | None:
    """The picture that an Image or Environment Texture node shows at a scene's frame.

    image: bpy.types.Image or None. user: its ImageUser. warn: is told what is wrong, in words that
    go on after the names of the material and node. None: there is no picture, it is magenta.
    """
    if image is None:
        warn("has no image, rendered in magenta")
        return None
    shape = _shape(image, warn)
    if image.source == "TILED":
        return _tiles(image, shape, warn)
    if image.source == "MOVIE" and user is not None:
        show_frame(image, sequence_frame(user, frame))
    elif image.source in {"FILE", "SEQUENCE"} and not image.is_dirty:
        if image.packed_file is None:
            path = _path(image, user, frame)
            warn_of_primaries(image, path, shape, warn)
            return _file(image, path, shape, warn)
        if not image.is_float and image.alpha_mode != "PREMUL":
            return _packed(image, image.packed_file, image.filepath, shape)
    return _pixels(image, shape, warn)


def sequence_frame(user: Any, frame: int) -> int:
    """Which picture of a sequence is shown at a scene's frame, as Blender counts."""
    length = user.frame_duration
    if length == 0:
        return 0
    place = frame - user.frame_start + 1
    if user.use_cyclic:
        place = place % length or length
    return int(min(max(place, 0), length) + user.frame_offset)


def numbered(path: str, number: int) -> str:
    """A sequence's path with another number in place of the last one in the file's name."""
    folder, name = os.path.split(path)
    found = list(re.finditer(r"\d+", os.path.splitext(name)[0]))
    if not found:
        return path
    first, last = found[-1].span()
    sign, digits = ("-" if number < 0 else ""), str(abs(number)).zfill(last - first)
    return os.path.join(folder, name[:first] + sign + digits + name[last:])


def show_frame(image: Any, number: int) -> None:
    """Makes image.pixels those of a film's picture.

    Blender decodes it for whoever looks at it by an ImageUser of that frame, and a legacy texture
    can be looked at from here.
    """
    texture: Any = bpy.data.textures.new("Komorebi", "IMAGE")
    try:
        texture.image = image
        texture.image_user.frame_duration = max(image.frame_duration, 1)
        texture.image_user.frame_current = number
        texture.evaluate((0.0, 0.0, 0.0))
    finally:
        bpy.data.textures.remove(texture)


def unknown_space(image: Any) -> str:
    """What is said of a picture in a colour space that is not known."""
    space = image.colorspace_settings.name
    return (
        f'image "{name_of(image)}": colour space {space} is not supported yet, '
        "taken as linear Rec.709"
    )


def warn_of_primaries(image: Any, path: str, space: Shape, warn: Warn) -> None:
    """Where an OpenEXR file has other primaries than its colour space in Blender says, it is shown
    as that says, as in Cycles."""
    if space[0] == "NON_COLOR" or space[2] is not None:
        return
    try:
        with open(path, "rb") as file:
            colors = chromaticities(file.read(HEADER_BYTES))
    except (OSError, ValueError):
        return  # missing, which is said elsewhere
    if colors is not None and not is_rec_709(colors):
        name = image.colorspace_settings.name
        warn(
            f'image "{name_of(image)}": the file {path} has other primaries than Rec.709, '
            f"rendered in its colour space {name}"
        )


def _shape(image: Any, warn: Warn) -> Shape:
    settings = image.colorspace_settings
    if settings.is_data:
        return "NON_COLOR", image.alpha_mode, None
    known = known_space(settings.name)
    if known is None:
        if settings.name:  # a picture that cannot be read has none
            warn(unknown_space(image))
        known = "LINEAR", None
    return known[0], image.alpha_mode, known[1]


def _texture(name: str, stamp: Any, shape: Shape, **source: Any) -> TextureImage:
    space, alpha, matrix = shape
    said = repr((stamp, space, alpha, None if matrix is None else matrix.tobytes()))
    key = hashlib.blake2b(said.encode("utf-8", "surrogateescape"), digest_size=16).digest()
    return TextureImage(name, key, color_space=space, alpha_mode=alpha, matrix=matrix, **source)


def _absolute(image: Any, path: str) -> str:
    return os.path.normpath(bpy.path.abspath(path, library=image.library))


def _path(image: Any, user: Any, frame: int) -> str:
    path = _absolute(image, image.filepath)
    if image.source == "SEQUENCE" and user is not None:
        return numbered(path, sequence_frame(user, frame))
    return path


def _file(image: Any, path: str, shape: Shape, warn: Warn) -> TextureImage | None:
    try:
        status = os.stat(path)
    except (OSError, ValueError):  # ValueError: a path with a null character
        warn(f'image "{name_of(image)}": the file {path} is missing, rendered in magenta')
        return None
    # A file is known by path, size and time of change; reading it all would cost as much as
    # loading it.
    stamp = (path, status.st_size, status.st_mtime_ns, status.st_ino)
    return _texture(name_of(image), stamp, shape, path=path)


def _packed(image: Any, file: Any, path: str, shape: Shape) -> TextureImage:
    data = bytes(file.data)
    stamp = ("packed", hashlib.blake2b(data, digest_size=16).digest())
    name = name_of(image)
    # the ending tells the format
    ending = os.path.splitext(path)[1]
    return _texture(name if name.endswith(ending) else name + ending, stamp, shape, packed=data)


def _tiles(image: Any, shape: Shape, warn: Warn) -> TextureImage | None:
    """A picture of each tile; a tile without one is left out, and so magenta as in Cycles."""
    if image.is_dirty:
        warn("changes of tiles that are not saved are not rendered")
    packed = {os.path.basename(bpy.path.abspath(f.filepath)): f for f in image.packed_files}
    template = _absolute(image, image.filepath)
    tiles: dict[int, TextureImage] = {}
    for tile in image.tiles:
        column, row = (tile.number - 1001) % 10, (tile.number - 1001) // 10
        path = template.replace("<UDIM>", f"{tile.number:04d}")
        path = path.replace("<UVTILE>", f"u{column + 1}_v{row + 1}")
        file = packed.get(os.path.basename(path))
        texture = (
            _file(image, path, shape, warn) if file is None else _packed(image, file, path, shape)
        )
        if texture is not None:
            tiles[tile.number] = texture
    if not tiles:
        return None
    stamp = ("tiles", [(number, tile.key) for number, tile in sorted(tiles.items())])
    return _texture(name_of(image), stamp, shape, tiles=tiles)


def _pixels(image: Any, shape: Shape, warn: Warn) -> TextureImage | None:
    """What Blender has in memory: floats are linear Rec.709 and weighed by alpha already, bytes are
    as the file has them."""
    width, height = image.size
    channels = image.channels
    if width == 0 or height == 0 or channels == 0:
        warn(f'image "{name_of(image)}" cannot be read by Blender, rendered in magenta')
        return None
    values = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(values)
    values = _four_channels(values.reshape(height, width, channels))
    pixels: Any = values
    if image.is_float:
        shape = (shape[0] if shape[0] == "NON_COLOR" else "LINEAR", shape[1], None)
    else:
        pixels = (values * np.float32(255.0) + np.float32(0.5)).astype(np.uint8)
    stamp = ("pixels", pixels.shape, hashlib.blake2b(pixels, digest_size=16).digest())
    return _texture(name_of(image), stamp, shape, pixels=pixels)


def _four_channels(values: FloatArray) -> FloatArray:
    """As Cycles fills up what Blender has: of two or three channels what is missing is 0, and alpha
    1."""
    height, width, channels = values.shape
    if channels in {1, 4}:
        return values
    result = np.zeros((height, width, 4), np.float32)
    result[:, :, 3] = 1.0
    result[:, :, :channels] = values
    return result
