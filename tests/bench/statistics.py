"""What turns repeated measurements into figures."""

from __future__ import annotations

import math
from collections.abc import Sequence


def median(values: Sequence[float]) -> float:
    """The middle value; the mean of the two in the middle of an even number."""
    if not values:
        raise ValueError("the median of nothing")
    ordered = sorted(values)
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2.0


def spread(values: Sequence[float]) -> float:
    """(largest − smallest) / median: what the repetitions disagree by; 0 for a single one."""
    return (max(values) - min(values)) / median(values)


def ratio(theirs: Sequence[float], ours: Sequence[float]) -> float:
    """How many times as fast we are: the median of the ratios round by round, since the rounds were
    made in turns and what slows one slows the other."""
    if len(theirs) != len(ours):
        raise ValueError(f"{len(theirs)} rounds against {len(ours)}")
    return median([t / o for t, o in zip(theirs, ours, strict=True)])


def geometric_mean(values: Sequence[float]) -> float:
    """The mean for ratios: one twice and one half cancel."""
    if not values:
        raise ValueError("the mean of nothing")
    return math.exp(sum(math.log(v) for v in values) / len(values))


def power_fit(x: Sequence[float], y: Sequence[float]) -> tuple[float, float]:
    """(a, b) of y ≈ a · x^b, by least squares of the logarithms: b is the growth exponent."""
    if len(x) != len(y) or len(set(x)) < 2:
        raise ValueError("a fit needs at least two different x, and a y for each")
    u, v = [math.log(k) for k in x], [math.log(k) for k in y]
    mean_u, mean_v = sum(u) / len(u), sum(v) / len(v)
    b = sum((p - mean_u) * (q - mean_v) for p, q in zip(u, v, strict=True)) / sum(
        (p - mean_u) ** 2 for p in u
    )
    return math.exp(mean_v - b * mean_u), b


def samples_at_error(samples: Sequence[int], errors: Sequence[float], wanted: float) -> float:
    """How many samples give an error of `wanted`, from measured errors at rising sample counts.

    Between two of them the error is a power of the sample count; outside, the nearest two are
    continued. ValueError where the error does not fall.
    """
    if len(samples) != len(errors) or len(samples) < 2:
        raise ValueError("at least two sample counts are needed, and an error for each")
    if list(samples) != sorted(set(samples)):
        raise ValueError("sample counts must rise")
    last = len(samples) - 2
    k = next((i for i in range(last) if errors[i + 1] <= wanted), last)
    _, slope = power_fit(samples[k : k + 2], errors[k : k + 2])
    if slope >= 0.0:
        raise ValueError(
            f"the error does not fall from {samples[k]} to {samples[k + 1]} samples "
            f"({errors[k]:g}, {errors[k + 1]:g})"
        )
    return float(samples[k] * (wanted / errors[k]) ** (1.0 / slope))
