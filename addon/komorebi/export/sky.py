"""The mean colour of a Sky Texture, until skies are rendered as they are."""

from __future__ import annotations

from typing import Any

Color = tuple[float, float, float]

# Mean radiance (linear Rec.709) over all directions of a Sky Texture with its default settings:
# Cycles 3.4.1 and 4.5 through an equirectangular camera, 256 × 128 pixels, weighted by solid angle.
MEAN: dict[str, Color] = {
    "PREETHAM": (0.597, 0.679, 0.997),
    "HOSEK_WILKIE": (0.083, 0.154, 0.219),
}
# Nishita's sky (from 5.0: single and multiple scattering); the sun's disc is most of its light.
MEAN_WITH_SUN: Color = (7.5, 6.0, 4.2)
MEAN_WITHOUT_SUN: Color = (2.11, 2.08, 2.00)


def sky_color(node: Any) -> Color:
    """Linear Rec.709; neither the sun's position nor the air is looked at."""
    if node.sky_type in MEAN:
        return MEAN[node.sky_type]
    return MEAN_WITH_SUN if node.sun_disc else MEAN_WITHOUT_SUN
