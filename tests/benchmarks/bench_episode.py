"""What the harness costs: an environment step against a bare loop of the same renderer and the ORB-SLAM3 wheel.

Both loops see the same poses in the same run; medians over the frames, so that a busy moment of the machine does not
count. Run by `make bench`.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import gymnasium as gym
import pyorbslam3
from rich.console import Console
from rich.table import Table

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.params import DriveParams
from slamgym.render import Renderer
from slamgym.rollout import run_episode
from slamgym.slam.backend import SlamConfig
from slamgym.slam.orb_settings import OrbOptions, settings
from slamgym.slam.vocabulary import vocabulary_path
from slamgym.stage import load_stage

SEED = 7
PARAMS: dict[str, Any] = {"speed": 0.4, "path_length_m": 6.0}
WARM_UP = 30
"""Frames left out of the medians: initialisation and first use."""


def timed(action: Callable[..., Any], *arguments: Any) -> tuple[Any, float]:
    """The result and the milliseconds that it took."""
    begin = time.perf_counter()
    result = action(*arguments)
    return result, (time.perf_counter() - begin) * 1e3


def drive(slam_sync: str) -> dict[str, Any]:
    """Milliseconds of each step and of a warm reset, and the poses that were driven."""
    env = gym.make("HomeRobotSLAM-v0", slam_sync=slam_sync, **PARAMS)
    agent = PathFollower()
    (obs, info), cold_ms = timed(lambda: env.reset(seed=SEED))
    poses, steps_ms, done = [info["T_world_cam"]], [], False
    while not done:
        action = agent.act(obs, info)
        (obs, _, terminated, truncated, info), ms = timed(env.step, action)
        done = terminated or truncated
        poses.append(info["T_world_cam"])
        steps_ms.append(ms)
    # The last step ends the SLAM and evaluates the episode.
    _, warm_ms = timed(lambda: env.reset(seed=SEED + 1))
    env.close()
    return {"step": median(steps_ms[WARM_UP:-1]), "cold reset": cold_ms, "warm reset": warm_ms, "poses": poses}


def bare_loop(poses: list[Any]) -> tuple[float, float]:
    """Median milliseconds of rendering and of `track_rgbd`, without anything of slamgym around the wheel."""
    params = DriveParams(**PARAMS)
    house = load_stage(params).house
    slam = bare_slam(params)
    render_ms, track_ms = [], []
    with Renderer(house, params.camera) as renderer:
        for index, T_world_cam in enumerate(poses):
            (rgb, depth), ms = timed(renderer.render, T_world_cam)
            render_ms.append(ms)
            track_ms.append(timed(slam.track_rgbd, rgb, depth, index / params.fps)[1])
    slam.shutdown()
    return median(render_ms[WARM_UP:]), median(track_ms[WARM_UP:])


def bare_slam(params: DriveParams) -> Any:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "settings.yaml"
        path.write_text(settings(SlamConfig(params.camera, params.fps), OrbOptions()))
        return pyorbslam3.Slam(vocabulary_path(None), path, pyorbslam3.Sensor.RGBD)


def main() -> None:
    run_episode_warm_up()
    free, lockstep = drive("free"), drive("lockstep")
    render_ms, track_ms = bare_loop(free["poses"])
    table = Table("what", "value", title="harness, 640x480, ORB-SLAM3 in the loop")
    rows = {
        "render a frame": f"{render_ms:.1f} ms",
        "raw track_rgbd": f"{track_ms:.1f} ms",
        "env step, free": f"{free['step']:.1f} ms",
        "env step, lockstep": f"{lockstep['step']:.1f} ms",
        "step in free / (render + raw track)": f"{free['step'] / (render_ms + track_ms):.2f}  (aim: at most 1.10)",
        "reset of a warm env": f"{max(free['warm reset'], lockstep['warm reset']):.0f} ms  (aim: below 500)",
        "first reset": f"{free['cold reset']:.0f} ms",
    }
    for name, value in rows.items():
        table.add_row(name, value)
    Console().print(table)


def run_episode_warm_up() -> None:
    """Load the house and its libraries once, outside of what is measured."""
    env = gym.make("HomeRobot-v0", max_episode_steps=5, **PARAMS)
    run_episode(env, PathFollower(), SEED)
    env.close()


if __name__ == "__main__":
    main()
