import numpy as np
import pytest
import statsmodels.api as sm
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError
from slamgym.eval.statistics import failure_curve

INF = np.inf
LEVELS = np.repeat([0.2, 0.4, 0.6, 0.8, 1.0], 10)
counts = st.lists(st.integers(0, 6), min_size=3, max_size=5)


def runs(failures, of):
    """Levels 0, 1, 2 ... with these numbers of failures of as many runs each."""
    levels = np.repeat(np.arange(len(failures), dtype=float), of)
    return levels, np.concatenate([np.arange(of) < k for k in failures])


def ends(curve):
    return curve.midpoint.low, curve.midpoint.high


def test_two_levels_by_hand():
    # 1 of 4 fails at 0 and 3 of 4 at 1: log odds -log 3 and +log 3, so slope 2 log 3 and midpoint 1/2.
    curve = failure_curve(*runs([1, 3], 4))
    assert curve.slope == pytest.approx(2 * np.log(3))
    assert curve.midpoint.estimate == pytest.approx(0.5)
    assert curve.probability([0.0, 0.5, 1.0]) == pytest.approx([0.25, 0.5, 0.75])
    assert (curve.runs, curve.failures) == (8, 4)


def test_the_ends_are_where_the_likelihood_ratio_test_begins_to_refuse():
    rng = np.random.default_rng(0)
    x = np.repeat(LEVELS, 2)
    failed = rng.random(len(x)) < 1 / (1 + np.exp(-8 * (x - 0.7)))
    curve = failure_curve(x, failed)
    best = sm.GLM(failed * 1.0, sm.add_constant(x), family=sm.families.Binomial()).fit().llf
    for end in ends(curve):
        fixed = sm.GLM(failed * 1.0, x - end, family=sm.families.Binomial()).fit()
        assert 2 * (best - fixed.llf) == pytest.approx(3.841459, rel=1e-4)
    assert curve.midpoint.low < curve.midpoint.estimate < curve.midpoint.high


def test_one_level_parts_successes_from_failures():
    curve = failure_curve(LEVELS, LEVELS > 0.7)
    assert curve.midpoint.estimate == pytest.approx(0.7)
    assert curve.slope == INF
    assert curve.probability([0.1, 0.7, 0.9]).tolist() == [0.0, 0.5, 1.0]
    # At a midpoint on a level its ten runs have 1/2 each: 2 x 10 log 2 = 13.9 is above 3.84. Between them all fits.
    assert ends(curve) == pytest.approx((0.6, 0.8), abs=1e-3)
    # Two runs a level cost 2 x 2 log 2 = 2.8 only: the interval reaches past the levels.
    few = failure_curve(LEVELS[::5], LEVELS[::5] > 0.7)
    assert few.midpoint.low < 0.6
    assert few.midpoint.high > 0.8


def test_one_level_with_both_outcomes_parts_the_others():
    # 2 of 10 fail at 0.6, none below and all above: half of them fail just above 0.6.
    failed = (LEVELS > 0.7) | ((LEVELS == 0.6) & (np.arange(50) % 10 < 2))
    curve = failure_curve(LEVELS, failed)
    assert curve.midpoint.estimate == pytest.approx(0.6, abs=1e-4)
    assert 0.59 < curve.midpoint.low <= curve.midpoint.estimate < curve.midpoint.high < 0.8


@pytest.mark.parametrize("groups", [None, np.tile(np.arange(10), 5)])
def test_none_or_all_failed(groups):
    none, every = (failure_curve(LEVELS, failed, groups) for failed in (LEVELS > 2, LEVELS > 0))
    assert np.isnan([none.midpoint.estimate, every.midpoint.estimate, none.slope]).all()
    assert none.midpoint.high == INF
    assert every.midpoint.low == -INF
    # Ten runs without a failure at 1.0, as good as two independent ones with the groups of 5.
    assert none.midpoint.low == pytest.approx(1.0, abs=0.1)
    assert every.midpoint.high == pytest.approx(0.2, abs=0.1)
    assert none.probability([0.0, 5.0]).tolist() == [0.0, 0.0]
    assert every.probability(1.0) == 1.0
    assert none.verdict.startswith("half of the runs fail at ")
    assert "or more" in none.verdict
    assert "or less" in every.verdict


def test_groups_that_are_copies_count_as_one_run_each():
    # Ten paths without failures at one run a level tell as much as two independent paths.
    none = failure_curve(LEVELS, LEVELS > 2, np.tile(np.arange(10), 5))
    assert none.design_effect == 5.0
    assert none.midpoint.low < failure_curve(LEVELS, LEVELS > 2).midpoint.low


def test_no_trend():
    flat = failure_curve(*runs([3, 3, 3], 10))
    assert np.isnan(flat.midpoint.estimate)
    assert flat.probability([0, 9]) == pytest.approx([0.3, 0.3])
    assert "30 runs failed" in flat.verdict
    assert flat.midpoint.high == INF
    balanced = failure_curve(*runs([5, 5, 5], 10))
    assert ends(balanced) == (-INF, INF)
    assert balanced.verdict == "the runs do not tell where half of them fail; 15 of 30 runs failed"


def test_a_trend_against_the_expected_direction_is_none():
    assert np.isnan(failure_curve(LEVELS, LEVELS < 0.5).midpoint.estimate)
    falling = failure_curve(LEVELS, LEVELS < 0.5, rising=False)
    assert falling.midpoint.estimate == pytest.approx(0.5)
    assert falling.probability([0.4, 0.6]).tolist() == [1.0, 0.0]


def test_a_falling_curve_is_a_rising_one_in_a_mirror():
    x, failed = runs([1, 2, 4, 5], 6)
    rising, falling = failure_curve(x, failed), failure_curve(-x, failed, rising=False)
    assert falling.slope == pytest.approx(-rising.slope)
    assert (-falling.midpoint.high, -falling.midpoint.low) == pytest.approx(ends(rising))


@given(counts, st.floats(0.01, 100.0), st.floats(-50.0, 50.0))
@settings(deadline=None, max_examples=50)
def test_units_of_the_factor_do_not_matter(failures, scale, shift):
    x, failed = runs(failures, 6)
    curve, moved = failure_curve(x, failed), failure_curve(scale * x + shift, failed)
    expected = np.array([curve.midpoint.estimate, *ends(curve)]) * scale + shift
    np.testing.assert_allclose([moved.midpoint.estimate, *ends(moved)], expected, rtol=1e-4, atol=1e-4 * scale)


@given(counts)
@settings(deadline=None, max_examples=50)
def test_intervals_hold_the_estimate_and_probabilities_rise(failures):
    curve = failure_curve(*runs(failures, 6))
    assume(not np.isnan(curve.midpoint.estimate))
    assert curve.midpoint.low <= curve.midpoint.estimate <= curve.midpoint.high
    p = curve.probability(np.linspace(-1.0, 5.0, 50))
    assert (np.diff(p) >= 0).all()
    assert curve.probability(curve.midpoint.estimate) == pytest.approx(0.5)


def test_repeating_each_run_tells_nothing_new():
    x, failed = runs([1, 2, 4, 5], 6)
    once = failure_curve(x, failed, np.arange(len(x)))
    thrice = failure_curve(np.repeat(x, 3), np.repeat(failed, 3), np.repeat(np.arange(len(x)), 3))
    # The robust variance has n - 2 in its denominator: (24 - 1) / (24 - 2) and (72 - 1) / (72 - 2) differ by 3 %.
    assert thrice.design_effect == pytest.approx(3 * once.design_effect, rel=0.04)
    assert ends(thrice) == pytest.approx(ends(once), abs=0.1)
    assert failure_curve(np.repeat(x, 3), np.repeat(failed, 3)).midpoint.low > thrice.midpoint.low + 0.2


def test_one_path_tells_nothing_of_others():
    x, failed = runs([1, 2, 4, 5], 6)
    curve = failure_curve(x, failed, ["kitchen"] * len(x))
    assert curve.midpoint.estimate == pytest.approx(failure_curve(x, failed).midpoint.estimate)
    assert ends(curve) == (-INF, INF)


@pytest.mark.parametrize(("x", "failed"), [([1.0], [True]), ([1.0], [False]), ([1.0] * 6, [True] * 2 + [False] * 4)])
def test_one_level_has_no_midpoint(x, failed):
    curve = failure_curve(x, failed)
    assert np.isnan(curve.midpoint.estimate)
    assert curve.probability(7.0) == pytest.approx(np.mean(failed))


def test_one_level_at_which_few_fail_is_below_the_midpoint():
    low, high = ends(failure_curve([1.0] * 20, [True] + [False] * 19))
    assert low == pytest.approx(1.0)
    assert high == INF


def test_the_verdict():
    curve = failure_curve(LEVELS, LEVELS > 0.7)
    assert curve.verdict == "half of the runs fail at 0.7 (95 % interval 0.6 to 0.8); 20 of 50 runs failed"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([], []), r"got shape \(0,\)"),
        (([1.0, 2.0], [True]), r"bool \(2,\), one a run, got bool of shape \(1,\)"),
        (([1.0, 2.0], ["False", "True"]), r"expected `failed` as bool"),
        (([1.0, 2.0], [-1, -2]), r"expected `failed` as bool"),
        (([1.0, np.nan], [True, False]), "expected finite levels"),
        (([1.0, 2.0], [True, False], [1]), "one group for each of 2 runs"),
        (([1.0, 2.0], [True, False], None, 1.0), "confidence"),
    ],
)
def test_what_has_no_curve_is_refused(arguments, message):
    with pytest.raises(ConfigError, match=message):
        failure_curve(*arguments)
