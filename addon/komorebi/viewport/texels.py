"""What of a picture goes onto the screen, made before Blender's own thread asks for it."""

from __future__ import annotations

import numpy as np

from ..scene_data import FloatArray
from .view_camera import ViewCamera

LARGEST_HALF = 65504.0  # what overflows a half float would show black


def texels_of(pixels: FloatArray, view: ViewCamera, pixel: int, exposure: float) -> FloatArray:
    """`pixels` [rows, columns, 1 to 4], each `pixel` wide and high on the screen, as texels of the
    view's region [height, width, 4], premultiplied, times `exposure`."""
    rows, columns, channels = pixels.shape
    texels = np.empty((rows, columns, 4), np.float32)
    texels[:, :, :3] = pixels[:, :, :3]  # one channel is grey
    texels[:, :, 3] = pixels[:, :, 3] if channels == 4 else 1.0
    if exposure != 1.0:
        texels[:, :, :3] *= np.float32(exposure)
    np.clip(texels, -LARGEST_HALF, LARGEST_HALF, out=texels)
    if pixel == 1:
        return texels
    large = np.empty((rows, pixel, columns, pixel, 4), np.float32)
    large[:] = texels[:, None, :, None]
    # The first pixel may begin before the region does.
    x = (view.region[0] - view.film[0]) % pixel
    y = (view.region[1] - view.film[1]) % pixel
    large = large.reshape(rows * pixel, columns * pixel, 4)
    return np.ascontiguousarray(large[y : y + view.height, x : x + view.width])
