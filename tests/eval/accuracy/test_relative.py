from dataclasses import asdict

import numpy as np
import pytest

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.accuracy import rpe

SECOND = 1_000_000_000


@pytest.fixture
def drifting(straight):
    """drifting(x): truth at x, and an estimate off by 0, 1, 3, 7, ... m: every pair has an error of its own."""

    def make(x):
        x = np.asarray(x, dtype=np.float64)
        return straight(x), straight(x + 2.0 ** np.arange(len(x)) - 1.0)

    return make


def trans_m(stats):
    """Least, mean and largest translation error."""
    return [stats.trans_m.min, stats.trans_m.mean, stats.trans_m.max]


def test_frames_by_hand(drifting):
    ref_T, est_T = drifting([0, 1, 2, 3, 4])
    # Off by 0, 1, 3, 7, 15: two frames on the error grows by 3, 6 and 12.
    assert trans_m(rpe(ref_T, est_T, 2)) == pytest.approx([3, 7, 12])
    # From 0 to 2 by 3, from 2 to 4 by 12.
    assert trans_m(rpe(ref_T, est_T, 2, pairs="consecutive")) == pytest.approx([3, 7.5, 12])


def test_metres_by_hand(drifting):
    # Truth at 0, 0.95, 2, 5; off by 0, 1, 3, 7. 1 m on from 0 is 0.95, from 0.95 is 2; 5 is too far from 2.
    ref_T, est_T = drifting([0, 0.95, 2, 5])
    assert trans_m(rpe(ref_T, est_T, 1.0, "metres")) == pytest.approx([1, 1.5, 2])
    # 0.05 is more than 1 % of a metre.
    assert np.isnan(rpe(ref_T, est_T, 1.0, "metres", tolerance=0.01).trans_m.rmse)
    # 0.95 is no metre yet: from 0 to 2 by 3, from 2 to 5 by 4.
    assert trans_m(rpe(ref_T, est_T, 1.0, "metres", pairs="consecutive")) == pytest.approx([3, 3.5, 4])


def test_metres_follow_the_path_of_the_truth(straight):
    # 2 m on the true path, to 1 m and back; the estimate stood still.
    ref_T, est_T = straight([0.0, 1.0, 0.0]), straight([0.0, 0.0, 0.0])
    assert trans_m(rpe(ref_T, est_T, 2.0, "metres")) == [0.0, 0.0, 0.0]
    assert trans_m(rpe(ref_T, est_T, 1.0, "metres")) == [1.0, 1.0, 1.0]


def test_seconds_by_hand(drifting):
    # At 0, 1, 2 and 4 s, in Unix time; off by 0, 1, 3, 7. 2 s on from 0 is 2, from 2 is 4; from 1 on, 2 and 4 are off
    # by half of it.
    ref_T, est_T = drifting([0, 1, 2, 3])
    stamps_ns = 1_700_000_000 * SECOND + np.array([0, 1, 2, 4]) * SECOND
    assert trans_m(rpe(ref_T, est_T, 2.0, "seconds", stamps_ns=stamps_ns)) == pytest.approx([3, 3.5, 4])
    # With half of it allowed, the earlier of the two: by 2.
    everything = rpe(ref_T, est_T, 2.0, "seconds", stamps_ns=stamps_ns, tolerance=0.5)
    assert trans_m(everything) == pytest.approx([2, 3, 4])
    # 1 s is reached at 1, 2 and 4.
    consecutive = rpe(ref_T, est_T, 1.0, "seconds", stamps_ns=stamps_ns, pairs="consecutive")
    assert trans_m(consecutive) == pytest.approx([1, 7 / 3, 4])


@pytest.mark.parametrize("milliseconds", [67, 1001])
def test_seconds_are_exact_to_the_nanosecond(milliseconds, drifting):
    # In floats 0.067 s are 67000000.00000001 ns, and 1.001 s are 1000999999.9999999 ns.
    ref_T, est_T = drifting([0, 1, 2])
    step_ns = milliseconds * 1_000_000
    # The second step is a nanosecond shorter.
    stamps_ns = 1_700_000_000 * SECOND + np.array([0, step_ns, 2 * step_ns - 1])
    options = {"delta": milliseconds / 1000, "unit": "seconds", "stamps_ns": stamps_ns}
    assert trans_m(rpe(ref_T, est_T, pairs="consecutive", **options)) == [1, 1, 1]
    assert trans_m(rpe(ref_T, est_T, tolerance=0.0, **options)) == [1, 1, 1]


def test_seconds_at_a_steady_rate_are_frames(random_pair):
    ref_T, est_T = random_pair(0, 50)
    stamps_ns = np.arange(50, dtype=np.int64) * 33_333_333
    for pairs in ("all", "consecutive"):
        seconds = rpe(ref_T, est_T, 3 * 0.033333333, "seconds", pairs=pairs, stamps_ns=stamps_ns)
        assert seconds == rpe(ref_T, est_T, 3, pairs=pairs)


def test_rotation_by_hand(straight):
    ref_T, est_T = straight([0, 0, 0], [0.0, 90.0, 180.0]), straight([0, 0, 0], [0.0, 100.0, 170.0])
    # The estimate turns by 100 and 70 where the truth turns by 90 and 90.
    stats = rpe(ref_T, est_T).rot_deg
    assert [stats.min, stats.mean, stats.max] == pytest.approx([10, 15, 20])


def test_a_perfect_estimate_has_no_error(random_pair):
    ref_T, est_T = random_pair(0, 20, 0.0)
    stats = rpe(ref_T, est_T, 3)
    assert [*asdict(stats.trans_m).values(), *asdict(stats.rot_deg).values()] == pytest.approx([0.0] * 12, abs=1e-11)


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-5, 0.5, 3.0, np.pi])
def test_rotation_errors_are_exact_for_any_angle(angle, straight):
    # Turned back, the angles near a full turn are small ones.
    for turned in (angle, 2 * np.pi - angle):
        stats = rpe(straight([0, 0]), straight([0, 0], [0.0, np.degrees(turned)]))
        assert stats.rot_deg.mean == pytest.approx(np.degrees(angle), rel=1e-12, abs=1e-13)


def test_untracked_frames_keep_their_place_among_the_frames(drifting):
    ref_T, est_T = drifting([0, 1, 2, 3, 4])
    tracked = np.array([True, False, True, False, True])
    est_T[~tracked] = np.nan
    assert np.isnan(rpe(ref_T, est_T, 1, tracked=tracked).trans_m.rmse)
    assert trans_m(rpe(ref_T, est_T, 2, tracked=tracked)) == pytest.approx([3, 7.5, 12])


def test_untracked_frames_keep_their_place_on_the_path_and_in_time(drifting):
    # Off by 0, 1, 3, 7, 15; without frame 2, of the pairs two apart only that from 1 to 3 is left.
    ref_T, est_T = drifting([0, 1, 2, 3, 4])
    tracked = np.array([True, True, False, True, True])
    est_T[2] = np.nan
    assert trans_m(rpe(ref_T, est_T, 2.0, "metres", tracked=tracked)) == pytest.approx([6, 6, 6])
    in_time = rpe(ref_T, est_T, 2.0, "seconds", stamps_ns=np.arange(5) * SECOND, tracked=tracked)
    assert trans_m(in_time) == pytest.approx([6, 6, 6])
    # No pair moves on to a tracked frame: the consecutive ones end and start at the untracked frame 2.
    assert np.isnan(rpe(ref_T, est_T, 2.0, "metres", pairs="consecutive", tracked=tracked).trans_m.rmse)


def test_no_pair_reaches_from_one_map_into_another(drifting):
    ref_T, est_T = drifting([0, 1, 2, 3])
    # Off by 0, 1, 3, 7: frame 1 to 2 changes the map.
    assert trans_m(rpe(ref_T, est_T, map_ids=np.array([0, 0, 1, 1]))) == pytest.approx([1, 2.5, 4])
    assert trans_m(rpe(ref_T, est_T, map_ids=np.array([-1, -1, 1, 1]))) == pytest.approx([4, 4, 4])


@pytest.mark.parametrize("n", [0, 1])
def test_fewer_than_two_poses_have_no_relative_error(n):
    T, stamps_ns = np.tile(np.eye(4), (n, 1, 1)), np.arange(n, dtype=np.int64)
    for pairs in ("all", "consecutive"):
        assert np.isnan(rpe(T, T, pairs=pairs).trans_m.rmse)
        assert np.isnan(rpe(T, T, 1.0, "metres", pairs=pairs).trans_m.rmse)
        assert np.isnan(rpe(T, T, 1.0, "seconds", pairs=pairs, stamps_ns=stamps_ns).rot_deg.mean)


def test_nothing_tracked_and_nothing_moving(straight):
    T = straight([0.0, 0.0, 0.0])
    untracked = np.zeros(3, dtype=bool)
    assert np.isnan(rpe(T, T * np.nan, tracked=untracked).trans_m.rmse)
    assert np.isnan(rpe(T, T, 1.0, "metres").trans_m.rmse)


STAMPS = np.arange(5, dtype=np.int64) * SECOND


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"delta": 0}, "above 0 .* got 0 frames"),
        ({"delta": -1.0, "unit": "metres"}, "above 0 .* got -1.0 metres"),
        ({"delta": np.nan, "unit": "metres"}, "finite distance .* got nan"),
        ({"delta": np.inf}, "finite distance .* got inf"),
        ({"delta": 1.5}, "whole number of frames, got 1.5"),
        ({"delta": 1e-10, "unit": "seconds", "stamps_ns": STAMPS}, "at least a nanosecond"),
        ({"unit": "meters"}, "did you mean 'metres'"),
        ({"pairs": "every"}, "unknown kind of pairs 'every'"),
        ({"unit": "seconds"}, "expected stamps_ns for pairs in seconds, got none"),
        ({"stamps_ns": STAMPS}, "expected no stamps_ns for pairs in frames, got some"),
        ({"unit": "metres", "stamps_ns": STAMPS}, "expected no stamps_ns for pairs in metres"),
        ({"tolerance": 0.1}, "got one with 'all' in frames"),
        ({"unit": "metres", "pairs": "consecutive", "tolerance": 0.1}, "got one with 'consecutive' in metres"),
        ({"unit": "metres", "tolerance": -0.1}, "from 0 to below 1"),
        ({"unit": "metres", "tolerance": 1.0}, "from 0 to below 1"),
        ({"unit": "metres", "tolerance": np.nan}, "from 0 to below 1"),
    ],
)
def test_options_that_make_no_sense(options, message, random_pair):
    with pytest.raises(ConfigError, match=message):
        rpe(*random_pair(0, 5), **options)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"unit": "seconds", "stamps_ns": STAMPS[:4]}, r"shape \(5,\), one a pose, got int64 of shape \(4,\)"),
        ({"unit": "seconds", "stamps_ns": STAMPS / SECOND}, "int64 nanoseconds .* got float64"),
        ({"unit": "seconds", "stamps_ns": STAMPS // 2 // SECOND}, "step back after pose 0"),
        ({"tracked": np.ones(4, dtype=bool)}, r"tracked: expected bool of shape \(5,\)"),
        ({"tracked": np.arange(5)}, "tracked: expected bool .* got int64"),
        ({"map_ids": np.zeros(5)}, "map_ids: expected integers .* got float64"),
    ],
)
def test_arrays_that_do_not_fit(options, message, random_pair):
    with pytest.raises(TrajectoryError, match=message):
        rpe(*random_pair(0, 5), **options)


def test_poses_that_are_none(random_pair):
    ref_T, est_T = random_pair(0, 5)
    with pytest.raises(TrajectoryError, match="in pose 0: leave it out, or mask it as not tracked"):
        rpe(ref_T, est_T * np.nan)
    with pytest.raises(TrajectoryError, match="in pairs"):
        rpe(ref_T, est_T[:3])
    with pytest.raises(TrajectoryError, match="estimate: expected rigid poses"):
        rpe(ref_T, 2.0 * est_T)
