"""How much does a result change from run to run? One drive, rendered once, is fed to ORB-SLAM3 again and again."""

import multiprocessing
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import gymnasium as gym
import numpy as np
import pandas as pd
import tyro

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.camera import resolve_camera
from slamgym.eval.episode import summarize_slam
from slamgym.eval.robustness import average
from slamgym.slam.backend import SlamConfig
from slamgym.slam.record import run_sequence
from slamgym.slam.session import SlamSession, Sync
from slamgym.types import Frame


def main(
    speed: float = 1.2,
    seed: int = 7,
    scene: str = "procedural",
    path_length_m: float = 8.0,
    camera: str = "default",
    repeats: int = 6,
    busy_loops: int = 8,
    syncs: tuple[Sync, ...] = ("lockstep", "free"),
) -> None:
    """Feed the frames of one drive `repeats` times to each sync mode, on an idle machine and beside `busy_loops`."""
    frames = drive(scene=scene, speed=speed, path_length_m=path_length_m, camera=camera, seed=seed)
    config = SlamConfig(resolve_camera(camera), fps=30.0)
    rows = []
    for sync in syncs:
        for loops in (0, busy_loops):
            with busy(loops):
                rows += [{"sync": sync, "busy loops": loops, **run(config, sync, frames)} for _ in range(repeats)]
    table = pd.DataFrame(rows)
    print(f"{len(frames)} frames at {speed:g} m/s")
    print(table.to_string(index=False))
    for condition, runs in table.groupby(["sync", "busy loops"], sort=False):
        ate = runs["ATE m"].to_numpy()
        # A failed run is worse than any other: the median counts it as infinite instead of leaving it out.
        typical = average(ate, ~runs["success"].to_numpy(), "penalise", penalty=np.inf)
        print(f"{condition}: ATE m {typical}; from {np.nanmin(ate):.3g} to {np.nanmax(ate):.3g}")


def drive(seed: int, **params: Any) -> list[Frame]:
    """All frames of one drive, rendered once."""
    env = gym.make("HomeRobot-v0", **params)
    agent = PathFollower()
    obs, info = env.reset(seed=seed)
    frames = [Frame(info["stamp_ns"], obs["rgb"], obs["depth"], info["T_world_cam"])]
    done = False
    while not done:
        obs, _, terminated, truncated, info = env.step(agent.act(obs, info))
        frames.append(Frame(info["stamp_ns"], obs["rgb"], obs["depth"], info["T_world_cam"]))
        done = terminated or truncated
    env.close()
    return frames


def run(config: SlamConfig, sync: Sync, frames: list[Frame]) -> dict[str, Any]:
    """One row of the table."""
    with SlamSession("orbslam3", config, sync) as session:
        summary = summarize_slam(run_sequence(session, frames))
    return {
        "status": summary["status"],
        "success": summary["success"],
        "ATE m": summary["ate_rmse_m"],
        "completion": summary["completion"],
        "losses": summary["loss_count"],
    }


@contextmanager
def busy(loops: int) -> Iterator[None]:
    """So many processes that do nothing but keep the processor busy."""
    processes = [multiprocessing.Process(target=spin, daemon=True) for _ in range(loops)]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


def spin() -> None:
    while True:
        pass


if __name__ == "__main__":
    tyro.cli(main)
