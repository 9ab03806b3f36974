"""What the commands that drive an episode have in common."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import gymnasium as gym
import tyro

from slamgym import MAX_EPISODE_STEPS
from slamgym.agents import AGENTS, Agent
from slamgym.cli.options import option_group
from slamgym.cli.terminal import light_progress, progress_bar
from slamgym.env import HomeRobotEnv
from slamgym.errors import ConfigError, unknown_word
from slamgym.files import check_free
from slamgym.params import DriveParams
from slamgym.rollout import Episode, RobotEnv
from slamgym.stage import load_stage

DriveOptions = option_group(DriveParams)

OnStep = Callable[[float, float], None]
Drive = Callable[[RobotEnv, Agent, OnStep], Episode]


@dataclass(kw_only=True)
class DriveCommand:
    """Options of the drive, and who drives it."""

    out: Path
    """Folder to make; it must not exist yet, or be empty."""
    drive: tyro.conf.OmitArgPrefixes[DriveOptions]
    seed: Annotated[int, tyro.conf.arg(help="picks the path; the scene picks the house")] = 0
    agent: Annotated[str, tyro.conf.arg(metavar="|".join(AGENTS), help="who drives")] = "follower"
    max_episode_steps: Annotated[int, tyro.conf.arg(help="frames after which the episode is cut off")] = (
        MAX_EPISODE_STEPS
    )

    def driven(self, env_id: str, keywords: Mapping[str, Any], run: Drive) -> Episode:
        """The episode that `run` makes of the environment, with a progress bar."""
        self._check()
        keywords = {"max_episode_steps": self.max_episode_steps, **vars(self.drive), **keywords}
        return driven(env_id, keywords, AGENTS[self.agent], self.out, run)

    def _check(self) -> None:
        if self.agent not in AGENTS:
            raise ConfigError(unknown_word("agent", self.agent, AGENTS))
        if self.seed < 0 or self.max_episode_steps < 1:
            raise ConfigError(
                f"expected a seed of at least 0 and max_episode_steps of at least 1, got {self.seed} and "
                f"{self.max_episode_steps}"
            )


def driven(env_id: str, keywords: Mapping[str, Any], agent: type[Agent], out: Path, run: Drive) -> Episode:
    """The episode that `run` makes of the environment of these keywords, for the folder `out`, with a progress bar."""
    env = gym.make(env_id, **keywords)
    robot = env.unwrapped
    assert isinstance(robot, HomeRobotEnv)
    check_free(out, "folder")
    try:
        with progress_bar("{task.completed:.1f} m") as progress:
            task = progress.add_task("loading", total=None)
            # Kept in memory: the reset finds it there.
            load_stage(robot.params, light_progress(progress, task))
            return run(
                env,
                agent(),
                lambda done_m, path_m: progress.update(task, description="driving", completed=done_m, total=path_m),
            )
    finally:
        env.close()
