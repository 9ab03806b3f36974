"""A drive that is rendered once and kept on the disk, so that any number of SLAM runs can be fed with it."""

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from slamgym.agents import Agent
from slamgym.env import HomeRobotEnv, Info, Observation
from slamgym.errors import ConfigError
from slamgym.eval.datasets import Sequence, SequenceWriter, read_sequence
from slamgym.rollout import Episode, RobotEnv, run_episode
from slamgym.types import Frame


def record_drive(
    env: RobotEnv,
    agent: Agent,
    seed: int,
    folder: Path,
    on_step: Callable[[float, float], None] | None = None,
) -> Episode:
    """Drive one episode as `run_episode` does, and write its frames to `folder` in the layout of TUM RGB-D.

    `slamgym.eval.datasets.read_sequence` reads it, `slamgym.replay.replay` feeds it to a SLAM. An episode that is
    interrupted leaves no sequence. Raises OutputError when the folder exists and is not empty or cannot be written, and
    what `run_episode` raises.
    """
    robot = env.unwrapped
    if not isinstance(robot, HomeRobotEnv):
        raise ConfigError(f"recording: expected a HomeRobot environment, got {env}")
    with SequenceWriter(folder, robot.params.camera, robot.params.fps) as writer:
        return run_episode(_FrameTap(env, writer.add), agent, seed, on_step)


@contextmanager
def recorded_drive(agent: Agent, seed: int, **params: Any) -> Iterator[Sequence]:
    """The frames of one drive, rendered once, on the disk as long as the block lasts.

    params: keywords of `gym.make("HomeRobot-v0", ...)`. Raises what `record_drive` raises.
    """
    with tempfile.TemporaryDirectory(prefix="slamgym-drive-") as folder:
        env = gym.make("HomeRobot-v0", **params)
        try:
            record_drive(env, agent, seed, Path(folder))
        finally:
            env.close()
        yield read_sequence(Path(folder))


class _FrameTap(gym.Wrapper[Observation, NDArray[np.float32], Observation, NDArray[np.float32]]):
    """Hands every frame on."""

    def __init__(self, env: RobotEnv, on_frame: Callable[[Frame], None]) -> None:
        super().__init__(env)
        self._on_frame = on_frame

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        obs, info = self.env.reset(seed=seed, options=options)
        self._tell(obs, info)
        return obs, info

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, Info]:
        obs, reward, terminated, truncated, info = self.env.step(action)
        self._tell(obs, info)
        return obs, float(reward), terminated, truncated, info

    def _tell(self, obs: Observation, info: Info) -> None:
        # Copies: the frame is written while the agent may already do with its observation what it likes.
        self._on_frame(Frame(info["stamp_ns"], obs["rgb"].copy(), obs["depth"].copy(), info["T_world_cam"]))
