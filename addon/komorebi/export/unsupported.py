"""Says once what a scene asks for and this release does not render yet."""

from __future__ import annotations

from typing import Any

from .. import reporting
from .names import name_of


def warn_unsupported(engine: Any, depsgraph: Any) -> None:
    """Warnings for the scene's, the camera's and the view layer's own settings."""
    scene = depsgraph.scene
    if scene.render.use_motion_blur:
        reporting.warn(engine, "motion blur is not rendered yet: the frame is taken as still")
    camera = engine.camera_override or scene.camera
    if camera is not None and camera.type == "CAMERA" and camera.data.dof.use_dof:
        reporting.warn(
            engine, f'camera "{name_of(camera)}": depth of field is not rendered yet, all is sharp'
        )
