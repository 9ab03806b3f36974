import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import ate
from slamgym.eval.robustness import evaluated_frames, final_by_frame, held_ate, hold_last_pose
from slamgym.geometry import inverse, mast_camera_pose

T_MAP_WORLD = inverse(mast_camera_pose(3.0, -2.0, 0.7, 0.5))


def path(points):
    """Poses that look the way they go, more or less, at the points (x, y)."""
    return np.array([mast_camera_pose(x, y, 0.3 * i, 1.0) for i, (x, y) in enumerate(points)]).reshape(-1, 4, 4)


def flags(text):
    return np.array([c == "T" for c in text], dtype=np.bool_)


def estimate(truth, tracked):
    """A perfect estimate in a map of its own, NaN where nothing is tracked."""
    return np.where(tracked[:, None, None], T_MAP_WORLD @ truth, np.nan)


SQUARE = path([(0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (3, 2)])


@pytest.mark.parametrize(
    ("tracked", "held"),
    [
        ("TTTTTT", [0, 1, 2, 3, 4, 5]),
        ("T..T..", [0, 0, 0, 3, 3, 3]),
        ("..T.T.", [2, 2, 2, 2, 4, 4]),  # before its first pose the robot is held there
        (".....T", [5, 5, 5, 5, 5, 5]),
        ("T.....", [0, 0, 0, 0, 0, 0]),
    ],
)
def test_which_pose_is_held(tracked, held):
    est_T = estimate(SQUARE, flags(tracked))
    before = est_T.copy()
    np.testing.assert_array_equal(hold_last_pose(est_T, flags(tracked), np.eye(4)), (T_MAP_WORLD @ SQUARE)[held])
    np.testing.assert_array_equal(est_T, before)


def test_what_was_never_tracked_stays_at_the_first_true_pose():
    held = hold_last_pose(np.full((3, 4, 4), np.nan), flags("..."), SQUARE[1])
    np.testing.assert_array_equal(held, SQUARE[[1, 1, 1]])
    assert hold_last_pose(np.empty((0, 4, 4)), flags(""), np.eye(4)).shape == (0, 4, 4)


@pytest.mark.parametrize(
    ("tracked", "distances"),
    [
        ("TTTTTT", [0, 0, 0, 0, 0, 0]),
        # Perfect where tracked, then held at (1, 1): 1, sqrt(2) and sqrt(5) m away from the truth.
        ("TTT...", [0, 0, 0, 1, 2**0.5, 5**0.5]),
        ("TT....", [0, 0, 1, 2**0.5, 5**0.5, 8**0.5]),  # two poses: held at (1, 0), aligned by the first
        ("T.....", [0, 1, 2**0.5, 1, 2, 13**0.5]),  # lost at once: held at (0, 0)
        ("......", [0, 1, 2**0.5, 1, 2, 13**0.5]),  # never initialised: the same
        (".....T", [13**0.5, 8**0.5, 5**0.5, 10**0.5, 3, 0]),  # from the end back to (3, 2)
    ],
)
def test_held_errors_by_hand(tracked, distances):
    got = held_ate(SQUARE, estimate(SQUARE, flags(tracked)), flags(tracked))
    assert got.rmse == pytest.approx(np.sqrt(np.mean(np.square(distances))), abs=1e-9)
    assert got.max == pytest.approx(max(distances), abs=1e-9)


def test_three_poses_are_aligned_by_their_places_and_two_by_the_first_pose():
    # The first pose looks 90 degrees to the wrong side. Three places fit all the same; by that pose alone (1, 0) comes
    # to lie at (0, -1), held for four more frames.
    est_T = SQUARE.copy()
    est_T[0] = mast_camera_pose(0, 0, np.pi / 2, 1.0)
    assert held_ate(SQUARE[:3], est_T[:3], flags("TTT")).max == pytest.approx(0, abs=1e-9)
    by_first = held_ate(SQUARE, est_T, flags("TT...."))
    assert by_first.rmse == pytest.approx(np.sqrt((0 + 2 + 5 + 4 + 9 + 18) / 6))


def test_no_frame_has_no_error():
    assert np.isnan(held_ate(np.empty((0, 4, 4)), np.empty((0, 4, 4)), flags("")).rmse)


def test_losing_track_costs_what_the_plain_error_hides(make_record):
    record = make_record("0000000000xxxxxxxxxxxxxxxxxxxx")
    (est_T, _), tracked = final_by_frame(record), evaluated_frames(record)
    assert ate(record.T_world_cam[tracked], est_T[tracked]).trans_m.rmse < 1e-6
    assert held_ate(record.T_world_cam, est_T, tracked).rmse > 0.5


@settings(deadline=None)
@given(st.lists(st.booleans(), min_size=1, max_size=20), st.integers(0, 2**32 - 1))
def test_where_the_map_lies_makes_no_difference(tracked, seed):
    tracked, rng = np.array(tracked, dtype=np.bool_), np.random.default_rng(seed)
    truth = path(np.cumsum(rng.normal(size=(len(tracked), 2)), axis=0))
    noisy = truth.copy()
    noisy[:, :3, 3] += 0.01 * rng.normal(size=(len(tracked), 3))
    here, there = held_ate(truth, noisy, tracked), held_ate(truth, T_MAP_WORLD @ noisy, tracked)
    assert here.rmse == pytest.approx(there.rmse, abs=1e-6)


def test_poses_and_flags_that_do_not_fit_are_refused():
    with pytest.raises(TrajectoryError, match="held poses"):
        held_ate(SQUARE, SQUARE, flags("TT"))
    with pytest.raises(TrajectoryError, match="held poses"):
        hold_last_pose(SQUARE, np.ones(6), np.eye(4))
    with pytest.raises(TrajectoryError, match="in pairs"):
        held_ate(SQUARE[:2], SQUARE, flags("...TTT"))
    with pytest.raises(TrajectoryError, match="finite"):
        held_ate(SQUARE, estimate(SQUARE, flags("TTTTT.")), flags("TTTTTT"))
