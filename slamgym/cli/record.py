"""`slamgym record`: one drive as a sequence of images, to be replayed as often as wanted."""

from dataclasses import dataclass

from slamgym.cli.drive import DriveCommand
from slamgym.cli.terminal import printing, results, say, told_warnings
from slamgym.recording import record_drive


@dataclass(kw_only=True)
class Record(DriveCommand):
    """Drive one episode without a SLAM and keep its frames, in the layout of TUM RGB-D, for `slamgym replay`.

    Example: slamgym record --seed 7 --speed 0.4 --out out/drive7
    """

    def __call__(self) -> None:
        with told_warnings():
            episode = self.driven(
                "HomeRobot-v0",
                {},
                lambda env, agent, on_step: record_drive(env, agent, self.seed, self.out, on_step),
            )
        with printing():
            say(results, f"{len(episode.steps)} frames, {episode.summary['distance_m']:.1f} m: {self.out}")
