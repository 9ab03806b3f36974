import numpy as np
import pytest
from scipy.spatial import cKDTree

from slamgym.agents import AGENTS, PathFollower, Patrol
from slamgym.agents.path import Path, resample
from slamgym.agents.planner import plan_path

FPS = 30
INFO = {"action_scale": (0.2, 0.8), "stamp_ns": 0, "robot": (0.0, 0.0, 0.0), "progress_m": 0.0, "goal_m": 1.0}
SLAM = {"state": "ok", "tracked_points": 100, "fresh": True}


def deviation(path, frames):
    return cKDTree(resample(path.xy, 0.005)).query(frames[:, :2])[0]


def share_at_full_speed(frames, speed):
    step = np.linalg.norm(np.diff(frames[:, :2], axis=0), axis=1)
    return step[frames[1:, 2] >= 0.9 * speed].sum() / step.sum()


@pytest.mark.parametrize("speed", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("seed", range(3))
def test_it_stays_on_the_path_at_full_speed_and_reaches_its_end(flat, seed, speed, drive):
    path = plan_path(*flat(seed), 12.0, np.random.default_rng(seed))
    frames = drive(path, PathFollower(), speed)
    assert deviation(path, frames).max() < 0.10
    assert share_at_full_speed(frames, speed) > 0.85
    assert np.diff(frames[:, 3]).max() < 0.15


@pytest.mark.parametrize("speed", [0.2, 0.8])
def test_patrol_comes_back(flat, speed, drive):
    grid, free = flat(4)
    path = plan_path(grid, free, 10.0, np.random.default_rng(0), **Patrol.reset_options)
    frames = drive(path, Patrol(), speed)
    assert np.linalg.norm(frames[-1, :2] - frames[0, :2]) < 0.1
    assert deviation(path, frames).max() < 0.10


@pytest.mark.parametrize("speed", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("seed", range(4))
def test_it_turns_on_the_spot_where_the_path_leads_back(corridor, seed, speed, drive):
    path = plan_path(*corridor, 12.0, np.random.default_rng(seed))
    frames = drive(path, PathFollower(), speed)
    assert deviation(path, frames).max() < 0.10
    driven = np.linalg.norm(np.diff(frames[:, :2], axis=0), axis=1).sum()
    assert driven > 0.9 * path.length_m


def test_full_speed_on_straights_at_any_scale(drive):
    path = Path(resample(np.array([(0.0, 0.0), (6.0, 0.0)])))
    for speed in (0.2, 1.0):
        frames = drive(path, PathFollower(), speed)
        assert frames[-1, 2] == pytest.approx(speed)
        # As soon as the acceleration limit permits, to the end.
        assert len(frames) <= ((6.0 - 0.05) / speed + speed / 2 / 1.0) * FPS + 2


def test_another_ratio_of_speed_and_turn_rate(flat, drive):
    path = plan_path(*flat(1), 12.0, np.random.default_rng(3))
    frames = drive(path, PathFollower(), 0.4, turning_radius_m=0.15)
    assert deviation(path, frames).max() < 0.10


def test_a_robot_off_the_path_comes_back_to_it():
    straight = np.stack([0.2 * np.arange(1, 6), np.full(5, 0.3)], axis=1)
    forward, turn = PathFollower().act({"waypoints": straight}, INFO)
    assert turn > 0.5
    assert 0 < forward <= 1
    assert PathFollower().act({"waypoints": straight * (1, -1)}, INFO)[1] == -turn
    assert np.array_equal(PathFollower().act({"waypoints": straight * (-1, 1)}, INFO), [0, 1])


@pytest.mark.parametrize("seed", range(20))
def test_any_waypoints_give_a_valid_action(seed):
    rng = np.random.default_rng(seed)
    waypoints = np.cumsum(rng.normal(0, 0.15, (5, 2)), axis=0).astype(np.float32) * (seed % 4)
    for agent in AGENTS.values():
        action = agent().act({"waypoints": waypoints}, {**INFO, "slam": SLAM})
        assert action.dtype == np.float32
        assert action.shape == (2,)
        assert (np.abs(action) <= 1).all()
        assert np.isfinite(action).all()


def test_it_stops_at_the_end():
    assert np.array_equal(PathFollower().act({"waypoints": np.full((5, 2), 0.01)}, INFO), [0, 0])
