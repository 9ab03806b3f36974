"""One picture of a drive: six views of the robot's camera, and the map with the true and the estimated path."""

from pathlib import Path
from tempfile import TemporaryDirectory

import cv2
import gymnasium as gym
import numpy as np
import tyro

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.eval.plots import plot_map
from slamgym.rollout import run_episode

VIEW_WIDTH, VIEW_HEIGHT = 320, 240


def main(
    out: Path = Path("drive.png"),
    scene: str = "procedural",
    seed: int = 7,
    speed: float = 0.4,
    path_length_m: float = 10.0,
) -> None:
    """Drive the path that `seed` picks in `scene` and write the picture."""
    env = gym.make("HomeRobotSLAM-v0", scene=scene, speed=speed, path_length_m=path_length_m, render_mode="rgb_array")
    views = []
    episode = run_episode(env, PathFollower(), seed, on_step=lambda *_: views.append(env.render()))
    env.close()
    chosen = np.linspace(0, len(views) - 1, 6).astype(int)
    small = [cv2.resize(views[i], (VIEW_WIDTH, VIEW_HEIGHT), interpolation=cv2.INTER_AREA) for i in chosen]
    sheet = cv2.cvtColor(np.vstack([np.hstack(small[:3]), np.hstack(small[3:])]), cv2.COLOR_RGB2BGR)
    with TemporaryDirectory() as folder:
        map_png = Path(folder) / "map.png"
        plot_map(map_png, episode.grid, episode.path_xy, episode.truth, episode.slam, episode.summary)
        top_view = np.asarray(cv2.imread(str(map_png)))
    height = round(top_view.shape[0] * sheet.shape[1] / top_view.shape[1])
    top_view = cv2.resize(top_view, (sheet.shape[1], height), interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(out), np.vstack([sheet, top_view]))
    print(f"{episode.summary['status']}: {out}")


if __name__ == "__main__":
    tyro.cli(main)
