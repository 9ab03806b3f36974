"""Agents that take more from `info` than the path: the real robot, a real house and the real ORB-SLAM3 with them."""

import gymnasium as gym
import numpy as np
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import Cautious, LookAround
from slamgym.camera import PinholeCamera
from slamgym.errors import ConfigError
from slamgym.rollout import run_episode

TINY = PinholeCamera(64, 48, 46.0, 46.0, 31.5, 23.5)
DRIVE = {"scene": "procedural:1", "lighting": "flat"}


def test_look_around_turns_once_at_each_goal_and_in_each_episode():
    env = gym.make("HomeRobot-v0", **DRIVE, camera=TINY, speed=1.6, path_length_m=10.0)
    agent = LookAround()
    goals = []
    for seed in (0, 1):
        episode, path = run_episode(env, agent, seed), env.unwrapped.path
        assert episode.summary["end"] == "path_driven"
        assert episode.summary["collision_steps"] == 0
        goals.append(np.count_nonzero(path.goals_m < 9.9))
        along = np.unwrap([path.heading_at(s) for s in path.arc_m[:-1]])
        turned_rad = sum(step.yaw_rate_radps for step in episode.steps) / 30
        assert np.degrees(turned_rad - (along[-1] - along[0])) == pytest.approx(360 * goals[-1], abs=40)
    assert sum(goals) > 0
    env.close()


@pytest.mark.parametrize(("brightness", "median_mps"), [(1.0, 0.5), (0.01, 0.1)])
def test_cautious_drives_as_the_slam_tracks(brightness, median_mps):
    """In the dark ORB-SLAM3 never starts, so it creeps at a fifth of its speed."""
    env = gym.make("HomeRobotSLAM-v0", **DRIVE, speed=0.5, brightness=brightness, max_episode_steps=40)
    episode = run_episode(env, Cautious(), seed=2)
    env.close()
    assert np.median([step.speed_mps for step in episode.steps[10:]]) == pytest.approx(median_mps, rel=0.1)


def test_cautious_is_told_that_it_needs_a_slam():
    env = gym.make("HomeRobot-v0", **DRIVE, camera=TINY)
    with pytest.raises(ConfigError, match="'cautious': expected a SLAM in the loop"):
        run_episode(env, Cautious(), seed=0)
    env.close()
