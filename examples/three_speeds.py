"""Drive one path at three speeds with ORB-SLAM3 in the loop; print one table and write a run folder for each."""

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
    speeds: tuple[float, ...] = (0.2, 0.8, 1.6),
    seed: int = 7,
    scene: str = "procedural",
    path_length_m: float = 10.0,
    out: Path = Path("out") / f"three_speeds-{datetime.now():%Y%m%d-%H%M%S}",
) -> None:
    """Drive the path that `seed` picks in `scene` at each of `speeds` (m/s)."""
    console = Console()
    check_free(out)
    episodes: list[Episode] = []
    try:
        for speed in speeds:
            env = gym.make("HomeRobotSLAM-v0", scene=scene, speed=speed, path_length_m=path_length_m)
            with console.status(f"driving {path_length_m:g} m at {speed:g} m/s"):
                try:
                    episodes.append(run_episode(env, PathFollower(), seed))
                finally:
                    env.close()
            folder = write_run(episodes[-1], out / f"speed_{speed:g}")
            console.print(f"{speed:g} m/s: {episodes[-1].summary['status']}, see {folder / 'map.png'}", soft_wrap=True)
    except KeyboardInterrupt:
        console.print("interrupted; the finished drives are kept")
    console.print(episode_table(episodes))


if __name__ == "__main__":
    tyro.cli(main)
