import numpy as np
import pytest

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.robustness import average

VALUES = np.array([0.3, 0.1, 9.0, 0.2, np.nan])
FAILED = np.array([False, False, True, False, True])
HELD = np.array([7.0, 7.0, 2.0, 7.0, 4.0])


@pytest.mark.parametrize(
    ("policy", "options", "median", "mean"),
    [
        ("drop", {}, 0.2, 0.2),  # of 0.1, 0.2, 0.3
        ("penalise", {"penalty": 1.0}, 0.3, 2.6 / 5),  # of 0.1, 0.2, 0.3, 1, 1
        ("hold_last_pose", {"held": HELD}, 0.3, 6.6 / 5),  # of 0.1, 0.2, 0.3, 2, 4
    ],
)
def test_what_stands_for_the_failed_runs(policy, options, median, mean):
    assert average(VALUES, FAILED, policy, **options).value == pytest.approx(median)
    assert average(VALUES, FAILED, policy, **options, statistic="mean").value == pytest.approx(mean)


@pytest.mark.parametrize(
    ("policy", "options", "line"),
    [
        ("drop", {}, "0.2 (median of 3 of 5 runs; 2 failed, left out)"),
        ("penalise", {"penalty": 1.0}, "0.3 (median of 5 runs, 2 failed; penalised with 1)"),
        ("penalise", {"penalty": 1.0, "statistic": "mean"}, "0.52 (mean of 5 runs, 2 failed; penalised with 1)"),
        ("hold_last_pose", {"held": HELD}, "0.3 (median of 5 runs, 2 failed; held at their last pose)"),
    ],
)
def test_the_printed_line_tells_what_was_done(policy, options, line):
    assert str(average(VALUES, FAILED, policy, **options)) == line


def test_none_failed():
    assert (
        str(average(np.array([0.1, 0.3]), np.zeros(2, dtype=np.bool_), "drop")) == "0.2 (median of 2 runs, none failed)"
    )


def test_all_failed_and_no_runs():
    failed = np.ones(2, dtype=np.bool_)
    nothing = average(np.array([np.nan, 0.1]), failed, "drop")
    assert np.isnan(nothing.value)
    assert str(nothing) == "nan (median of 0 of 2 runs; 2 failed, left out)"
    assert average(np.array([np.nan, 0.1]), failed, "penalise", penalty=3).value == 3
    assert np.isnan(average(np.empty(0), np.empty(0, dtype=np.bool_), "penalise", penalty=3).value)


def test_an_infinite_penalty_ranks_failures_last():
    values, two_of_five = np.array([0.1, 0.2, 0.3, 0.0, 0.0]), np.array([0, 0, 0, 1, 1], dtype=np.bool_)
    assert average(values, two_of_five, "penalise", penalty=np.inf).value == 0.3
    assert average(values, ~two_of_five, "penalise", penalty=np.inf).value == np.inf


def test_the_arrays_stay_as_they_were():
    values, held = VALUES.copy(), HELD.copy()
    average(values, FAILED, "hold_last_pose", held=held)
    np.testing.assert_array_equal(values, VALUES)
    np.testing.assert_array_equal(held, HELD)


@pytest.mark.parametrize(
    ("policy", "options", "match"),
    [
        ("penalize", {}, "did you mean 'penalise'"),
        ("drop", {"statistic": "medium"}, "did you mean 'median'"),
        ("drop", {"penalty": 1.0}, "`penalty` with the policy 'penalise' and only there"),
        ("penalise", {}, "`penalty` with the policy 'penalise' and only there, got None"),
        ("penalise", {"penalty": 0.0}, "above 0"),
        ("penalise", {"penalty": 0.05}, "worse than every run that did not fail"),
        ("penalise", {"penalty": np.nan}, "above 0"),
        ("penalise", {"penalty": np.inf, "statistic": "mean"}, "finite for a mean"),
        ("penalise", {"penalty": 1.0, "held": HELD}, "`held` values with the policy 'hold_last_pose' and only there"),
        ("hold_last_pose", {}, "only there, got no with"),
        ("hold_last_pose", {"held": HELD, "penalty": 1.0}, "`penalty` with the policy 'penalise'"),
    ],
)
def test_contradicting_options_are_refused(policy, options, match):
    with pytest.raises(ConfigError, match=match):
        average(VALUES, FAILED, policy, **options)


@pytest.mark.parametrize(
    ("values", "failed", "options", "match"),
    [
        (VALUES, np.zeros(5, dtype=np.bool_), {"policy": "drop"}, "finite values"),
        (VALUES[:4], FAILED, {"policy": "drop"}, r"shape \(R,\)"),
        (VALUES, FAILED.astype(float), {"policy": "drop"}, "bool `failed`"),
        (VALUES, FAILED, {"policy": "hold_last_pose", "held": HELD[:3]}, r"shape \(R,\)"),
        (VALUES, FAILED, {"policy": "hold_last_pose", "held": VALUES}, "finite values"),
    ],
)
def test_values_that_cannot_be_averaged_are_refused(values, failed, options, match):
    with pytest.raises(TrajectoryError, match=match):
        average(values, failed, **options)
