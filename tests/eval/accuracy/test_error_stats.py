from dataclasses import asdict

import numpy as np
import pytest

from slamgym.eval.accuracy import ErrorStats, PoseErrorStats


def test_statistics_by_hand():
    # Squares 1, 4, 4, 9, 49: their mean is 67 / 5 = 13.4; the variance is 13.4 - 3^2 = 4.4.
    stats = ErrorStats.of(np.array([7.0, 1.0, 2.0, 3.0, 2.0]))
    expected = {"rmse": 13.4**0.5, "mean": 3.0, "median": 2.0, "std": 4.4**0.5, "min": 1.0, "max": 7.0}
    assert asdict(stats) == pytest.approx(expected)


def test_one_error_is_all_its_statistics():
    expected = {"rmse": 2.0, "mean": 2.0, "median": 2.0, "std": 0.0, "min": 2.0, "max": 2.0}
    assert asdict(ErrorStats.of(np.array([2.0]))) == expected


def test_statistics_of_nothing_are_nan():
    stats = PoseErrorStats.of(np.empty(0), np.empty(0))
    assert np.isnan([*asdict(stats.trans_m).values(), *asdict(stats.rot_deg).values()]).all()
