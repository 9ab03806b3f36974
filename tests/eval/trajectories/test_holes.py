import numpy as np
import pytest

from slamgym.eval.trajectories import Trajectory, fill_holes
from slamgym.geometry import planar_pose

UNIX_NS = 1_700_000_000_000_000_000


def along_x(times_s):
    """1 m/s along x, turning 0.1 rad/s."""
    stamps_ns = np.array([round(t * 1e9) for t in times_s], dtype=np.int64) + UNIX_NS
    return Trajectory(stamps_ns, np.array([planar_pose(t, 0.0, 0.1 * t) for t in times_s]))


def test_poses_are_put_into_holes_only():
    # Every 0.1 s, but nothing from 0.3 to 1.45 s.
    filled = fill_holes(along_x([0.0, 0.1, 0.2, 0.3, 1.45, 1.55]), 1.0)
    times_s = (filled.stamps_ns - UNIX_NS) * 1e-9
    np.testing.assert_allclose(times_s, [0, 0.1, 0.2, *np.arange(0.3, 1.45, 0.1), 1.45, 1.55], atol=1e-9)
    np.testing.assert_allclose(filled.T, along_x(times_s).T, atol=1e-9)


@pytest.mark.parametrize("times_s", [[], [0.0], [0.0, 1.0], [0.0, 0.1, 1.1]])
def test_without_a_hole_nothing_changes(times_s):
    trajectory = Trajectory(
        np.array([round(t * 1e9) for t in times_s], dtype=np.int64), np.tile(np.eye(4), (len(times_s), 1, 1))
    )
    assert fill_holes(trajectory, 1.0) is trajectory
