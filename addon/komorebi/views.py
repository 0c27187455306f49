"""Stereo: the views (eyes) that Blender expects pictures for."""

from __future__ import annotations

from typing import Any

from .errors import RenderError


def active_views(scene: Any) -> list[str]:
    """Names of the views to render; [""] when stereo is off."""
    render = scene.render
    if not render.use_multiview:
        return [""]
    if render.views_format != "STEREO_3D":
        raise RenderError(
            "Multi-View with a camera for each view is not supported yet: use Stereo 3D"
        )
    names = [v.name for v in render.views if v.use and v.name in {"left", "right"}]
    return names or [""]
