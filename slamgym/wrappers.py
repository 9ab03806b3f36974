"""`SlamWrapper` feeds an environment's frames to a SLAM, step by step, and reports what became of it."""

import tempfile
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from slamgym.env import HomeRobotEnv, Info, Observation
from slamgym.errors import ConfigError
from slamgym.eval.episode import summarize_slam
from slamgym.params import SlamParams
from slamgym.slam.backend import SlamConfig, check_config
from slamgym.slam.record import Fed, feed, finish
from slamgym.slam.session import SlamSession
from slamgym.types import Frame, SlamEvent, SlamRecord, Summary, TrackingState

LOG_LINES = 100_000


class SlamWrapper(
    gym.Wrapper[Observation, NDArray[np.float32], Observation, NDArray[np.float32]], RecordConstructorArgs
):
    """Every (stride + 1)-th frame goes to the SLAM, with its true stamp, before `step` returns.

    Without keywords the parameters are those that `gym.make` was given; else they are the fields of `SlamParams`.

    Adds `slam_state` (the TrackingState) to the observation and `info["slam"]`: `state`, `T_map_cam` (4, 4) NaN when
    not tracked, `map_id` (-1), `tracked_points`, `fresh` (whether this step's frame was fed), `event`. In the last
    step `info["episode_slam"]` holds the results, see `slamgym.eval.episode.summarize_slam`, and the drive's, see
    `slamgym.eval.drive.summarize_drive`. A crash or a hang of the SLAM terminates the episode.

    Raises ConfigError for a bad parameter or an option that the backend cannot honour, SlamError when the backend
    cannot be started on this machine.
    """

    def __init__(self, env: gym.Env[Observation, NDArray[np.float32]], **slam_params: Any) -> None:
        RecordConstructorArgs.__init__(self, **slam_params)
        gym.Wrapper.__init__(self, env)
        robot = env.unwrapped
        if not isinstance(robot, HomeRobotEnv):
            raise ConfigError(f"SlamWrapper: expected a HomeRobot environment, got {robot!r}")
        self._robot = robot
        given = None if slam_params else robot.slam_params
        self.slam_params = given or SlamParams.checked(slam_params)
        self._config = SlamConfig(
            camera=robot.params.camera,
            fps=robot.params.fps,
            loop_closure=self.slam_params.loop_closure,
            options=self.slam_params.slam_options,
        )
        check_config(self.slam_params.slam, self._config)
        assert isinstance(env.observation_space, spaces.Dict)
        self.observation_space = spaces.Dict({**env.observation_space.spaces, "slam_state": spaces.Discrete(3)})
        self._logs: tempfile.TemporaryDirectory[str] | None = None
        self._session: SlamSession | None = None
        self._next_session: SlamSession | None = None
        self._sessions_made: int = 0

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        if self._session is not None:
            self._session.close()
        self._session = self._next_session or self._new_session()
        self._next_session = None
        obs, info = self.env.reset(seed=seed, options=options)
        self._session.wait_ready()
        self._fed: list[Fed] = []
        self._steps = 0
        self._record: SlamRecord | None = None
        self._feed(obs, info)
        return self._with_slam(obs, info, fresh=True)

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, Info]:
        if self._session is None:
            raise gym.error.ResetNeeded("call reset() before step()")
        obs, progress, terminated, truncated, info = self.env.step(action)
        self._steps += 1
        fresh = self._steps % (self.slam_params.stride + 1) == 0
        reward = float(progress)
        if fresh and not self._session.outcome:
            self._feed(obs, info)
            if self.slam_params.reward == "tracking" and self._fed[-1].result.state is not TrackingState.OK:
                reward -= 1.0
        terminated = terminated or bool(self._session.outcome)
        obs, info = self._with_slam(obs, info, fresh)
        if terminated or truncated:
            info["episode_slam"] = self.conclude()
        return obs, reward, terminated, truncated, info

    def conclude(self) -> Summary:
        """End the SLAM run, now if it still goes on, and return the results so far; may be called again."""
        return {**summarize_slam(self.slam_record()), **self._robot.summarize_drive()}

    def slam_record(self) -> SlamRecord:
        """All that the evaluation needs of the episode's SLAM run; ends the run."""
        if self._record is None:
            assert self._session is not None
            # The next episode's SLAM loads its libraries while this one shuts down.
            self._next_session = self._new_session()
            self._record = finish(self._session, self._fed)
        return self._record

    @property
    def slam_pid(self) -> int | None:
        """Process id of the SLAM, None before the first reset."""
        return self._session.pid if self._session is not None else None

    def slam_log(self) -> str:
        """What the SLAM wrote to its standard output and error, the last MiB of it."""
        return self._session.log_tail(lines=LOG_LINES) if self._session is not None else ""

    def close(self) -> None:
        for session in (self._session, self._next_session):
            if session is not None:
                session.close()
        self._session = self._next_session = None
        if self._logs is not None:
            self._logs.cleanup()
            self._logs = None
        super().close()

    def _new_session(self) -> SlamSession:
        if self._logs is None:
            self._logs = tempfile.TemporaryDirectory(prefix="slamgym-")
        log = Path(self._logs.name) / f"slam-{self._sessions_made}.log"
        self._sessions_made += 1
        session = SlamSession(
            self.slam_params.slam, self._config, self.slam_params.slam_sync, self.slam_params.slam_timeout_s, log
        )
        session.start()
        return session

    def _feed(self, obs: Observation, info: Info) -> None:
        assert self._session is not None
        frame = Frame(info["stamp_ns"], obs["rgb"], obs["depth"], info["T_world_cam"])
        self._fed.append(feed(self._session, frame))

    def _with_slam(self, obs: Observation, info: Info, fresh: bool) -> tuple[Observation, Info]:
        last = self._fed[-1].result
        info["slam"] = {
            "state": last.state.label,
            "T_map_cam": last.T_map_cam.copy(),
            "map_id": last.map_id,
            "tracked_points": last.tracked_points,
            "fresh": fresh,
            "event": str(last.event) if fresh else str(SlamEvent.NONE),
        }
        return {**obs, "slam_state": np.int64(last.state)}, info
