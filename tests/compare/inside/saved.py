"""Pictures that Blender has saved."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np


def take(path: Path) -> np.ndarray:
    """The pixels of a picture, float32 [row, column, RGBA], row 0 at the bottom; the file goes."""
    if not path.is_file():
        raise RuntimeError(f"Blender wrote no picture {path.name}")
    image = bpy.data.images.load(str(path), check_existing=False)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    path.unlink()
    return pixels.reshape(height, width, 4)
