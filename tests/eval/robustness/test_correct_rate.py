import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.robustness import correct_poses, correct_rate, correct_rate_of_tracking, relocalization_score

S = 1_000_000_000


def at(*seconds):
    return np.array([second * S for second in seconds], dtype=np.int64)


def right(*poses):
    return np.array(poses, dtype=np.bool_)


NONE = at(), right()


def test_both_errors_must_be_within_their_bounds():
    trans_m, rot_deg = np.array([0.1, 0.2, 0.0, np.nan, 0.1]), np.array([5.0, 0.0, 9.0, 0.0, np.inf])
    assert correct_poses(trans_m, rot_deg, max_trans_m=0.1, max_rot_deg=5).tolist() == [
        True,
        False,
        False,
        False,
        False,
    ]
    unbounded = correct_poses(trans_m, rot_deg, max_trans_m=np.inf, max_rot_deg=np.inf)
    assert unbounded.tolist() == [True, True, True, False, True]
    assert correct_poses(np.zeros(1), np.zeros(1), max_trans_m=0, max_rot_deg=0).tolist() == [True]
    assert correct_poses(np.empty(0), np.empty(0), max_trans_m=1, max_rot_deg=1).tolist() == []


def test_a_right_pose_holds_until_the_next_one_for_one_second_at_most():
    # In a sequence of 0..20 s, poses at 4, 4.5, 8, 9, 19.5 s hold 0.5, 1 (of 3.5), 1, 1 (of 10.5), 0.5 s; that at 8 s
    # is wrong: 0.5 + 1 + 1 + 0.5 = 3 s of 20 s, or of the 16 s since the first pose.
    poses = np.array([4.0, 4.5, 8, 9, 19.5]) * S
    stamps_ns, correct = poses.astype(np.int64), right(1, 1, 0, 1, 1)
    assert correct_rate(stamps_ns, correct, 0, 20 * S) == pytest.approx(3 / 20)
    assert correct_rate_of_tracking(stamps_ns, correct, 0, 20 * S) == pytest.approx(3 / 16)
    assert correct_rate(stamps_ns, correct, 0, 20 * S, max_interval_s=2) == pytest.approx((0.5 + 2 + 2 + 0.5) / 20)
    assert relocalization_score(stamps_ns, correct, 0) == pytest.approx(math.exp(-4 / 60))


def test_all_correct_from_start_to_end():
    stamps_ns, correct = at(10, 11, 12), right(1, 1, 1)
    assert correct_rate(stamps_ns, correct, 10 * S, 12 * S) == 1.0
    assert correct_rate_of_tracking(stamps_ns, correct, 10 * S, 12 * S) == 1.0
    assert relocalization_score(stamps_ns, correct, 10 * S) == 1.0


def test_never_initialised():
    assert correct_rate(*NONE, 0, 10 * S) == 0.0
    assert correct_rate_of_tracking(*NONE, 0, 10 * S) == 0.0
    assert relocalization_score(*NONE, 0) == 0.0


def test_lost_at_once_and_one_pose_at_the_very_end():
    assert correct_rate(at(0), right(1), 0, 10 * S) == pytest.approx(0.1)
    assert correct_rate(at(10), right(1), 0, 10 * S) == 0.0
    assert math.isnan(correct_rate_of_tracking(at(10), right(1), 0, 10 * S))  # 0 s of 0 s


def test_a_wrong_first_pose_is_no_relocalisation():
    assert relocalization_score(at(1, 2), right(0, 1), 0) == 0.0


def test_a_sequence_of_no_time_has_no_rate():
    assert math.isnan(correct_rate(at(5), right(1), 5 * S, 5 * S))


def test_poses_outside_the_sequence_earn_nothing_there():
    # Of the poses at -0.5, 0.5, 3.5 s in 0..3 s the first holds for 0.5 s, the second for 1 s.
    stamps_ns = (np.array([-0.5, 0.5, 3.5]) * S).astype(np.int64)
    assert correct_rate(stamps_ns, right(1, 1, 1), 0, 3 * S) == pytest.approx(1.5 / 3)
    assert relocalization_score(stamps_ns, right(1, 1, 1), 0) == 1.0


@settings(deadline=None)
@given(
    st.lists(st.tuples(st.integers(-(10**10), 10**11), st.booleans()), unique_by=lambda pose: pose[0], max_size=20),
    st.integers(1, 10**11),
)
def test_rates_stay_between_0_and_1_and_tracking_never_scores_below(poses, end_ns):
    stamps_ns = np.array([stamp for stamp, _ in sorted(poses)], dtype=np.int64)
    correct = np.array([is_correct for _, is_correct in sorted(poses)], dtype=np.bool_)
    rate, tracking = (f(stamps_ns, correct, 0, end_ns) for f in (correct_rate, correct_rate_of_tracking))
    assert 0 <= rate <= 1
    assert math.isnan(tracking) or rate <= tracking <= 1


@pytest.mark.parametrize(
    ("call", "error", "match"),
    [
        (lambda: correct_rate(at(1, 1), right(1, 1), 0, S), TrajectoryError, "strictly increasing"),
        (lambda: correct_rate(at(1), right(1, 0), 0, S), TrajectoryError, "as many bool flags"),
        (lambda: correct_rate(at(1), at(1), 0, S), TrajectoryError, "as many bool flags"),
        (lambda: correct_rate(at(1), right(1), S, 0), TrajectoryError, "ends at its start"),
        (lambda: correct_rate(at(1), right(1), 0, S, 0.0), ConfigError, "above 0 s"),
        (lambda: relocalization_score(at(1), right(1), 0, 0), ConfigError, "above 0 s"),
        (lambda: correct_poses(np.ones(2), np.ones(3), max_trans_m=1, max_rot_deg=1), TrajectoryError, "in pairs"),
        (lambda: correct_poses(np.ones(2), np.ones(2), max_trans_m=-1, max_rot_deg=1), ConfigError, "0 or more"),
    ],
)
def test_what_is_refused(call, error, match):
    with pytest.raises(error, match=match):
        call()
