import json
import math

import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.drive import distance_to_path, summarize_drive
from slamgym.geometry import mast_camera_pose


def driven(poses, seconds_a_frame=0.5):
    """Stamps and camera poses of a robot at (x, y, yaw)."""
    stamps_ns = np.arange(len(poses), dtype=np.int64) * int(seconds_a_frame * 1e9)
    return stamps_ns, np.array([mast_camera_pose(*pose, 1.2) for pose in poses]).reshape(-1, 4, 4)


PATH = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])


def test_a_drive_round_a_corner():
    poses = [
        (0, 0, 0),
        (0.5, 0, 0),
        (1, 0, 0),
        (1.5, 0, 0),
        (2, 0, 0),
        (2, 0, 1.0),
        (2, 0, np.pi / 2),
        (2, 0.1, np.pi / 2),
    ]
    summary = summarize_drive(*driven(poses), PATH, commanded_speed=1.0)
    assert summary["distance_m"] == pytest.approx(2.1)
    assert summary["duration_s"] == pytest.approx(3.5)
    assert summary["turning_deg"] == pytest.approx(90.0)
    assert summary["speed_median_mps"] == pytest.approx(1.0)
    assert summary["speed_p95_mps"] == pytest.approx(1.0)
    assert summary["speed_reached_share"] == pytest.approx(2.0 / 2.1)
    assert summary["speed_reached"] is True
    assert summary["path_deviation_max_m"] == pytest.approx(0.0, abs=1e-12)
    json.dumps(summary, allow_nan=False)


def test_a_speed_that_is_never_reached():
    poses = [(0.2 * i, 0, 0) for i in range(6)]
    summary = summarize_drive(*driven(poses), PATH, commanded_speed=1.0)
    assert (summary["speed_reached_share"], summary["speed_reached"]) == (0.0, False)


def test_turning_across_the_back_counts_the_short_way_and_both_ways_add_up():
    poses = [(0, 0, 3.0), (0, 0, -3.0), (0, 0, 3.0)]
    summary = summarize_drive(*driven(poses), PATH, commanded_speed=1.0)
    assert summary["turning_deg"] == pytest.approx(2 * np.rad2deg(2 * np.pi - 6.0))


def test_the_deviation_is_the_largest():
    summary = summarize_drive(*driven([(0, 0, 0), (1, 0.3, 0), (2.1, 0.5, 0)]), PATH, commanded_speed=1.0)
    assert summary["path_deviation_max_m"] == pytest.approx(0.3)


@pytest.mark.parametrize("poses", [[], [(1, 0, 0)], [(1, 0, 0), (1, 0, 0)]])
def test_a_drive_that_never_moved(poses):
    summary = summarize_drive(*driven(poses), PATH, commanded_speed=1.0)
    assert (summary["distance_m"], summary["turning_deg"], summary["path_deviation_max_m"]) == (0.0, 0.0, 0.0)
    assert math.isnan(summary["speed_reached_share"])
    assert summary["speed_reached"] is False


def test_distance_to_a_path_with_repeated_points_and_to_a_point():
    points = np.array([[0.0, 1.0], [3.0, 0.0], [-1.0, 0.0], [2.5, 3.0]])
    expected = [1.0, 1.0, 1.0, np.hypot(0.5, 1.0)]
    np.testing.assert_allclose(distance_to_path(points, np.repeat(PATH, 2, axis=0)), expected)
    np.testing.assert_allclose(distance_to_path(points, PATH[:1]), np.linalg.norm(points, axis=1))


def test_arrays_that_do_not_fit():
    stamps_ns, T = driven([(0, 0, 0), (1, 0, 0)])
    for path in (np.empty((0, 2)), np.zeros((3, 3))):
        with pytest.raises(TrajectoryError, match="a path"):
            summarize_drive(stamps_ns, T, path, 1.0)
    with pytest.raises(TrajectoryError, match="poses"):
        summarize_drive(stamps_ns[:1], T, PATH, 1.0)
