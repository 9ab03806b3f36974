"""The real ORB-SLAM3 gets lost where only every sixth frame is left of a drive through a furnished home."""

import gymnasium as gym
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.explain.cases import cases_of
from slamgym.explain.experiment import run_case
from slamgym.explain.source import read_run
from slamgym.explain.verdict import Count
from slamgym.rollout import run_episode
from slamgym.run_folder import write_run

PARAMS = {"scene": "procedural:8", "speed": 1.4, "turn_rate": 6.0, "depth_noise": "icl_nuim", "path_length_m": 12.0}


@pytest.mark.slow
def test_the_frames_left_out_are_to_blame(tmp_path):
    env = gym.make("HomeRobotSLAM-v0", stride=5, **PARAMS)
    run = read_run(write_run(run_episode(env, PathFollower(), 8), tmp_path / "run"))
    env.close()
    case = next(case for case in cases_of(run, 3.0, 1.5) if 4.5 < case.loss.progress_m < 6.5)
    result = run_case(case, tmp_path / "loss", repeats=3, workers=2, on_step=lambda _: None)
    assert result.judgement.control_count == Count(9, 9)
    assert "every frame" in [one.name for one in result.cures]
    assert "more light" not in [one.name for one in result.cures]
    assert result.verdict == "explained"
