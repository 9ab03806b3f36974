import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from statsmodels.stats.contingency_tables import mcnemar

from slamgym.errors import ConfigError
from slamgym.eval.statistics import compare_pairs

NAN = np.nan
NONE = np.zeros(10, dtype=bool)
values = st.floats(0.01, 10.0)
paths = st.lists(st.tuples(values, values, st.booleans(), st.booleans()), min_size=1, max_size=25)


def first(n):
    return np.arange(10) < n


def test_wins_and_losses_by_hand():
    # a is better on 8 paths and worse on 2: p = 2 (1 + 10 + 45) / 1024.
    a = np.full(10, 2.0)
    result = compare_pairs(a, np.where(first(2), 1.0, 4.0), NONE, NONE)
    assert (result.wins, result.losses, result.ties) == (8, 2, 0)
    assert result.sign_p == pytest.approx(112 / 1024)
    assert result.median_difference.estimate == -2.0
    # Ratios 2, 2 and eight times 1/2: 2^((2 - 8) / 10).
    assert result.geometric_mean_ratio.estimate == pytest.approx(2**-0.6)


def test_failures_lose_and_two_failures_tie():
    # Path 0: both failed; 1 to 5: only b failed; 6: only a failed; 7: equal; 8: a better; 9: b better.
    a = [NAN, 9, 9, 9, 9, 9, NAN, 3, 1, 2]
    b = [NAN, NAN, NAN, NAN, NAN, NAN, 1, 3, 2, 1]
    result = compare_pairs(a, b, np.isnan(a), np.isnan(b))
    assert (result.wins, result.losses, result.ties, result.both_succeeded) == (6, 2, 2, 3)
    assert result.success_difference.estimate == pytest.approx(0.4)
    # McNemar: 5 against 1, p = 2 (1 + 6) / 64.
    assert result.mcnemar_p == pytest.approx(14 / 64)
    assert result.median_difference.estimate == 0.0


def test_difference_of_success_rates_by_hand():
    # Only b failed on 3 of 10 paths, only a on 1: shares 4/12 and 2/12, center 2/12,
    # error sqrt((6/12 - 4/144) / 12) = 0.19837, half width 1.95996 x 0.19837 = 0.38881.
    path = np.arange(10)
    result = compare_pairs(np.ones(10), np.ones(10), path == 9, path < 3).success_difference
    assert result.estimate == pytest.approx(0.2)
    assert (result.low, result.high) == pytest.approx((1 / 6 - 0.38881, 1 / 6 + 0.38881), abs=1e-4)


def test_all_failed_or_none():
    ones = np.ones(10)
    neither = compare_pairs(ones, ones, ~NONE, ~NONE)
    assert (neither.ties, neither.both_succeeded, neither.sign_p, neither.mcnemar_p) == (10, 0, 1.0, 1.0)
    assert np.isnan([neither.median_difference.estimate, neither.geometric_mean_ratio.low]).all()
    assert neither.success_difference.estimate == 0.0
    b_only = compare_pairs(ones, ones, ~NONE, NONE)
    assert (b_only.losses, b_only.success_difference.estimate, b_only.success_difference.low) == (10, -1.0, -1.0)
    assert b_only.success_difference.high < -0.5


def test_equal_systems():
    same = compare_pairs(np.ones(10), np.ones(10), NONE, NONE)
    assert (same.ties, same.sign_p) == (10, 1.0)
    assert same.geometric_mean_ratio.low == same.geometric_mean_ratio.high == 1.0
    assert 0.0 in same.success_difference


def test_one_path():
    one = compare_pairs([1.0], [2.0], [False], [False])
    assert (one.wins, one.sign_p, one.geometric_mean_ratio.estimate) == (1, 1.0, 0.5)
    assert np.isnan([one.median_difference.low, one.geometric_mean_ratio.low]).all()


def test_a_perfect_path_has_no_ratio():
    assert np.isnan(compare_pairs([0.0, 1.0], [1.0, 1.0], [False] * 2, [False] * 2).geometric_mean_ratio.estimate)


@given(paths)
@settings(deadline=None, max_examples=30)
def test_the_other_way_round_is_the_mirror_image(rows):
    a, b, failed_a, failed_b = (np.array(column) for column in zip(*rows, strict=True))
    ab, ba = compare_pairs(a, b, failed_a, failed_b), compare_pairs(b, a, failed_b, failed_a)
    assert (ab.wins, ab.losses, ab.sign_p, ab.mcnemar_p) == (ba.losses, ba.wins, ba.sign_p, ba.mcnemar_p)
    assert ab.wins + ab.losses + ab.ties == len(rows)
    assert ab.success_difference.low == pytest.approx(-ba.success_difference.high)
    np.testing.assert_allclose(ab.median_difference.low, -ba.median_difference.high, atol=1e-12)
    np.testing.assert_allclose(ab.geometric_mean_ratio.estimate, 1 / ba.geometric_mean_ratio.estimate)
    table = [[0, np.sum(~failed_a & failed_b)], [np.sum(failed_a & ~failed_b), 0]]
    assert ab.mcnemar_p == pytest.approx(min(1.0, mcnemar(table, exact=True).pvalue))


def test_one_line():
    text = str(compare_pairs(np.full(10, 2.0), np.full(10, 4.0), NONE, first(3)))
    assert "\n" not in text
    assert text.startswith(
        "a against b on 10 paths: 10 won, 0 lost, 0 tied (sign test p = 0.002); success rate a - b 0.3"
    )
    assert "on 7 paths where both succeeded: median a - b -2 (95 % interval -2 to -2)" in text


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([], [], [], []), "one value a path"),
        (([1.0, 2.0], [1.0], [False] * 2, [False]), "one value a path"),
        (([1.0], [NAN], [False], [False]), "each path of b that did not fail"),
        (([-1.0], [1.0], [False], [False]), "each path of a that did not fail"),
        (([1.0], [1.0], [False], [False], 0.0), "confidence"),
    ],
)
def test_what_cannot_be_compared_is_refused(arguments, message):
    with pytest.raises(ConfigError, match=message):
        compare_pairs(*arguments)
