"""The scene's settings → keyword arguments of the core's Settings."""

from __future__ import annotations

from typing import Any

from ..denoise.run import GUIDE
from ..passes import Pass, sources

# An odd multiplier far from any pattern (2³² / golden ratio): neighbouring frames get seeds that
# have nothing in common.
_SEED_STEP = 0x9E3779B1
_SEED_MASK = 0x7FFFFFFF


def export_settings(
    scene: Any, passes: list[Pass], region: tuple[int, int, int, int]
) -> dict[str, Any]:
    """`region` is (x_min, y_min, x_max, y_max) in pixels of the full frame."""
    settings, render = scene.komorebi, scene.render
    seed = settings.seed
    if settings.use_animated_seed:
        seed = (seed + scene.frame_current * _SEED_STEP) & _SEED_MASK
    return {
        "method": settings.method,
        "samples": settings.samples,
        "light_samples": settings.light_samples,
        "sample_offset": settings.sample_offset,
        "seed": seed,
        # Parts of a picture have to take every sample, so that they can be put together.
        "use_adaptive_sampling": settings.use_adaptive_sampling and settings.sample_offset == 0,
        "adaptive_threshold": settings.adaptive_threshold,
        "adaptive_min_samples": settings.adaptive_min_samples,
        "time_limit": settings.time_limit,
        "ao_distance": settings.ao_distance,
        "ao_sampling": settings.ao_sampling,
        "clay_color": tuple(settings.clay_color),
        "environment_sampling": settings.environment_sampling,
        "pixel_filter": settings.pixel_filter,
        "filter_width": settings.filter_width,
        "use_progressive": settings.use_progressive,
        "film_transparent": render.film_transparent,
        # With -t on the command line Blender answers FIXED and that number.
        "threads": render.threads if render.threads_mode == "FIXED" else 0,
        "region": region,
        "passes": sources(passes, *([GUIDE] if settings.use_denoising else [])),
    }
