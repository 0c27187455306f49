"""What a shader socket carries: closures, each with a weight. No bpy."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .values import Builder, Value

BLACK: Value = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Closure:
    """Weights are colours; `normal` is None where the surface's own is meant."""

    kind: str  # EMISSION, DIFFUSE, TRANSLUCENT, TRANSPARENT, HOLDOUT
    weight: Value
    normal: Value | None = None


Closures = tuple[Closure, ...]


def scaled(builder: Builder, closures: Closures, factor: Value) -> Closures:
    """All weights times a number or a colour."""
    return tuple(replace(c, weight=builder.multiply(factor, c.weight)) for c in closures)


def total(builder: Builder, closures: Closures, kind: str) -> Value:
    """The sum of the weights of all closures of a kind."""
    weight = BLACK
    for closure in closures:
        if closure.kind == kind:
            weight = builder.add(weight, closure.weight)
    return weight
