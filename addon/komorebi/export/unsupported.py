"""Says once what a scene asks for and this release does not render yet."""

from __future__ import annotations

from typing import Any

from .. import reporting


def warn_unsupported(engine: Any, depsgraph: Any) -> None:
    """Warnings for the scene's own settings."""
    scene = depsgraph.scene
    if scene.render.use_motion_blur:
        reporting.warn(engine, "motion blur is not rendered yet: the frame is taken as still")
