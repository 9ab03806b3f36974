import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError
from slamgym.eval.statistics import Interval, bootstrap_interval, median_interval, proportion_interval

INF = np.inf
samples = st.lists(st.floats(0.0, 100.0), min_size=6, max_size=40)


def ends(interval):
    return interval.low, interval.high


def test_median_of_ten_values():
    # Ranks 2 and 9 hold 1 - 2 (1 + 10) / 1024 = 0.97852, ranks 3 and 8 hold 1 - 2 (1 + 10 + 45) / 1024 = 0.89063.
    # Excess (0.97852 - 0.95) / (0.97852 - 0.89063) = 0.32444; weight 8 x 0.32444 / (2 + 6 x 0.32444) = 0.65766.
    interval = median_interval(np.arange(10.0, 0.0, -1.0))
    assert interval.estimate == 5.5
    assert ends(interval) == pytest.approx((2.65766, 8.34234), abs=1e-5)


def test_median_of_six_values():
    # Ranks 1 and 6: 1 - 2 / 64; ranks 2 and 5: 1 - 14 / 64; excess 0.1; weight 5 x 0.1 / (1 + 4 x 0.1) = 0.35714.
    assert ends(median_interval([1, 2, 3, 4, 5, 6])) == pytest.approx((1.35714, 5.64286), abs=1e-5)


def test_failures_are_the_worst_values():
    interval = median_interval([1, 2, 3, 4, 5, 6, 7, INF, INF, INF])
    assert (interval.estimate, interval.high) == (5.5, INF)
    assert interval.low == pytest.approx(2.65766, abs=1e-5)
    assert median_interval([INF] * 6) == Interval(INF, INF, INF)


@given(samples, st.data())
@settings(deadline=None)
def test_one_more_failure_never_looks_better(values, data):
    lost = data.draw(st.integers(0, len(values) - 1))
    before, after = median_interval(values), median_interval([*values[:lost], INF, *values[lost + 1 :]])
    assert after.estimate >= before.estimate
    assert after.low >= before.low - 1e-9
    assert after.high >= before.high - 1e-9


@given(samples)
@settings(deadline=None)
def test_the_median_lies_in_its_interval_and_more_confidence_is_wider(values):
    narrow, wide = median_interval(values, 0.5), median_interval(values, 0.95)
    assert wide.low - 1e-9 <= narrow.low <= narrow.estimate + 1e-9
    assert narrow.estimate - 1e-9 <= narrow.high <= wide.high + 1e-9


@pytest.mark.parametrize("n", [1, 2, 5])
def test_few_values_allow_no_interval_of_the_median(n):
    interval = median_interval([3.0] * n)
    assert interval.estimate == 3.0
    assert np.isnan(ends(interval)).all()
    # Of five values the lowest and the highest hold 1 - 2 / 32 = 0.9375.
    assert np.isfinite(ends(median_interval([3.0] * 5, confidence=0.93))).all()


def test_the_word_median_is_the_median_interval():
    assert bootstrap_interval([5, 1, 4, 2, 3, 9]) == median_interval([1, 2, 3, 4, 5, 9])


def test_mean_of_a_large_normal_sample_is_that_of_the_textbook():
    values = np.random.default_rng(0).normal(3.0, 1.0, 400)
    interval = bootstrap_interval(values, "mean")
    error = 1.96 * values.std() / 20
    assert ends(interval) == pytest.approx((values.mean() - error, values.mean() + error), abs=0.01)


def test_the_interval_of_a_skewed_mean_reaches_further_up():
    interval = bootstrap_interval(np.random.default_rng(0).lognormal(0.0, 1.0, 20), "mean")
    assert interval.high - interval.estimate > 1.3 * (interval.estimate - interval.low)


def test_any_other_statistic():
    values = np.random.default_rng(0).normal(0.0, 2.0, 60)
    interval = bootstrap_interval(values, lambda sample: float(np.std(sample, ddof=1)))
    assert interval.estimate == pytest.approx(values.std(ddof=1))
    assert 2.0 in interval
    assert 0.5 < interval.high - interval.low < 1.0  # about 4 x 2 / sqrt(2 x 60) = 0.73


def test_the_same_seed_gives_the_same_interval():
    values = np.random.default_rng(0).exponential(size=15)
    assert bootstrap_interval(values, "mean", seed=1) == bootstrap_interval(values, "mean", seed=1)
    assert bootstrap_interval(values, "mean", seed=1) != bootstrap_interval(values, "mean", seed=2)


@pytest.mark.parametrize("statistic", ["mean", np.std])
def test_constant_values_and_one_value(statistic):
    constant = bootstrap_interval([2.0] * 8, statistic)
    assert ends(constant) == (constant.estimate, constant.estimate)
    assert np.isnan(ends(bootstrap_interval([2.0], statistic))).all()


def test_two_values_do_not_bound_their_mean():
    assert bootstrap_interval([1.0, 3.0], "mean") == Interval(2.0, -INF, INF)


def test_the_exponential_brings_logarithms_back():
    assert Interval(0.0, -INF, INF).exp() == Interval(1.0, 0.0, INF)
    assert Interval(0.0, -1e4, 1e4).exp() == Interval(1.0, 0.0, INF)


def test_proportions():
    # Wilson, none of n: 0 to z^2 / (n + z^2) = 3.8415 / 13.8415.
    assert ends(proportion_interval(0, 10)) == pytest.approx((0.0, 0.27753), abs=1e-5)
    assert ends(proportion_interval(10, 10)) == pytest.approx((1 - 0.27753, 1.0), abs=1e-5)
    # 5 of 10: center 0.5, half width z sqrt(10 / 4 + z^2 / 4) / (10 + z^2) = 1.95996 x 1.86024 / 13.8415.
    assert ends(proportion_interval(5, 10)) == pytest.approx((0.23659, 0.76341), abs=1e-5)
    nothing = proportion_interval(0, 0)
    assert np.isnan(nothing.estimate)
    assert ends(nothing) == (0.0, 1.0)


@pytest.mark.parametrize(
    ("interval", "text"),
    [
        (Interval(0.9, 0.8, 1.1), "0.9 (95 % interval 0.8 to 1.1)"),
        (Interval(0.9, -INF, 1.1, 0.9), "0.9 (90 % interval 1.1 or less)"),
        (Interval(0.9, 0.8, INF), "0.9 (95 % interval 0.8 or more)"),
        (Interval(0.9, -INF, INF), "0.9 (95 % interval unbounded)"),
        (Interval(0.9, np.nan, np.nan), "0.9 (95 % interval unknown)"),
    ],
)
def test_intervals_in_words(interval, text):
    assert str(interval) == text


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: bootstrap_interval([]), r"n of 1 or more, got shape \(0,\)"),
        (lambda: median_interval([[1.0, 2.0]]), r"got shape \(1, 2\)"),
        (lambda: median_interval([1.0, np.nan]), "count failures as infinity"),
        (lambda: bootstrap_interval([1.0, INF], "mean"), "expected finite values"),
        (lambda: bootstrap_interval([1.0, 2.0], "meen"), "did you mean 'mean'"),  # type: ignore[arg-type]
        (lambda: median_interval([1.0], confidence=95), "such as 0.95, got 95"),
        (lambda: proportion_interval(3, 2), "got 3 successes of 2"),
    ],
)
def test_what_has_no_interval_is_refused(call, message):
    with pytest.raises(ConfigError, match=message):
        call()


def test_the_rest_of_the_evaluation_does_not_wait_for_statsmodels():
    modules = ["slamgym", *(f"slamgym.eval.{name}" for name in ("trajectories", "accuracy", "robustness", "drive"))]
    code = f"import sys, {', '.join(modules)}; sys.exit('statsmodels' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
