from dataclasses import dataclass

import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval.plots import plot_failure_curve
from slamgym.eval.plots.failure_curves import FailureCounts, plot_failure_curves
from slamgym.eval.statistics import Interval
from slamgym.types import FloatArray

NAN, INF = np.nan, np.inf


@dataclass(frozen=True)
class Logistic:
    midpoint: Interval
    slope: float = 8.0

    def probability(self, x: FloatArray) -> FloatArray:
        return 1.0 / (1.0 + np.exp(-self.slope * (x - self.midpoint.estimate)))


def test_shares_intervals_and_the_point_where_half_fail(texts_of):
    curve = Logistic(Interval(0.5, 0.4, 0.7))
    figure = plot_failure_curve([0.2, 0.4, 0.8], [0, 3, 10], [10, 10, 10], curve, title="ORB-SLAM3")
    texts = set(texts_of(figure))
    assert {"ORB-SLAM3: 13 of 30 runs failed", "0/10", "3/10", "10/10", "speed (m/s)"} <= texts
    assert {"half fail at 0.5", "half fail, 95 % interval 0.4 to 0.7"} <= texts


def test_the_bars_are_wilson_intervals():
    # Wilson, 0 of 10, z = 1.96: from 0 to z^2 / (10 + z^2) = 3.8415 / 13.8415 = 0.2775.
    (bars,) = plot_failure_curve([1.0], [0], [10]).axes[0].containers
    (segments,) = bars.lines[2]
    assert segments.get_segments()[0][:, 1] == pytest.approx([0.0, 0.2775], abs=1e-4)


@pytest.mark.parametrize(
    ("interval", "words"),
    [
        (Interval(0.9, 0.5, INF), "half fail, 95 % interval 0.5 or more"),
        (Interval(NAN, -INF, 0.3), "half fail, 95 % interval 0.3 or less"),
        (Interval(0.5, -INF, INF), "half fail, 95 % interval unbounded"),
    ],
)
def test_an_end_may_be_infinite(interval, words, texts_of):
    figure = plot_failure_curve([0.2, 0.4], [0, 1], [5, 5], Logistic(interval))
    assert words in texts_of(figure)
    assert figure.axes[0].get_xlim()[1] < 1.0


def test_without_a_midpoint_none_is_claimed(texts_of):
    texts = texts_of(plot_failure_curve([0.2, 0.4], [0, 0], [5, 5], Logistic(Interval(NAN, NAN, NAN))))
    assert not [text for text in texts if "half fail" in text]


@pytest.mark.parametrize(("failed", "runs"), [([0], [1]), ([1], [1]), ([0], [0])])
def test_one_level(failed, runs, texts_of):
    assert f"{failed[0]} of {runs[0]} runs failed" in texts_of(plot_failure_curve([0.5], failed, runs))


def x_ticks(figure):
    return [label.get_text() for label in figure.axes[0].get_xticklabels()]


def test_few_levels_have_their_own_ticks():
    assert x_ticks(plot_failure_curve([0, 1, 2.5], [0, 1, 2], [5, 5, 5])) == ["0", "1", "2.5"]
    counts = FailureCounts(np.array([0.0, 2.0]), np.array([0, 1]), np.array([5, 5]))
    assert x_ticks(plot_failure_curves({"a": counts, "b": counts})) == ["0", "2"]
    crowded = [0, 0.1, 10]
    for levels in (crowded, range(9)):
        assert len(x_ticks(plot_failure_curve(levels, [0] * len(levels), [5] * len(levels)))) != len(levels)


def test_many_levels_and_none(texts_of):
    n = np.arange(30)
    assert "29/30" in texts_of(plot_failure_curve(n, n, np.full(30, 30), factor="$a$ (s)", title="<&_"))
    assert "0 of 0 runs failed" in texts_of(plot_failure_curve([], [], []))


@pytest.mark.parametrize(
    ("levels", "failed", "runs", "message"),
    [
        ([1, 2], [1], [1, 1], "one length"),
        ([1], [2], [1], "0 <= failed <= runs"),
        ([NAN], [1], [1], "finite levels"),
        ([1], [-1], [1], "0 <= failed <= runs"),
    ],
)
def test_impossible_counts_are_refused(levels, failed, runs, message):
    with pytest.raises(ConfigError, match=message):
        plot_failure_curve(levels, failed, runs)
