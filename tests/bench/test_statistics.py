"""The bench's figures: medians, ratios, fits, samples at equal error."""

import pytest

from bench.statistics import (
    geometric_mean,
    median,
    power_fit,
    ratio,
    samples_at_error,
    spread,
)


def test_median_is_the_middle_of_odd_and_even_numbers_of_values():
    assert median([5.0, 1.0, 9.0]) == 5.0
    assert median([4.0, 1.0, 2.0, 100.0]) == 3.0
    with pytest.raises(ValueError, match="nothing"):
        median([])


def test_spread_is_relative_to_the_median_and_nothing_for_one_value():
    assert spread([2.0]) == 0.0
    assert spread([1.8, 2.0, 2.6]) == pytest.approx(0.4)


def test_ratio_is_taken_round_by_round():
    # The second round was disturbed for both: medians of each side alone would say 1.5.
    assert ratio([2.0, 20.0, 3.0], [1.0, 10.0, 2.0]) == 2.0
    with pytest.raises(ValueError, match="rounds"):
        ratio([1.0], [1.0, 2.0])


def test_geometric_mean_cancels_twice_and_half():
    assert geometric_mean([2.0, 0.5]) == pytest.approx(1.0)
    assert geometric_mean([1.0, 8.0]) == pytest.approx(8.0**0.5)
    with pytest.raises(ValueError, match="nothing"):
        geometric_mean([])


def test_power_fit_finds_factor_and_exponent():
    x = [1.0, 4.0, 16.0, 50.0]
    factor, exponent = power_fit(x, [3.0 * k**1.25 for k in x])
    assert (factor, exponent) == (pytest.approx(3.0), pytest.approx(1.25))
    with pytest.raises(ValueError, match="different"):
        power_fit([2.0, 2.0], [1.0, 2.0])


@pytest.mark.parametrize("wanted", [0.4, 0.11, 0.1, 0.02])
def test_samples_at_equal_error_follow_the_curve_between_and_outside(wanted):
    samples = [4, 8, 16, 32]
    errors = [1.0 / s for s in samples]
    assert samples_at_error(samples, errors, wanted) == pytest.approx(1.0 / wanted)


def test_samples_at_equal_error_use_the_piece_where_the_error_is_met():
    # Steep at first, flat later: only the nearest two counts decide.
    assert samples_at_error([1, 10, 100], [1.0, 0.1, 0.05], 0.5) == pytest.approx(2.0)
    assert 10.0 < samples_at_error([1, 10, 100], [1.0, 0.1, 0.05], 0.07) < 100.0


def test_samples_at_equal_error_refuse_an_error_that_does_not_fall():
    with pytest.raises(ValueError, match="does not fall"):
        samples_at_error([4, 8], [0.1, 0.1], 0.05)
    with pytest.raises(ValueError, match="rise"):
        samples_at_error([8, 4], [0.1, 0.2], 0.05)
    with pytest.raises(ValueError, match="two sample counts"):
        samples_at_error([8], [0.1], 0.05)
