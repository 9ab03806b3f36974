"""`slamgym run`: one episode."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from slamgym.cli.drive import DriveCommand, driven
from slamgym.cli.live import RerunOption, Show, shown
from slamgym.cli.options import option_group
from slamgym.cli.terminal import notes, printing, results, say, show_table, told_warnings
from slamgym.params import SlamInLoopParams
from slamgym.report_table import episode_table, remarks
from slamgym.rollout import Episode, EpisodeInterrupted, run_episode
from slamgym.run_folder import write_run
from slamgym.study.busy import busy
from slamgym.study.recorded_run import RecordedRun, changed_versions, read_recorded_run

SlamOptions = option_group(SlamInLoopParams)


@dataclass(kw_only=True)
class Run(DriveCommand):
    """Drive one episode with a SLAM in the loop and write a run folder.

    Example: slamgym run --seed 7 --speed 0.4 --out out/run7

    Again, from its folder or one of a study: slamgym run --like out/run7 --out out/again
    """

    slam: tyro.conf.OmitArgPrefixes[SlamOptions]
    like: Annotated[
        Path | None,
        tyro.conf.arg(metavar="RUN_FOLDER", help="repeat the run of this folder, by this command or of a study"),
    ] = None
    rerun: RerunOption = None

    def __call__(self) -> None:
        with shown(self.rerun) as show:
            self._run(show)

    def _run(self, show: Show) -> None:
        like = None if self.like is None else read_recorded_run(self.like)
        try:
            with told_warnings():
                episode = self._driven(show) if like is None else self._repeated(like, show)
        except EpisodeInterrupted as interrupted:
            say(notes, f"interrupted; what was driven is in {write_run(interrupted.episode, self.out)}")
            raise
        folder = write_run(episode, self.out)
        with printing():
            show_table(episode_table([episode]))
            for line in remarks(episode.summary):
                say(results, line)
            if like is not None:
                for line in changed_versions(like.versions, episode.config["run"]["versions"]):
                    say(results, f"not as it was recorded: {line}")
            say(results, f"run folder: {folder}")

    def _driven(self, show: Show) -> Episode:
        return self.driven(
            "HomeRobotSLAM-v0",
            vars(self.slam),
            lambda env, agent, on_step: run_episode(show(env), agent, self.seed, on_step),
        )

    def _repeated(self, like: RecordedRun, show: Show) -> Episode:
        with busy(like.busy_processes):
            return driven(
                "HomeRobotSLAM-v0",
                like.keywords,
                like.agent,
                self.out,
                lambda env, agent, on_step: run_episode(show(env), agent, like.seed, on_step),
            )
