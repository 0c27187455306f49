"""What of a picture goes onto the screen, made before Blender's own thread asks for it."""

from __future__ import annotations

import numpy as np

from ..scene_data import FloatArray

LARGEST_HALF = 65504.0  # what overflows a half float would show black


def texels_of(pixels: FloatArray, exposure: float) -> FloatArray:
    """`pixels` [rows, columns, 1 to 4] as texels [rows, columns, 4], premultiplied, times
    `exposure`."""
    rows, columns, channels = pixels.shape
    if channels == 4 and exposure == 1.0:
        return np.clip(pixels, -LARGEST_HALF, LARGEST_HALF)
    texels = np.empty((rows, columns, 4), np.float32)
    texels[:, :, :3] = pixels[:, :, :3]  # one channel is grey
    texels[:, :, 3] = pixels[:, :, 3] if channels == 4 else 1.0
    if exposure != 1.0:
        texels[:, :, :3] *= np.float32(exposure)
    return np.clip(texels, -LARGEST_HALF, LARGEST_HALF, out=texels)
