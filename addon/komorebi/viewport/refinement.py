"""How a picture becomes finer: from pixels that are wide on the screen to the final ones."""

from __future__ import annotations

import math
from typing import Any

# The first picture is the finest one that is expected to come within this time, or the coarsest.
FIRST_SECONDS = 0.01
# Edits that come faster one after the other than this are a motion: a turning view, playback. Then
# Blender has the processors for drawing, and nothing finer is begun before there has been none for
# REST_SECONDS.
MOTION_SECONDS, REST_SECONDS = 0.25, 0.08
# The next picture is the finest one that is expected to come within this time. Pictures between
# the first and one at full resolution cost a redraw each, which that one waits for.
STEP_SECONDS = 0.35
# Between two pictures that differ by their samples alone. Each costs a redraw, and shows less that
# is new the later it comes.
FIRST_REDRAW_SECONDS, LAST_REDRAW_SECONDS, REDRAW_SHARE = 0.1, 1.0, 0.25
# Of pictures that are not the last: light rays of each camera ray, while pixels are wide and when
# they are not. So the first picture at full resolution is there in a third of the time.
WIDE_LIGHT_SAMPLES, FINE_LIGHT_SAMPLES = 2, 1
FINE_SHARE = 0.6  # of the time of a pixel, for that


def first_pixel(
    width: int, height: int, start_resolution: int, final: int, cost: float = math.inf
) -> int:
    """How wide the first picture's pixels are: its longer side has `start_resolution` of them or
    less, or more where that is quick. `cost` is what one of them takes, in seconds."""
    pixel = final
    while (
        max(width, height) > start_resolution * pixel
        and width * height * cost > FIRST_SECONDS * pixel**2
    ):
        pixel *= 2
    return pixel


def next_pixel(pixel: int, seconds: float, final: int) -> int:
    """How wide the next picture's pixels are, when those of `pixel` took `seconds`."""
    for finer in (final << k for k in range(16)):
        fewer_rays = FINE_SHARE if finer == final else 1.0
        if 2 * finer >= pixel or fewer_rays * seconds * (pixel / finer) ** 2 <= STEP_SECONDS:
            return min(finer, pixel)
    return final


def redraw_seconds(elapsed: float) -> float:
    """How long a picture stays, `elapsed` seconds after its first sample was begun."""
    return min(max(FIRST_REDRAW_SECONDS, REDRAW_SHARE * elapsed), LAST_REDRAW_SECONDS)


def quick_settings(settings: dict[str, Any], is_wide: bool) -> dict[str, Any]:
    """The core's settings for a picture that is not the last."""
    return settings | {
        "samples": 1,
        "light_samples": WIDE_LIGHT_SAMPLES if is_wide else FINE_LIGHT_SAMPLES,
        "guides_light": False,
        "use_adaptive_sampling": False,
    }


def is_quick(settings: dict[str, Any]) -> bool:
    """Whether one sample of the last picture costs no more than that of a quick one."""
    return 0 < settings["light_samples"] <= WIDE_LIGHT_SAMPLES
