"""One loop drives one episode; everything else that needs an episode calls it."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from slamgym.agents import Agent
from slamgym.env import END_REACHED_M, HomeRobotEnv, Observation
from slamgym.eval.trajectories import Trajectory
from slamgym.interrupt import deferred_interrupt
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.types import FloatArray, SlamRecord, Summary

RobotEnv = gym.Env[Observation, NDArray[np.float32]]


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

    config: all parameters with their values, and the versions that the results depend on. steps: N + 1 for N calls of
    `env.step`. path_xy: planned path (P, 2). slam: None without a SLAM. summary: the content of `episode.json`, in it
    `end`: "path_driven", "truncated" (at `max_episode_steps`), "slam_gone", or "interrupted" (Ctrl-C).
    """

    config: dict[str, Any]
    seed: int
    steps: tuple[Step, ...]
    path_xy: FloatArray
    grid: OccupancyGrid
    slam: SlamRecord | None
    slam_log: str
    summary: Summary

    @property
    def truth(self) -> Trajectory:
        """True poses of the camera's optical frame at every rendered frame."""
        stamps_ns = np.array([step.stamp_ns for step in self.steps], dtype=np.int64)
        return Trajectory(stamps_ns, np.array([step.T_world_cam for step in self.steps]))

    def motion(self) -> dict[str, Any]:
        """How the robot moved, columns with a row a rendered frame."""
        position = self.truth.positions
        return {
            "stamp_ns": self.truth.stamps_ns,
            "x_m": position[:, 0],
            "y_m": position[:, 1],
            "speed_mps": [step.speed_mps for step in self.steps],
            "yaw_rate_radps": [step.yaw_rate_radps for step in self.steps],
            "progress_m": [step.progress_m for step in self.steps],
            "collision": [step.collision for step in self.steps],
        }


class EpisodeInterrupted(KeyboardInterrupt):
    """Ctrl-C during an episode; `episode` holds what was driven until then, all of it if it came with the last step."""

    def __init__(self, episode: Episode) -> None:
        super().__init__()
        self.episode = episode


def run_episode(
    env: RobotEnv,
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
    end = ""
    with deferred_interrupt() as interrupted:
        try:
            while not end:
                obs, reward, terminated, truncated, info = env.step(agent.act(obs, info))
                steps.append(_step_of(info, float(reward)))
                end = _end(terminated, truncated, interrupted())
                if on_step is not None:
                    on_step(info["progress_m"], info["path_length_m"])
        except KeyboardInterrupt:  # a second Ctrl-C, or one that the agent raised
            end = "interrupted"
        episode = _episode(env, agent, seed, tuple(steps), end)
    if interrupted() or end == "interrupted":
        raise EpisodeInterrupted(episode)
    return episode


def _end(terminated: bool, truncated: bool, interrupted: bool) -> str:
    """What ended the drive with this step: "" when it goes on."""
    if terminated:
        return "path_driven"
    if truncated:
        return "truncated"
    return "interrupted" if interrupted else ""


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


def _episode(env: RobotEnv, agent: Agent, seed: int, steps: tuple[Step, ...], end: str) -> Episode:
    robot = env.unwrapped
    assert isinstance(robot, HomeRobotEnv)
    with_slam = env.has_wrapper_attr("slam_record")
    # Results first: they end the SLAM, and its log is whole then.
    summary = env.get_wrapper_attr("conclude")() if with_slam else robot.summarize_drive()
    if end == "path_driven" and steps[-1].progress_m < robot.path.length_m - END_REACHED_M:
        end = "slam_gone"
    timing = {"timing": env.get_wrapper_attr("slam_timing")()} if with_slam else {}
    return Episode(
        config=_config(env, robot, agent, seed),
        seed=seed,
        steps=steps,
        path_xy=robot.path.xy,
        grid=robot.grid,
        slam=env.get_wrapper_attr("slam_record")() if with_slam else None,
        slam_log=env.get_wrapper_attr("slam_log")() if with_slam else "",
        summary={
            "seed": seed,
            "end": end,
            **summary,
            "progress_m": steps[-1].progress_m,
            "planned_path_m": robot.path.length_m,
            "collision_steps": sum(step.collision for step in steps),
            "return": sum(step.reward for step in steps),
            **timing,
        },
    )


def _config(env: RobotEnv, robot: HomeRobotEnv, agent: Agent, seed: int) -> dict[str, Any]:
    """Keywords of `gym.make` at the top level, so that the drive can be repeated; all else below `run`."""
    slam = env.get_wrapper_attr("slam_config")() if env.has_wrapper_attr("slam_config") else {}
    versions = {"slamgym": version("slamgym"), **robot.stage.versions, **slam.pop("slam_versions", {})}
    return {
        "run": {
            "env_id": env.spec.id if env.spec is not None else None,
            "seed": seed,
            "agent": f"{type(agent).__module__}:{type(agent).__qualname__}",
            "reset_options": dict(getattr(agent, "reset_options", {})),
            "versions": versions,
        },
        "max_episode_steps": env.spec.max_episode_steps if env.spec is not None else None,
        "render_mode": robot.render_mode,
        **robot.params.recorded(),
        **slam,
    }
