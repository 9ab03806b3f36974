import numpy as np
import pytest

from slamgym.eval import doubts
from slamgym.eval.trajectories import Trajectory
from slamgym.geometry import planar_pose


def along_x(times_s):
    stamps_ns = np.array([round(t * 1e9) for t in times_s], dtype=np.int64)
    return Trajectory(stamps_ns, np.array([planar_pose(t, 0.0, 0.1 * t) for t in times_s]).reshape(-1, 4, 4))


TRUTH = along_x(np.arange(1.0, 9.0, 0.1))
EMPTY = along_x([])


def test_swapped_files():
    denser = along_x(np.arange(0.5, 9.5, 0.03))
    assert "swapped" in doubts.of_the_order(TRUTH, denser)[0]
    assert doubts.of_the_order(denser, TRUTH) == []
    assert doubts.of_the_order(TRUTH, along_x(np.arange(1.0, 9.0, 0.03))) == []
    assert doubts.of_the_order(TRUTH, EMPTY) == []


def test_repeated_poses():
    stuck = Trajectory(TRUTH.stamps_ns, np.concatenate([TRUTH.T[:77], TRUTH.T[[77, 77, 77]]]))
    assert doubts.of_repeated_poses(stuck)[0].startswith("2 poses repeat")
    assert doubts.of_repeated_poses(TRUTH) == doubts.of_repeated_poses(EMPTY) == []


@pytest.mark.parametrize(("degrees", "doubted"), [(0.0, False), (30.0, False), (31.0, True), (np.nan, False)])
def test_orientations_of_another_body(degrees, doubted):
    assert [f"off by {degrees:.0f} degrees" in said for said in doubts.of_orientations(degrees)] == [True] * doubted


def test_stamps_of_another_list():
    assert "13 ms from the frames" in doubts.of_stamps(TRUTH.stamps_ns, TRUTH.stamps_ns - 13_000_000)[0]
    assert doubts.of_stamps(TRUTH.stamps_ns, TRUTH.stamps_ns + 900_000) == []
    assert doubts.of_stamps(EMPTY.stamps_ns, EMPTY.stamps_ns) == []


def test_a_truth_that_lasts_longer():
    (said,) = doubts.of_the_ends(TRUTH, along_x(np.arange(2.5, 8.75, 0.1)), 1.0)
    assert "begins 1.5 s before the first pose, and ends 0.2 s after the last" in said
    assert doubts.of_the_ends(TRUTH, along_x(np.arange(1.5, 8.5, 0.1)), 1.0) == []
    assert doubts.of_the_ends(TRUTH, EMPTY, 1.0) == []
