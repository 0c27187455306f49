"""A viewport's own settings in place of a final render's."""

from __future__ import annotations

from typing import Any

from ..denoise import library
from ..denoise.run import GUIDES
from ..scene_settings import settings_of
from .denoising import DenoisingRequest

FOR_EVER = 1 << 24
# Passes that are denoised, by the core's names: what light makes noisy.
NOISY = {"Combined", "Ambient Occlusion", "Sky Visibility"}
_GUIDES = {"RGB": GUIDES[:0], "RGB_ALBEDO": GUIDES[:1], "RGB_ALBEDO_NORMAL": GUIDES}


def preview_settings(scene: Any) -> dict[str, Any]:
    """What the core is told in a viewport, over `export_settings`."""
    settings = settings_of(scene)
    return {
        "samples": settings.preview_samples or FOR_EVER,
        "sample_offset": 0,
        "time_limit": 0.0,
        "use_progressive": True,
        "samples_per_pass": 4,  # so that something new is shown every second
        "has_low_priority": True,  # Blender's window comes first
        "fast_gi_bounces": settings.ao_bounces,
        "use_adaptive_sampling": settings.use_preview_adaptive_sampling,
        "adaptive_threshold": settings.preview_adaptive_threshold,
        "adaptive_min_samples": settings.preview_adaptive_min_samples,
    }


def denoising_of(scene: Any, source: str, threads: int) -> DenoisingRequest | None:
    """How the core's pass `source` is denoised; None: not at all, also without a library."""
    settings = settings_of(scene)
    if not settings.use_preview_denoising or source not in NOISY:
        return None
    path = library.find().path
    if not path:
        return None
    return DenoisingRequest(
        path, threads, _GUIDES[settings.preview_denoising_input_passes],
        settings.preview_denoising_prefilter, settings.preview_denoising_quality,
        settings.preview_denoising_start_sample,
    )  # fmt: skip
