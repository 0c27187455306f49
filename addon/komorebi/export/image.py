"""An image data-block → EnvironmentImage: a file for the core to read, or linear pixels."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ..errors import RenderError
from ..scene_data import EnvironmentImage, FloatArray
from .color_spaces import known_space
from .names import name_of
from .texture import unknown_space, warn_of_primaries


def can_be_map(image: Any) -> bool:
    """Whether a picture may be a world's map as it is. Tiles, films and colours of other primaries
    go through a program."""
    known = known_space(image.colorspace_settings.name)
    return image.source not in {"TILED", "MOVIE"} and (known is None or known[1] is None)


def export_image(node: Any, warn: Callable[[str], None]) -> EnvironmentImage | None:
    """The picture of an Environment Texture node; None when it has none.

    RenderError when its file is missing or its pixels cannot be read.
    """
    image = node.image
    if image is None:
        warn("has no image, rendered in magenta")
        return None
    space = _color_space(image, warn)
    if image.source in {"FILE", "SEQUENCE"} and image.packed_file is None and not image.is_dirty:
        path = _file(image, node.image_user)
        warn_of_primaries(image, path, (space, "", None), warn)
        return EnvironmentImage(name_of(image), path=path, color_space=space)
    return EnvironmentImage(name_of(image), pixels=_pixels(image, space))


def _color_space(image: Any, warn: Callable[[str], None]) -> str:
    settings = image.colorspace_settings
    if settings.is_data:
        return "LINEAR"
    known = known_space(settings.name)
    if known is None:
        warn(unknown_space(image))
    return "LINEAR" if known is None else known[0]


def _file(image: Any, user: Any) -> str:
    path = image.filepath_from_user(image_user=user) or image.filepath
    path = os.path.normpath(bpy.path.abspath(path, library=image.library))
    if not os.path.isfile(path):
        raise RenderError(f'Image "{name_of(image)}" of the world: the file {path} is missing')
    return path


def _pixels(image: Any, space: str) -> FloatArray:
    """Linear pixels [height, width, 3], row 0 at the bottom.

    Blender has made float pictures linear when it loaded them; bytes are as the file has them.
    """
    width, height = image.size
    channels = image.channels
    if width == 0 or height == 0 or channels == 0:
        raise RenderError(f'Image "{name_of(image)}" of the world cannot be read by Blender')
    values = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, channels)
    rgb = values[:, :, :3] if channels >= 3 else np.repeat(values[:, :, :1], 3, axis=2)
    if space == "SRGB" and not image.is_float:
        rgb = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return np.ascontiguousarray(rgb, np.float32)
