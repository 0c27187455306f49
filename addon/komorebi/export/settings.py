"""The scene's settings → keyword arguments of the core's Settings."""

from __future__ import annotations

from typing import Any

from .. import compat
from ..denoise.run import GUIDES
from ..passes import Pass, sources
from ..scene_settings import settings_of

# An odd multiplier far from any pattern (2³² / golden ratio): neighbouring frames get seeds that
# have nothing in common.
_SEED_STEP = 0x9E3779B1
_SEED_MASK = 0x7FFFFFFF


def layer_samples(scene: Any, view_layer: Any) -> int:
    """The samples of a view layer: its own if it has any, unless Cycles' setting says otherwise."""
    own: int = view_layer.samples
    of_scene: int = settings_of(scene).samples
    rule = getattr(compat.cycles_or(scene, None), "use_layer_samples", "USE")
    if own == 0 or rule == "IGNORE":
        return of_scene
    return min(own, of_scene) if rule == "BOUNDED" else own


def bounces(settings: Any) -> int:
    """How often light goes from surface to surface: each method has its own."""
    if settings.method == "AMBIENT_OCCLUSION":
        return int(settings.ao_indirect_bounces)
    return int(settings.bounces)


def fast_gi(scene: Any) -> dict[str, Any]:
    """As in Cycles the world has factor and distance, and without one there is none of it."""
    settings = settings_of(scene)
    if scene.world is None:
        return {"use_fast_gi": False}
    ambient = scene.world.light_settings
    return {
        "use_fast_gi": settings.use_fast_gi,
        "fast_gi_method": settings.fast_gi_method,
        "fast_gi_bounces": settings.ao_bounces_render,
        "fast_gi_distance": max(ambient.distance, 0.0),
        "fast_gi_factor": max(ambient.ao_factor, 0.0),
    }


def export_settings(
    scene: Any, view_layer: Any, passes: list[Pass], region: tuple[int, int, int, int]
) -> dict[str, Any]:
    """`region` is (x_min, y_min, x_max, y_max) in pixels of the full frame."""
    samples = layer_samples(scene, view_layer)
    settings, render = settings_of(scene), scene.render
    mist = scene.world.mist_settings if scene.world is not None else None
    seed = settings.seed
    if settings.use_animated_seed:
        seed = (seed + scene.frame_current * _SEED_STEP) & _SEED_MASK
    exported = {
        "method": settings.method,
        "samples": samples,
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
        "bounces": bounces(settings),
        "sample_clamp_direct": settings.sample_clamp_direct,
        "sample_clamp_indirect": settings.sample_clamp_indirect,
        "world_max_bounces": compat.max_bounces(scene.world if settings.sky == "SCENE" else None),
        **fast_gi(scene),
        "environment_sampling": settings.environment_sampling,
        "pixel_filter": settings.pixel_filter,
        "filter_width": settings.filter_width,
        "use_progressive": settings.use_progressive,
        "film_transparent": render.film_transparent,
        # With -t on the command line Blender answers FIXED and that number.
        "threads": render.threads if render.threads_mode == "FIXED" else 0,
        "region": region,
        "passes": sources(passes, *(GUIDES if settings.use_denoising else ())),
    }
    if mist is not None:
        exported |= {
            "mist_start": mist.start, "mist_depth": mist.depth, "mist_falloff": mist.falloff,
        }  # fmt: skip
    return exported
