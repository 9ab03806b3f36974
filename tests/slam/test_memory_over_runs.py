"""Memory of the user's process and of the SLAM's over many episodes of one environment."""

import os
import sys

import gymnasium as gym
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.slam.process_tree import resident_mb

LOOK_AFTER = (10, 50, 100)


@pytest.mark.slow
def test_100_episodes_in_one_process(capsys):
    env = gym.make("HomeRobotSLAM-v0", camera="small", speed=1.0, path_length_m=1.0)
    agent = PathFollower()
    parent_mb, worker_mb = {}, {}
    for number in range(1, LOOK_AFTER[-1] + 1):
        obs, info = env.reset(seed=number)
        done = False
        while not done:
            worker = resident_mb(env.get_wrapper_attr("slam_pid"))
            obs, _, terminated, truncated, info = env.step(agent.act(obs, info))
            done = terminated or truncated
        assert info["episode_slam"]["status"] in ("ok", "lost", "init_failed")
        if number in LOOK_AFTER:
            parent_mb[number] = resident_mb(os.getpid())
            worker_mb[number] = worker
    env.close()
    with capsys.disabled():
        sys.stdout.write(f"\nMB after {LOOK_AFTER} episodes: parent {parent_mb}, worker {worker_mb}\n")
    assert parent_mb[100] - parent_mb[10] < 30
    assert max(worker_mb.values()) < 1.3 * min(worker_mb.values())
