"""`slamgym run`: one episode."""

from dataclasses import dataclass

import tyro

from slamgym.cli.drive import DriveCommand
from slamgym.cli.options import option_group
from slamgym.cli.terminal import notes, printing, results, say, show_table, told_warnings
from slamgym.params import SlamInLoopParams
from slamgym.report_table import episode_table, remarks
from slamgym.rollout import EpisodeInterrupted, run_episode
from slamgym.run_folder import write_run

SlamOptions = option_group(SlamInLoopParams)


@dataclass(kw_only=True)
class Run(DriveCommand):
    """Drive one episode with a SLAM in the loop and write a run folder.

    Example: slamgym run --seed 7 --speed 0.4 --out out/run7
    """

    slam: tyro.conf.OmitArgPrefixes[SlamOptions]

    def __call__(self) -> None:
        try:
            with told_warnings():
                episode = self.driven(
                    "HomeRobotSLAM-v0",
                    vars(self.slam),
                    lambda env, agent, on_step: run_episode(env, agent, self.seed, on_step),
                )
        except EpisodeInterrupted as interrupted:
            say(notes, f"interrupted; what was driven is in {write_run(interrupted.episode, self.out)}")
            raise
        folder = write_run(episode, self.out)
        with printing():
            show_table(episode_table([episode]))
            for line in remarks(episode.summary):
                say(results, line)
            say(results, f"run folder: {folder}")
