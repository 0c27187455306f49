"""Which pixels of the full frame Blender wants."""

from __future__ import annotations

from typing import Any

import numpy as np

Region = tuple[int, int, int, int]


def render_region(render: Any, width: int, height: int) -> Region:
    """(x_min, y_min, x_max, y_max) in pixels of the full frame, half open, row 0 at the bottom.

    The border is rounded as Blender does it: in single precision, towards zero.
    """
    if not render.use_border:
        return (0, 0, width, height)
    x_min, x_max = (_pixel(b, width) for b in (render.border_min_x, render.border_max_x))
    y_min, y_max = (_pixel(b, height) for b in (render.border_min_y, render.border_max_y))
    return (x_min, y_min, x_max, y_max)


def _pixel(fraction: float, size: int) -> int:
    return int(np.float32(fraction) * np.float32(size))
