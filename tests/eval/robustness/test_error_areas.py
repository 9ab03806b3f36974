"""The area under the cumulative error curve, and precision and recall of poses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.robustness import error_area, precision_recall, precision_recall_area

NAN, INF = np.nan, np.inf


@pytest.mark.parametrize(
    ("errors", "expected"),
    [
        # Over thresholds 0..2: 0.5 counts for 3/4 of them, 1 for 1/2, 2 and 3 for none, failed ones never.
        ([0.5, 1.0, 2.0, 3.0, NAN, INF], (0.75 + 0.5) / 6),
        ([0.0, 0.0], 1.0),
        ([NAN, INF], 0.0),
        ([1.0], 0.5),
    ],
)
def test_area_under_the_cumulative_curve(errors, expected):
    assert error_area(np.array(errors), 2.0) == pytest.approx(expected)


def test_no_sequence_has_no_area():
    assert np.isnan(error_area(np.empty(0), 1.0))


def test_precision_counts_the_estimates_and_recall_the_truth():
    # Three of four estimates are right; the truth has ten poses: F1 = 2 * 0.75 * 0.3 / 1.05 = 3/7.
    errors = np.array([0.0, 0.1, 0.2, NAN])
    assert precision_recall(errors, 10, 0.2) == pytest.approx((3 / 4, 3 / 10, 3 / 7))
    assert precision_recall(errors, 10, 0.0) == pytest.approx((1 / 4, 1 / 10, 2 / 14))
    # Over thresholds 0..0.2 they are right for 1, 1/2, 0 and 0 of them: 1.5 on the mean.
    assert precision_recall_area(errors, 10, 0.2) == pytest.approx((1.5 / 4, 1.5 / 10, 3 / 14))


def test_all_correct_and_never_initialised():
    assert precision_recall(np.zeros(5), 5, 0.1) == (1, 1, 1)
    assert precision_recall_area(np.zeros(5), 5, 0.1) == (1, 1, 1)
    assert precision_recall(np.empty(0), 5, 0.1) == (0, 0, 0)
    assert precision_recall_area(np.empty(0), 5, 0.1) == (0, 0, 0)
    assert precision_recall(np.empty(0), 0, 0.1) == (0, 0, 0)


ERRORS = st.lists(st.one_of(st.floats(0, 2), st.sampled_from([NAN, INF])), min_size=1, max_size=15).map(np.array)


@settings(deadline=None)
@given(ERRORS)
def test_areas_are_the_integrals_of_their_curves(errors):
    # Midpoints of N equal thresholds are off by at most half a threshold's weight for each step.
    n, n_truth = 400, len(errors) + 3
    thresholds = (np.arange(n) + 0.5) / n
    curves = [precision_recall(errors, n_truth, threshold) for threshold in thresholds]
    assert precision_recall_area(errors, n_truth, 1.0) == pytest.approx(np.mean(curves, axis=0), abs=1 / n)
    assert error_area(errors, 1.0) == pytest.approx(np.mean([p.precision for p in curves]), abs=1 / n)


@settings(deadline=None)
@given(ERRORS)
def test_f1_is_the_harmonic_mean(errors):
    precision, recall, f1 = precision_recall(errors, len(errors) + 3, 1.0)
    assert f1 == pytest.approx(2 * precision * recall / (precision + recall) if precision + recall else 0.0)


@pytest.mark.parametrize(
    ("call", "error", "match"),
    [
        (lambda: error_area(np.array([-0.1]), 1.0), TrajectoryError, "0 or more, got -0.1"),
        (lambda: error_area(np.array([-0.1, NAN]), 1.0), TrajectoryError, "0 or more, got -0.1"),
        (lambda: error_area(np.ones((2, 2)), 1.0), TrajectoryError, r"\(S,\)"),
        (lambda: error_area(np.ones(2), 0.0), ConfigError, "above 0"),
        (lambda: error_area(np.ones(2), INF), ConfigError, "finite"),
        (lambda: precision_recall(np.ones(2), 5, -1.0), ConfigError, "0 or more"),
        (lambda: precision_recall(np.ones(2), 5, INF), ConfigError, "finite"),
        (lambda: precision_recall(np.ones(2), 5, NAN), ConfigError, "0 or more"),
        (lambda: precision_recall(np.ones(6), 5, 1.0), TrajectoryError, "6 errors for 5 true poses"),
        (lambda: precision_recall_area(-np.ones(2), 5, 1.0), TrajectoryError, "0 or more"),
    ],
)
def test_what_is_refused(call, error, match):
    with pytest.raises(error, match=match):
        call()
