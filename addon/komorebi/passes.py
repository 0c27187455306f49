"""The table of passes: what is told to Blender, asked of the core, and written back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Pass:
    """One pass by Blender's name; `source` is the core's."""

    name: str
    channels: int
    channel_ids: str
    kind: str  # Blender's socket type: COLOR, VECTOR, VALUE
    source: str
    wanted: Callable[[Any, Any], bool]  # (scene, view layer) → whether it is switched on


PASSES = (
    Pass("Combined", 4, "RGBA", "COLOR", "Combined", lambda *_: True),
    Pass("Depth", 1, "Z", "VALUE", "Depth", lambda _, layer: layer.use_pass_z),
    Pass("Normal", 3, "XYZ", "VECTOR", "Normal", lambda _, layer: layer.use_pass_normal),
    # Samples of each pixel, over the most that it may have; name and scale are Cycles'.
    Pass(
        "Debug Sample Count",
        1,
        "X",
        "VALUE",
        "Debug Sample Count",
        lambda _, layer: layer.komorebi.pass_debug_sample_count,
    ),
    # Combined as it was before denoising; the name is Cycles'.
    Pass("Noisy Image", 4, "RGBA", "COLOR", "Combined", lambda s, _: s.komorebi.use_denoising),
)


def enabled_passes(scene: Any, view_layer: Any) -> list[Pass]:
    """The passes that `view_layer` of `scene` asks for."""
    return [p for p in PASSES if p.wanted(scene, view_layer)]


def register_passes(engine: Any, scene: Any, view_layer: Any) -> None:
    for p in enabled_passes(scene, view_layer):
        engine.register_pass(scene, view_layer, p.name, p.channels, p.channel_ids, p.kind)


def sources(passes: Sequence[Pass], *more: str) -> tuple[str, ...]:
    """What the core has to keep for them, and `more` that is not told to Blender."""
    return tuple(dict.fromkeys((*(p.source for p in passes), *more)))
