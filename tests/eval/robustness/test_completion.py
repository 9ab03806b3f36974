import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import TrajectoryError
from slamgym.eval.robustness import Exposure, completion, exposure, total_exposure


def along_x(x_m):
    T = np.tile(np.eye(4), (len(x_m), 1, 1))
    T[:, 0, 3] = x_m
    return T


def at(seconds):
    return (np.array(seconds) * 1e9).astype(np.int64)


def tracked(*frames):
    return np.array(frames, dtype=np.bool_)


def test_frames_time_and_distance_are_told_apart():
    # Steps of 1, 1, 2, 4 s and 3, 0, 1, 6 m; those between frames 0-1 and 3-4 have both ends tracked.
    stamps_ns, T = at([0, 1, 2, 4, 8]), along_x([0, 3, 3, 2, 8])
    which = tracked(1, 1, 0, 1, 1)
    assert exposure(stamps_ns, T, which) == pytest.approx((8, 10, 1 + 4, 3 + 6))
    assert completion(stamps_ns, T, which) == pytest.approx((4 / 5, 5 / 8, 9 / 10))


@pytest.mark.parametrize(
    ("which", "expected"),
    [
        (tracked(0, 0, 0, 0), (0, 0, 0)),  # never initialised
        (tracked(1, 0, 0, 0), (0.25, 0, 0)),  # lost at once: one pose covers no way
        (tracked(1, 0, 1, 0), (0.5, 0, 0)),
        (tracked(1, 1, 1, 1), (1, 1, 1)),
    ],
)
def test_the_ends(which, expected):
    assert completion(at([0, 1, 2, 3]), along_x([0, 1, 2, 3]), which) == expected


def test_where_there_is_nothing_to_share_out():
    nan = pytest.approx(np.nan, nan_ok=True)
    assert completion(at([]), along_x([]), tracked()) == (0.0, nan, nan)
    assert completion(at([5]), along_x([1]), tracked(1)) == (1.0, nan, nan)
    assert completion(at([0, 1]), along_x([2, 2]), tracked(1, 1)) == (1.0, 1.0, nan)


def test_many_drives_are_added_up():
    assert total_exposure([Exposure(8, 10, 5, 9), Exposure(2, 1, 0, 0)]) == (10, 11, 5, 9)
    assert total_exposure([]) == (0, 0, 0, 0)


def test_poses_that_do_not_fit_the_stamps_are_refused():
    with pytest.raises(TrajectoryError, match="expected 2 poses"):
        completion(at([0, 1]), along_x([0, 1, 2]), tracked(1, 1))


@settings(deadline=None)
@given(st.lists(st.tuples(st.integers(1, 10**10), st.floats(-5, 5), st.booleans()), min_size=2, max_size=30))
def test_shares_stay_between_none_and_all_and_one_more_pose_never_lowers_them(frames):
    steps_ns, x, which = (np.array(column) for column in zip(*frames, strict=True))
    stamps_ns, T = np.cumsum(steps_ns), along_x(x)
    fewer = which & (np.arange(len(which)) != 1)
    for share, share_of_fewer in zip(completion(stamps_ns, T, which), completion(stamps_ns, T, fewer), strict=True):
        assert np.isnan(share) or 0 <= share_of_fewer <= share <= 1
