from pathlib import Path

import gymnasium as gym
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.rollout import run_episode
from slamgym.run_folder import write_run
from slamgym.scenes.registry import SCENES

HALL = {"scene": "hall", "camera": "small", "lighting": "flat", "speed": 1.0, "turn_rate": 2.0, "fps": 15}


@pytest.fixture(scope="session")
def hall():
    """The hall's name for a scene, and the picky SLAMs by "picky_backends:NAME", also in the workers."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(Path(__file__).parent))
        patch.setitem(SCENES, "hall", "hall:Hall")
        yield "hall"


def drive(slam, seed, folder, agent=None, **params):
    """A run folder of a live drive through the hall, 6 m long."""
    env = gym.make("HomeRobotSLAM-v0", slam=slam, **{**HALL, "path_length_m": 6.0, **params})
    try:
        return write_run(run_episode(env, agent or PathFollower(), seed), folder)
    finally:
        env.close()


@pytest.fixture(scope="session")
def dizzy_run(hall, tmp_path_factory):
    """A SLAM that cannot bear quick turns meets one in the light, after some 4.7 m."""
    return drive("picky_backends:Dizzy", 0, tmp_path_factory.mktemp("dizzy") / "run")


@pytest.fixture(scope="session")
def dark_run(hall, tmp_path_factory):
    """A SLAM that cannot bear the dark comes to see the hall's dark end, after some 1 m."""
    return drive("picky_backends:AfraidOfTheDark", 2, tmp_path_factory.mktemp("dark") / "run")
