"""Says once what a scene asks for and this release does not render yet."""

from __future__ import annotations

from typing import Any

from .. import compat, reporting
from .names import name_of


def warn_unsupported(engine: Any, depsgraph: Any) -> None:
    """Warnings for the scene's own settings."""
    scene = depsgraph.scene
    if scene.render.use_motion_blur:
        reporting.warn(engine, "motion blur is not rendered yet: the frame is taken as still")


def warn_object(engine: Any, scene: Any, original: Any) -> None:
    """Warnings for an object that renders."""
    if compat.has_adaptive_subdivision(scene, original):
        levels = original.modifiers[-1].render_levels
        reporting.warn(
            engine,
            f'object "{name_of(original)}": adaptive subdivision is not rendered yet, it has '
            f"the {levels} level{'' if levels == 1 else 's'} of its modifier",
        )
