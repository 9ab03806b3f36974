"""How fast may the robot drive? The same paths at several speeds, ORB-SLAM3 in the loop: one table, a folder a run."""

from datetime import datetime
from pathlib import Path

import gymnasium as gym
import tyro
from rich.console import Console

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.report_table import episode_table
from slamgym.rollout import Episode, run_episode
from slamgym.run_folder import check_free, write_run


def main(
    seeds: tuple[int, ...] = (7,),
    speeds: tuple[float, ...] = (0.2, 0.8, 1.6),
    scene: str = "procedural",
    path_length_m: float = 10.0,
    out: Path | None = None,
) -> None:
    """Drive the path that each of `seeds` picks in `scene` at each of `speeds` (m/s). out: a new folder."""
    console = Console()
    out = out or Path("out") / f"speed_sweep-{datetime.now():%Y%m%d-%H%M%S}"
    check_free(out)
    episodes: list[Episode] = []
    try:
        for speed in speeds:
            env = gym.make("HomeRobotSLAM-v0", scene=scene, speed=speed, path_length_m=path_length_m)
            try:
                for seed in seeds:
                    with console.status(f"path {seed}: driving {path_length_m:g} m at {speed:g} m/s"):
                        episode = run_episode(env, PathFollower(), seed)
                    folder = write_run(episode, out / f"path_{seed}" / f"speed_{speed:g}")
                    console.print(f"{speed:g} m/s: {episode.summary['status']}, {folder / 'map.png'}", soft_wrap=True)
                    episodes.append(episode)
            finally:
                env.close()
    except KeyboardInterrupt:
        console.print("interrupted; the finished drives are kept")
    console.print(episode_table(episodes))


if __name__ == "__main__":
    tyro.cli(main)
