from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slamgym.slam.answers import checked_points, checked_result, checked_trajectory
from slamgym.slam.session import SlamSession
from slamgym.types import SlamEvent, SlamTrajectory, TrackingState, TrackResult

GOOD = TrackResult(TrackingState.OK, np.eye(4), 0, 10)
FINAL = SlamTrajectory(np.array([1, 2]), np.tile(np.eye(4), (2, 1, 1)), np.array([0, 0]))
NAN = np.full((4, 4), np.nan)


def changed(answer: Any, **values: Any) -> Any:
    return replace(answer, **values)


def test_good_answers_pass():
    assert checked_result(GOOD).T_map_cam.tolist() == np.eye(4).tolist()
    assert checked_trajectory(FINAL).stamps_ns.tolist() == [1, 2]
    assert checked_trajectory(SlamTrajectory(np.array([]), np.array([]), np.array([]))).T_map_cam.shape == (0, 4, 4)


def test_numbers_become_what_they_stand_for():
    single = np.eye(4, dtype=np.float32)
    answer = changed(GOOD, state=1, T_map_cam=single, map_id=np.int32(2), tracked_points=np.float64(7.0), event="lost")
    plain = checked_result(answer)
    assert plain.state is TrackingState.OK
    assert plain.event is SlamEvent.LOST
    assert (plain.map_id, plain.tracked_points, plain.T_map_cam.dtype) == (2, 7, np.float64)


def test_rotations_in_single_precision_are_set_right():
    angle = 0.3
    R = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    T = np.eye(4, dtype=np.float32)
    T[:3, :3] = R * (1 + 1e-5)
    np.testing.assert_allclose(checked_result(changed(GOOD, T_map_cam=T)).T_map_cam[:3, :3], R, atol=1e-7)


def test_pose_of_a_frame_that_is_not_tracked_is_dropped():
    lost = checked_result(changed(GOOD, state=TrackingState.LOST))
    assert np.isnan(lost.T_map_cam).all()
    assert lost.map_id == -1


@pytest.mark.parametrize(
    "bad",
    [
        None,
        changed(GOOD, T_map_cam=NAN),
        changed(GOOD, T_map_cam=None),
        changed(GOOD, T_map_cam=np.eye(4)[:3]),
        changed(GOOD, T_map_cam=np.zeros((4, 4))),
        changed(GOOD, T_map_cam=2 * np.eye(4)),
        changed(GOOD, map_id=-1),
        changed(GOOD, state=7),
        changed(GOOD, event="dizzy"),
        changed(GOOD, tracked_points=None),
        changed(GOOD, tracked_points=np.nan),
    ],
)
def test_bad_result(bad):
    with pytest.raises((TypeError, ValueError)):
        checked_result(bad)


@pytest.mark.parametrize(
    "bad",
    [
        None,
        changed(FINAL, stamps_ns=np.array([2, 1])),
        changed(FINAL, stamps_ns=np.array([1, 1])),
        changed(FINAL, stamps_ns=np.array([0.1, 0.2])),
        changed(FINAL, stamps_ns=np.array([[1, 2]])),
        changed(FINAL, map_id=np.array([0])),
        changed(FINAL, T_map_cam=np.eye(4)[None]),
        changed(FINAL, T_map_cam=np.array([np.eye(4), NAN])),
        changed(FINAL, T_map_cam=np.zeros((2, 4, 4))),
    ],
)
def test_bad_trajectory(bad):
    with pytest.raises((TypeError, ValueError)):
        checked_trajectory(bad)


@pytest.mark.parametrize(
    ("backend", "why"),
    [("AnswersNanPoses", "finite rigid transforms"), ("FinishesWithNanPoses", "finite rigid transforms")],
)
def test_slam_that_calls_nothing_a_pose_is_a_crash(faulty, config, frame, backend, why):
    with SlamSession(faulty(backend), config) as session:
        for k in range(3):
            session.track(frame(k))
        session.finish()
        assert session.outcome == "crashed"
        assert why in session.failure


def test_points_of_the_map_are_finite():
    points = [[1, 2, 3], [np.nan, 0, 0], [4, 5, 6]]
    assert checked_points(points).tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    assert checked_points(np.empty((0, 3), np.float32)).shape == (0, 3)
    with pytest.raises(ValueError, match=r"array \(N, 3\), got shape \(3,\)"):
        checked_points([1, 2, 3])
