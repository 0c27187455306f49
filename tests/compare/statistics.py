"""Do two sets of independent renders have the same mean? Welch's t-test on blocks of pixels.

B. L. Welch, The generalization of "Student's" problem when several different population variances
are involved, Biometrika 34 (1947). A block of 4 × 4 pixels is one measurement a seed: averaging
makes it close to normal and catches an error that many pixels share.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import stdtr

P_LIMIT = 0.0027  # three standard deviations of a normal distribution, both tails
ABSOLUTE, RELATIVE = 1e-4, 1e-3  # differences too small to matter
MOST_BLOCKS = 0.005  # a share of disagreeing blocks above this fails
MOST_ERRORS = 3.0  # a difference of the means above this many standard errors fails
ROUNDING = 1e-5  # relative: means closer than this differ by float32 sums, not by light
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True)
class Verdict:
    """The outcome for one pair of picture sets; both arrays are bool [block row, block column]."""

    disagrees: np.ndarray
    excused: np.ndarray  # blocks that would disagree, but for a reason that is known
    mean_a: float
    mean_b: float
    mean_errors: float
    largest: float
    alpha_difference: float

    @property
    def share(self) -> float:
        """Share of all blocks that disagree."""
        return float(self.disagrees.mean())

    @property
    def passed(self) -> bool:
        """Whether the two engines agree."""
        return self.share <= MOST_BLOCKS and self.mean_errors <= MOST_ERRORS


def blocks(pictures: np.ndarray, size: int = 4) -> np.ndarray:
    """Means over size × size pixels of [seed, row, column] → [seed, block row, block column],
    smaller at the rim."""
    rows, columns = np.arange(0, pictures.shape[1], size), np.arange(0, pictures.shape[2], size)
    sums = np.add.reduceat(
        np.add.reduceat(pictures.astype(np.float64), rows, axis=1), columns, axis=2
    )
    heights = np.diff(np.append(rows, pictures.shape[1]))
    widths = np.diff(np.append(columns, pictures.shape[2]))
    return np.asarray(sums / (heights[:, None] * widths[None, :]))


def welch(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Difference of means (b − a) and two-sided p along axis 0. Where neither set varies, p is 1
    if equal, else 0."""
    va, vb = a.var(axis=0, ddof=1) / len(a), b.var(axis=0, ddof=1) / len(b)
    difference = b.mean(axis=0) - a.mean(axis=0)
    error2 = va + vb
    varies = error2 > 0.0
    safe = np.where(varies, error2, 1.0)
    # Welch–Satterthwaite, with each set's share of the error, so that nothing underflows.
    share_a, share_b = va / safe, vb / safe
    freedom = 1.0 / np.where(varies, share_a**2 / (len(a) - 1) + share_b**2 / (len(b) - 1), 1.0)
    p = 2.0 * stdtr(freedom, -np.abs(difference) / np.sqrt(safe))
    return difference, np.where(varies, p, np.where(difference == 0.0, 1.0, 0.0))


def check(a: np.ndarray, b: np.ndarray) -> None:
    """ValueError with a sentence when the two sets cannot be compared."""
    if a.shape[1:] != b.shape[1:] or a.ndim != 4 or a.shape[3] != 4:
        raise ValueError(f"the pictures have different sizes: {a.shape[1:3]} and {b.shape[1:3]}")
    if min(len(a), len(b)) < 2:
        raise ValueError("the test needs at least two seeds an engine")
    for name, pictures in (("first", a), ("second", b)):
        bad = np.count_nonzero(~np.isfinite(pictures))
        if bad:
            raise ValueError(f"{bad} values of the {name} engine's are not finite")


def differing(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Differences of the means of blocks [seed, row, column], and which are more than chance."""
    difference, p = welch(a, b)
    enough = np.maximum(ABSOLUTE, RELATIVE * np.abs(a.mean(axis=0)))
    return difference, (p < P_LIMIT) & (np.abs(difference) > enough)


def judge(a: np.ndarray, b: np.ndarray, known: np.ndarray | None = None) -> Verdict:
    """Compare two float arrays [seed, row, column, RGBA] of equal size.

    Light and alpha are judged alike. Where `known`, bool [row, column], marks a pixel of a block, its disagreement is excused, and it
    does not enter the means. ValueError for unequal sizes, too few seeds, values not finite.
    """
    check(a, b)
    light_a, light_b = a[..., :3] @ LUMINANCE, b[..., :3] @ LUMINANCE
    blocks_a, blocks_b = blocks(light_a), blocks(light_b)
    counted = np.ones(blocks_a.shape[1:], dtype=bool)
    if known is not None:
        counted = blocks(known[None])[0] == 0.0
    difference, differs = differing(blocks_a, blocks_b)
    alpha_difference, alpha_differs = differing(blocks(a[..., 3]), blocks(b[..., 3]))
    differs |= alpha_differs
    means_a, means_b = (
        x[:, counted].mean(axis=1) if counted.any() else x[:, 0, 0] for x in (blocks_a, blocks_b)
    )
    gap = abs(float(means_b.mean() - means_a.mean()))
    error = float(np.sqrt(means_a.var(ddof=1) / len(a) + means_b.var(ddof=1) / len(b)))
    rounding = ROUNDING * max(abs(float(means_a.mean())), ROUNDING)
    return Verdict(
        disagrees=differs & counted,
        excused=differs & ~counted,
        mean_a=float(means_a.mean()),
        mean_b=float(means_b.mean()),
        mean_errors=0.0 if gap <= rounding else gap / max(error, 1e-300),
        largest=float(np.abs(difference[counted]).max(initial=0.0)),
        alpha_difference=float(np.abs(alpha_difference).max()),
    )
