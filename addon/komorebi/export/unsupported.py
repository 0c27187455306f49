"""Says once what a scene asks for and this release does not render yet."""

from __future__ import annotations

from typing import Any

from .. import compat, reporting
from ..scene_settings import settings_of
from .names import name_of


def warn_scene(engine: Any, scene: Any) -> None:
    """Warnings for a scene's own settings."""
    if compat.has_overscan(scene):
        reporting.warn(engine, "EEVEE's overscan is left out: the frame ends at its rim")


def warn_object(engine: Any, scene: Any, original: Any) -> None:
    """Warnings for an object that renders."""
    settings = settings_of(scene)
    replaces = settings.use_fast_gi and settings.fast_gi_method == "REPLACE"
    if replaces and settings.method == "WORLD_LIGHT" and compat.has_own_ao_distance(original):
        reporting.warn(
            engine,
            f'object "{name_of(original)}": an AO Distance of its own is not supported yet, the '
            "world's counts",
        )
    if compat.has_adaptive_subdivision(scene, original):
        levels = original.modifiers[-1].render_levels
        reporting.warn(
            engine,
            f'object "{name_of(original)}": adaptive subdivision is not rendered yet, it has '
            f"the {levels} level{'' if levels == 1 else 's'} of its modifier",
        )
