"""The table of passes: what is told to Blender, asked of the core, and written back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Pass:
    """One pass; `name` is Blender's and the core's alike."""

    name: str
    channels: int
    channel_ids: str
    kind: str  # Blender's socket type: COLOR, VECTOR, VALUE
    switch: str | None  # property of the view layer; None: always there


PASSES = (
    Pass("Combined", 4, "RGBA", "COLOR", None),
    Pass("Depth", 1, "Z", "VALUE", "use_pass_z"),
    Pass("Normal", 3, "XYZ", "VECTOR", "use_pass_normal"),
)


def enabled_passes(view_layer: Any) -> list[Pass]:
    """The passes that `view_layer` asks for."""
    return [p for p in PASSES if p.switch is None or getattr(view_layer, p.switch)]


def register_passes(engine: Any, scene: Any, view_layer: Any) -> None:
    for p in enabled_passes(view_layer):
        engine.register_pass(scene, view_layer, p.name, p.channels, p.channel_ids, p.kind)


def names(passes: Sequence[Pass]) -> tuple[str, ...]:
    return tuple(p.name for p in passes)
