import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories import Trajectory, fill_holes, find_holes, interpolate
from slamgym.geometry import planar_pose

UNIX_NS = 1_700_000_000_000_000_000


def along_x(times_s):
    """1 m/s along x, turning 0.1 rad/s."""
    stamps_ns = np.array([round(t * 1e9) for t in times_s], dtype=np.int64) + UNIX_NS
    return Trajectory(stamps_ns, np.array([planar_pose(t, 0.0, 0.1 * t) for t in times_s]))


def test_poses_are_put_into_holes_only_and_evenly():
    # Every 0.1 s, but nothing from 0.3 to 1.44 s: 1.14 s in 11 steps.
    filled = fill_holes(along_x([0.0, 0.1, 0.2, 0.3, 1.44, 1.54]), 1.0)
    times_s = (filled.stamps_ns - UNIX_NS) * 1e-9
    expected = [0, 0.1, 0.2, *np.linspace(0.3, 1.44, 12), 1.54]
    np.testing.assert_allclose(times_s, expected, atol=1e-8)
    np.testing.assert_allclose(filled.T, along_x(times_s).T, atol=1e-9)


def test_a_truth_that_is_sampled_seldom_has_no_holes():
    every_second = along_x(np.arange(20) * 1.0 + np.tile([0.0, 0.05], 10))
    assert len(find_holes(every_second, 0.5)) == 0
    assert fill_holes(every_second, 0.5) is every_second


def test_a_hole_from_a_wrong_stamp_is_refused_and_not_filled():
    with pytest.raises(
        TrajectoryError, match=r"no pose for 1000000 s after the stamp 1700000000\.200 s: is a stamp wrong"
    ):
        fill_holes(along_x([0.0, 0.1, 0.2, 1_000_000.2, 1_000_000.3]), 1.0)


def test_beyond_its_ends_a_trajectory_stays_where_it_is():
    trajectory = along_x([0.0, 0.1, 0.2])
    stamps_ns = trajectory.stamps_ns[[0, 2]] + np.array([-(10**9), 10**9])
    np.testing.assert_allclose(interpolate(trajectory, stamps_ns), trajectory.T[[0, 2]], atol=1e-12)
    one = Trajectory(trajectory.stamps_ns[:1], trajectory.T[:1])
    np.testing.assert_array_equal(interpolate(one, stamps_ns), trajectory.T[[0, 0]])
    with pytest.raises(TrajectoryError, match="with poses"):
        interpolate(Trajectory(stamps_ns[:0], trajectory.T[:0]), stamps_ns)


@pytest.mark.parametrize("times_s", [[], [0.0], [0.0, 1.0], [0.0, 0.1, 1.1]])
def test_without_a_hole_nothing_changes(times_s):
    trajectory = Trajectory(
        np.array([round(t * 1e9) for t in times_s], dtype=np.int64), np.tile(np.eye(4), (len(times_s), 1, 1))
    )
    assert fill_holes(trajectory, 1.0) is trajectory
