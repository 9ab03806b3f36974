import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError
from slamgym.eval.statistics import failure_threshold
from slamgym.eval.statistics.two_groups import critical_bandwidth

NAN, INF = np.nan, np.inf
GOOD = np.array([0.01, 0.015, 0.02, 0.02, 0.02, 0.02, 0.027, 0.04])


def test_two_alike_groups_meet_in_the_geometric_middle():
    # Both groups have the same spread of logarithms, so the middle: sqrt(g x 50 g) = 7.07 g, g the geometric mean 0.02.
    result = failure_threshold(np.concatenate([GOOD, 50 * GOOD]))
    assert result.outcome == "gap"
    assert result.threshold.estimate == pytest.approx(np.sqrt(50) * np.exp(np.log(GOOD).mean()))
    assert result.gap == pytest.approx((0.04, 0.5))
    assert (result.below, result.above, result.without_value) == (8, 8, 0)
    assert result.p_value == pytest.approx(1 / 500)
    assert result.threshold.low < result.threshold.estimate < result.threshold.high


def test_the_threshold_is_nearer_to_the_narrow_group():
    # Logarithms spread by s below and 2 s above: one third of the way from mean to mean.
    wide = 2.0 * (GOOD / 0.02) ** 2
    result = failure_threshold(np.concatenate([GOOD, wide]))
    low, high = np.log(GOOD).mean(), np.log(wide).mean()
    assert np.log(result.threshold.estimate) == pytest.approx(low + (high - low) / 3)


def test_the_threshold_stays_in_the_gap():
    # The outlier that ends the good group is further out than two thirds of the way.
    bad = 1.0 + 0.001 * np.arange(8)
    result = failure_threshold([*([0.02] * 20), 0.3, 0.3, *bad])
    assert result.gap[0] <= result.threshold.estimate <= result.gap[1]


def test_runs_without_a_value_have_failed():
    values = np.concatenate([GOOD, [NAN, INF], 50 * GOOD])
    result = failure_threshold(values)
    assert (result.below, result.above, result.without_value) == (8, 8, 2)
    assert result.failed(values).tolist() == [False] * 8 + [True] * 10
    assert "8 runs below and 8 above a gap from 0.04 to 0.5" in result.verdict
    assert "2 without a value" in result.verdict


def test_a_perfect_run_is_a_good_one():
    result = failure_threshold(np.concatenate([[0.0, 0.0], GOOD, 50 * GOOD]))
    assert (result.below, result.above) == (10, 8)


def test_one_group_has_no_gap():
    values = np.concatenate([GOOD, 1.1 * GOOD])
    result = failure_threshold([*values, NAN])
    assert result.outcome == "no gap"
    assert not result.found
    assert np.isnan([result.threshold.estimate, *result.gap]).all()
    assert (result.below, result.above, result.without_value) == (16, 0, 1)
    assert result.failed([0.01, 1e9, NAN, INF]).tolist() == [False, False, True, True]
    assert result.verdict.startswith("no gap between good and failed runs (p = ")


def test_a_gap_of_less_than_a_factor_of_two_and_a_half_is_none():
    tight = np.exp(np.linspace(0.0, 0.1, 10))
    assert not failure_threshold([*tight, *(2.2 * tight)]).found
    assert failure_threshold([*tight, *(3.0 * tight)]).found


def test_two_outliers_are_no_group():
    assert not failure_threshold([*GOOD, *GOOD, 5.0, 6.0]).found
    assert failure_threshold([*GOOD, *GOOD, 5.0, 6.0, 7.0]).found


@pytest.mark.parametrize("values", [[], [1.0], [NAN] * 20, [0.0] * 20, [0.01] * 4 + [1.0] * 3])
def test_too_few_values(values):
    result = failure_threshold(values)
    assert result.outcome == "too few"
    assert np.isnan(result.p_value)
    assert result.below + result.without_value == len(values)
    assert result.verdict.startswith("too few values")


def test_equal_values():
    assert failure_threshold([0.02] * 20).outcome == "no gap"
    two = failure_threshold([0.01] * 10 + [1.0] * 5)
    assert two.threshold.estimate == pytest.approx(0.1)
    assert (two.below, two.above) == (10, 5)


@given(st.permutations(range(16)), st.sampled_from([1e-3, 1.0, 100.0]))
@settings(deadline=None, max_examples=20)
def test_order_and_unit_do_not_matter(order, unit):
    values = np.concatenate([GOOD, 50 * GOOD])
    plain, moved = failure_threshold(values), failure_threshold(unit * values[list(order)])
    assert moved.threshold.estimate == pytest.approx(unit * plain.threshold.estimate)
    assert moved.threshold.high == pytest.approx(unit * plain.threshold.high)
    assert failure_threshold(values) == plain


def test_critical_bandwidth_of_two_points():
    # The sum of two Gaussians has one mode as long as they are at most 2 bandwidths apart.
    assert critical_bandwidth(np.array([0.0, 1.0])) == pytest.approx(0.5, rel=0.02)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: failure_threshold([-0.1] + [1.0] * 9), "of 0 or more, got -0.1"),
        (lambda: failure_threshold([[1.0]]), r"got shape \(1, 1\)"),
        (lambda: failure_threshold(GOOD, alpha=5), "such as 0.05, got 5"),
        (lambda: failure_threshold(GOOD, confidence=0), "confidence"),
    ],
)
def test_what_cannot_be_searched_is_refused(call, message):
    with pytest.raises(ConfigError, match=message):
        call()
