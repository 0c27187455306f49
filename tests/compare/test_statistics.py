"""The test that judges pictures, on pictures made of random numbers of known means."""

from __future__ import annotations

import numpy as np
import pytest

from compare import statistics

SHAPE = (48, 64)


def pictures(seed: int, mean: np.ndarray, noise: float = 0.05, count: int = 8) -> np.ndarray:
    """`count` RGBA pictures around `mean` [row, column]; skewed noise, as renders have."""
    random = np.random.default_rng(seed)
    spread = random.gamma(2.0, 1.0 / 2.0, (count, *mean.shape, 1)) - 1.0
    made = np.ones((count, *mean.shape, 4))
    made[..., :3] = mean[None, ..., None] * (1.0 + noise * spread)
    return made.astype(np.float32)


@pytest.fixture
def scene() -> np.ndarray:
    """A gradient with a flat part."""
    made = np.tile(np.linspace(0.05, 1.0, SHAPE[1]), (SHAPE[0], 1))
    made[:12] = 0.5
    return made


def test_equal_means_pass_at_the_stated_rate(scene: np.ndarray) -> None:
    shares = []
    for trial in range(40):
        a, b = pictures(2 * trial, scene, 0.3), pictures(2 * trial + 1, scene, 0.3)
        shares.append(statistics.judge(a, b).share)
    blocks = 40 * scene.size / 16
    expected = statistics.P_LIMIT
    assert abs(np.mean(shares) - expected) < 5.0 * np.sqrt(expected / blocks)


def test_one_percent_brighter_fails(scene: np.ndarray) -> None:
    verdict = statistics.judge(pictures(1, scene), pictures(2, 1.01 * scene))
    assert not verdict.passed
    assert verdict.mean_errors > statistics.MOST_ERRORS
    assert verdict.mean_b / verdict.mean_a == pytest.approx(1.01, abs=1e-3)


def test_one_wrong_corner_fails_and_is_marked_there(scene: np.ndarray) -> None:
    wrong = scene.copy()
    wrong[4:12, 8:20] *= 1.1
    verdict = statistics.judge(pictures(1, scene), pictures(2, wrong))
    assert not verdict.passed
    assert verdict.disagrees[1:3, 2:5].all()
    assert verdict.disagrees.sum() <= 6 + 2


def test_pictures_without_noise() -> None:
    flat = np.ones((8, 16, 16, 4), dtype=np.float32)
    same = statistics.judge(flat, flat.copy())
    assert same.passed
    assert same.mean_errors == 0.0
    other = flat.copy()
    other[:, :8] = 0.9
    assert not statistics.judge(flat, other).passed
    rounding = flat * np.float32(1.0 + 3e-7)
    assert statistics.judge(flat, rounding).passed


def test_known_differences_are_excused_where_they_are_and_nowhere_else(scene: np.ndarray) -> None:
    wrong, mask = scene.copy(), np.zeros(SHAPE, dtype=bool)
    wrong[20:28] *= 1.5
    mask[20:28] = True
    verdict = statistics.judge(pictures(1, scene), pictures(2, wrong), mask)
    assert verdict.passed
    assert verdict.excused[5:7].all()
    assert verdict.excused.sum() == 2 * 16
    mask[24:28] = False
    assert not statistics.judge(pictures(1, scene), pictures(2, wrong), mask).passed


def test_blocks_at_the_rim_are_means_of_what_is_there() -> None:
    picture = np.arange(30.0).reshape(1, 5, 6)
    blocks = statistics.blocks(picture)
    assert blocks.shape == (1, 2, 2)
    assert blocks[0, 1, 1] == picture[0, 4:, 4:].mean()
    assert blocks[0, 0, 1] == picture[0, :4, 4:].mean()


def test_welch_agrees_with_scipy() -> None:
    from scipy.stats import ttest_ind

    random = np.random.default_rng(5)
    a, b = random.normal(0.0, 1.0, (8, 500)), random.normal(0.3, 4.0, (11, 500))
    difference, p = statistics.welch(a, b)
    assert np.allclose(difference, b.mean(axis=0) - a.mean(axis=0))
    assert np.allclose(p, ttest_ind(a, b, equal_var=False).pvalue, rtol=1e-9)


def test_bad_input_is_refused() -> None:
    good = np.ones((8, 16, 16, 4), dtype=np.float32)
    with pytest.raises(ValueError, match="different sizes"):
        statistics.judge(good, good[:, :8])
    with pytest.raises(ValueError, match="at least two seeds"):
        statistics.judge(good[:1], good)
    bad = good.copy()
    bad[3, 4, 5, 0] = np.nan
    with pytest.raises(ValueError, match="1 values of the second engine's are not finite"):
        statistics.judge(good, bad)
