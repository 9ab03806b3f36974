"""How fast may the robot drive? The same paths at several speeds, ORB-SLAM3 in the loop: one table, a folder a run."""

import sys
from datetime import datetime
from pathlib import Path
from typing import Any

import gymnasium as gym
import tyro
from rich.console import Console

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.errors import SlamgymError
from slamgym.files import check_free
from slamgym.report_table import episode_table
from slamgym.rollout import Episode, EpisodeInterrupted, run_episode
from slamgym.run_folder import write_run

console = Console()


def main(
    seeds: tuple[int, ...] = (7,),
    speeds: tuple[float, ...] = (0.2, 0.8, 1.6),
    scene: str = "procedural",
    path_length_m: float = 10.0,
    out: Path | None = None,
) -> None:
    """Drive the path that each of `seeds` picks in `scene` at each of `speeds` (m/s). out: a new folder."""
    out = out or Path("out") / f"speed_sweep-{datetime.now():%Y%m%d-%H%M%S}"
    check_free(out, "folder")
    episodes: list[Episode] = []
    try:
        for speed in speeds:
            drive(episodes, seeds, speed, out, scene=scene, path_length_m=path_length_m)
    except KeyboardInterrupt as interrupted:
        if isinstance(interrupted, EpisodeInterrupted):
            write_run(interrupted.episode, out / "last")
        sys.exit("interrupted")
    finally:
        if episodes:
            console.print(episode_table(episodes))


def drive(episodes: list[Episode], seeds: tuple[int, ...], speed: float, out: Path, **params: Any) -> None:
    """Add one episode for each path."""
    env = gym.make("HomeRobotSLAM-v0", speed=speed, **params)
    try:
        for seed in seeds:
            with console.status(f"path {seed} at {speed:g} m/s"):
                episodes.append(run_episode(env, PathFollower(), seed))
            folder = write_run(episodes[-1], out / f"path_{seed}" / f"speed_{speed:g}")
            console.print(f"{speed:g} m/s: {episodes[-1].summary['status']}, {folder / 'map.png'}", soft_wrap=True)
    finally:
        env.close()


if __name__ == "__main__":
    try:
        tyro.cli(main)
    except SlamgymError as error:
        sys.exit(f"speed_sweep: {error}")
