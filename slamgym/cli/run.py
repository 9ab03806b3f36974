"""`slamgym run`: one episode."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import gymnasium as gym
import tyro

from slamgym import MAX_EPISODE_STEPS
from slamgym.agents import AGENTS
from slamgym.cli.options import option_group
from slamgym.cli.terminal import metres_progress, notes, printing, results, say
from slamgym.errors import ConfigError, unknown_word
from slamgym.params import DriveParams, SlamParams
from slamgym.report_table import episode_table
from slamgym.rollout import EpisodeInterrupted, run_episode
from slamgym.run_folder import check_free, write_run

DriveOptions = option_group(DriveParams)
SlamOptions = option_group(SlamParams)


@dataclass(kw_only=True)
class Run:
    """Drive one episode with a SLAM in the loop and write a run folder.

    Example: slamgym run --seed 7 --speed 0.4 --out out/run7
    """

    out: Path
    """Run folder to make; it must not exist yet, or be empty."""
    drive: tyro.conf.OmitArgPrefixes[DriveOptions]
    slam: tyro.conf.OmitArgPrefixes[SlamOptions]
    seed: Annotated[int, tyro.conf.arg(help="picks the path; the scene picks the house")] = 0
    agent: Annotated[str, tyro.conf.arg(metavar="|".join(AGENTS), help="who drives")] = "follower"
    max_episode_steps: Annotated[int, tyro.conf.arg(help="frames after which the episode is cut off")] = (
        MAX_EPISODE_STEPS
    )

    def __call__(self) -> None:
        if self.agent not in AGENTS:
            raise ConfigError(unknown_word("agent", self.agent, AGENTS))
        if self.seed < 0 or self.max_episode_steps < 1:
            raise ConfigError(
                f"expected a seed of at least 0 and max_episode_steps of at least 1, got {self.seed} and "
                f"{self.max_episode_steps}"
            )
        keywords: Mapping[str, Any] = {**vars(self.drive), **vars(self.slam)}
        env = gym.make("HomeRobotSLAM-v0", max_episode_steps=self.max_episode_steps, **keywords)
        check_free(self.out)
        try:
            with metres_progress() as progress:
                task = progress.add_task("loading", total=None)
                episode = run_episode(
                    env,
                    AGENTS[self.agent](),
                    self.seed,
                    on_step=lambda done_m, path_m: progress.update(
                        task, description="driving", completed=done_m, total=path_m
                    ),
                )
        except EpisodeInterrupted as interrupted:
            say(notes, f"interrupted; what was driven is in {write_run(interrupted.episode, self.out)}")
            raise
        finally:
            env.close()
        folder = write_run(episode, self.out)
        with printing():
            results.print(episode_table([episode]))
            say(results, f"run folder: {folder}")
