"""One loop drives one episode; everything else that needs an episode calls it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from slamgym.agents import Agent
from slamgym.env import HomeRobotEnv, Observation
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.types import BoolArray, FloatArray, IntArray, SlamRecord, Summary


class Step(NamedTuple):
    """One rendered frame of the drive: how the robot moved when it was taken."""

    stamp_ns: int
    T_world_cam: FloatArray
    speed_mps: float
    yaw_rate_radps: float
    progress_m: float
    collision: bool
    reward: float


@dataclass(frozen=True, slots=True, eq=False)
class Episode:
    """One drive and, with a SLAM in the loop, what became of it.

    config: all parameters with their values. steps: N + 1 for N calls of `env.step`. path_xy: planned path (P, 2).
    slam: None without a SLAM. summary: the content of `episode.json`. interrupted: ended by Ctrl-C, not by the drive.
    """

    config: dict[str, Any]
    seed: int
    steps: tuple[Step, ...]
    path_xy: FloatArray
    grid: OccupancyGrid
    slam: SlamRecord | None
    slam_log: str
    summary: Summary
    interrupted: bool = False

    @property
    def stamps_ns(self) -> IntArray:
        return np.array([step.stamp_ns for step in self.steps], dtype=np.int64)

    @property
    def T_world_cam(self) -> FloatArray:
        return np.array([step.T_world_cam for step in self.steps])

    @property
    def collisions(self) -> BoolArray:
        return np.array([step.collision for step in self.steps], dtype=np.bool_)


class EpisodeInterrupted(KeyboardInterrupt):
    """Ctrl-C in the middle of an episode; `episode` holds what was driven until then."""

    def __init__(self, episode: Episode) -> None:
        super().__init__()
        self.episode = episode


def run_episode(
    env: gym.Env[Observation, NDArray[np.float32]],
    agent: Agent,
    seed: int,
    on_step: Callable[[float, float], None] | None = None,
) -> Episode:
    """Drive one episode from `env.reset(seed)` to its end.

    env: `HomeRobot-v0` or `HomeRobotSLAM-v0`, in any wrappers. on_step: called after each step with the progress and
    the length of the path, metres. Raises EpisodeInterrupted on Ctrl-C, and what the environment raises.
    """
    obs, info = env.reset(seed=seed, options=getattr(agent, "reset_options", None))
    steps = [_step_of(info, 0.0)]
    done = interrupted = False
    try:
        while not done:
            obs, reward, terminated, truncated, info = env.step(agent.act(obs, info))
            done = terminated or truncated
            steps.append(_step_of(info, float(reward)))
            if on_step is not None:
                on_step(info["progress_m"], info["path_length_m"])
    except KeyboardInterrupt:
        interrupted = True
    episode = _episode(env, seed, tuple(steps), interrupted)
    if interrupted:
        raise EpisodeInterrupted(episode)
    return episode


def _step_of(info: dict[str, Any], reward: float) -> Step:
    return Step(
        info["stamp_ns"],
        info["T_world_cam"],
        info["speed_mps"],
        info["yaw_rate_radps"],
        info["progress_m"],
        info["collision"],
        reward,
    )


def _episode(
    env: gym.Env[Observation, NDArray[np.float32]], seed: int, steps: tuple[Step, ...], interrupted: bool
) -> Episode:
    robot = env.unwrapped
    assert isinstance(robot, HomeRobotEnv)
    with_slam = env.has_wrapper_attr("slam_record")
    summary = env.get_wrapper_attr("conclude")() if with_slam else robot.summarize_drive()
    limit = env.spec.max_episode_steps if env.spec is not None else None
    config = {"env_id": env.spec.id if env.spec is not None else None, **robot.params.model_dump()}
    if with_slam:
        config |= env.get_wrapper_attr("slam_params").model_dump()
    return Episode(
        config={**config, "seed": seed, "max_episode_steps": limit},
        seed=seed,
        steps=steps,
        path_xy=robot.path.xy,
        grid=robot.grid,
        slam=env.get_wrapper_attr("slam_record")() if with_slam else None,
        slam_log=env.get_wrapper_attr("slam_log")() if with_slam else "",
        summary={
            "seed": seed,
            **summary,
            "progress_m": steps[-1].progress_m,
            "path_length_m": robot.path.length_m,
            "collision_steps": sum(step.collision for step in steps),
            "return": sum(step.reward for step in steps),
            "interrupted": interrupted,
        },
        interrupted=interrupted,
    )
