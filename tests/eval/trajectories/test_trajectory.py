import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories import Trajectory

I = np.eye(4)  # noqa: E741 - the usual name


def with_rotation(R):
    T = np.eye(4)
    T[:3, :3] = R
    return T


@pytest.mark.parametrize(
    ("stamps_ns", "T", "message"),
    [
        (np.array([0.0, 1.0]), np.tile(I, (2, 1, 1)), "int64 nanoseconds"),
        (np.array([[0, 1]]), np.tile(I, (1, 1, 1)), "shape"),
        (np.array([0, 1]), np.tile(I, (3, 1, 1)), r"got shape \(3, 4, 4\)"),
        (np.array([0, 1]), np.zeros((2, 7)), r"got shape \(2, 7\)"),
        (np.array([0, 1]), np.array([I, np.full((4, 4), np.nan)]), "pose 1"),
        (np.array([0, 5, 5]), np.tile(I, (3, 1, 1)), "5 ns at pose 2"),
        (np.array([7, 5]), np.tile(I, (2, 1, 1)), "5 ns at pose 1"),
        (np.array([2**62, -(2**62) - 1]), np.tile(I, (2, 1, 1)), "at pose 1"),
    ],
)
def test_a_malformed_trajectory_is_refused(stamps_ns, T, message):
    with pytest.raises(TrajectoryError, match=message):
        Trajectory(stamps_ns, T)


@pytest.mark.parametrize(
    "T",
    [
        with_rotation(np.diag([1.0, 1.0, -1.0])),
        with_rotation(np.diag([1.0, -1.0, 1.0])),
        with_rotation(1.00001 * np.eye(3)),
        with_rotation(np.zeros((3, 3))),
        with_rotation([[1, 1e-5, 0], [0, 1, 0], [0, 0, 1]]),
        with_rotation([[1, 0, 0], [0, 1, 0], [0, 1e-5, 1]]),
        with_rotation(1e300 * np.eye(3)),
        np.diag([1.0, 1.0, 1.0, 2.0]),
        np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [5, 0, 0, 1]]),
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_pose_that_is_not_rigid_is_refused(T):
    with pytest.raises(TrajectoryError, match="rigid transforms, got pose 2"):
        Trajectory(np.arange(4), np.array([I, I, T, I]))


def test_rotations_of_single_precision_are_rotations():
    half = np.sqrt(np.float32(0.5))
    T = with_rotation(np.array([[half, -half, 0], [half, half, 0], [0, 0, 1]], dtype=np.float32))
    assert len(Trajectory(np.array([0]), T[None])) == 1


def test_an_empty_trajectory_is_one():
    assert Trajectory(np.empty(0, np.int64), np.empty((0, 4, 4))).positions.shape == (0, 3)
