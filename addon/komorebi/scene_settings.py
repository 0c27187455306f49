"""A scene's settings: `scene.komorebi`, but for previews of materials and worlds, whose scenes are
Blender's own and have settings that suit them.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

# A preview shows what something is made of, in a moment.
PREVIEW: dict[str, Any] = {
    "method": "WORLD_LIGHT",
    "surface": "MATERIAL",
    "sky": "SCENE",
    "samples": 24,
    "light_samples": 2,
    "sample_offset": 0,
    "bounces": 2,
    "use_adaptive_sampling": False,
    "use_denoising": False,
    "use_fast_gi": False,
    "time_limit": 0.2,  # seconds; what fits of the samples, so that icons do not make one wait
    "film_exposure": 1.0,
    "world_resolution": 256,
}
_local = threading.local()  # a preview is exported while a viewport may be, too


class _PreviewSettings:
    """Those of a scene, with PREVIEW in place of its own."""

    def __init__(self, settings: Any) -> None:
        self._settings = settings

    def __getattr__(self, name: str) -> Any:
        return PREVIEW[name] if name in PREVIEW else getattr(self._settings, name)


def settings_of(scene: Any) -> Any:
    """What says how `scene` is rendered."""
    settings = scene.komorebi
    return _PreviewSettings(settings) if getattr(_local, "is_preview", False) else settings


@contextmanager
def suited(engine: Any) -> Iterator[None]:
    """Scenes that are exported meanwhile, on this thread, have the settings for what `engine`
    renders."""
    before = getattr(_local, "is_preview", False)
    _local.is_preview = engine.is_preview
    try:
        yield
    finally:
        _local.is_preview = before
