"""Stereo and multi-view: the views that Blender expects pictures for."""

from __future__ import annotations

from typing import Any


def active_views(scene: Any) -> list[str]:
    """Names of the views to render; [""] when multi-view is off.

    Stereo 3D has two eyes of one camera, Multi-View a camera for each view, found by its suffix.
    """
    render = scene.render
    if not render.use_multiview:
        return [""]
    stereo = render.views_format == "STEREO_3D"
    names = [v.name for v in render.views if v.use and (not stereo or v.name in {"left", "right"})]
    return names or [""]
