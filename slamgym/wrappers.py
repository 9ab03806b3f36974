"""`SlamWrapper` feeds an environment's frames to a SLAM, step by step, and reports what became of it."""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from slamgym.env import HomeRobotEnv, Info, Observation
from slamgym.errors import ConfigError
from slamgym.eval.episode import summarize_slam
from slamgym.params import SlamInLoopParams
from slamgym.slam.backend import check_config
from slamgym.slam.record import SlamRun
from slamgym.slam.session import SlamSession
from slamgym.types import FloatArray, Frame, SlamEvent, SlamRecord, Summary, TrackingState


class SlamWrapper(
    gym.Wrapper[Observation, NDArray[np.float32], Observation, NDArray[np.float32]], RecordConstructorArgs
):
    """Every (stride + 1)-th frame goes to the SLAM, with its true stamp, before `step` returns.

    Without keywords the parameters are those that `gym.make` was given; else they are the fields of `SlamInLoopParams`.

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
        if not isinstance(robot, HomeRobotEnv) or env.has_wrapper_attr("slam_record"):
            raise ConfigError(f"SlamWrapper: expected a HomeRobot environment without a SLAM, got {env}")
        self._robot = robot
        given = None if slam_params else robot.slam_params
        self.slam_params = given or SlamInLoopParams.checked(slam_params)
        self._config = self.slam_params.config(robot.params.camera, robot.params.fps)
        check_config(self.slam_params.slam, self._config)
        self._recorded = self.slam_params.recorded(self._config)
        assert isinstance(env.observation_space, spaces.Dict)
        self.observation_space = spaces.Dict({**env.observation_space.spaces, "slam_state": spaces.Discrete(3)})
        self._session: SlamSession | None = None
        self._next_session: SlamSession | None = None
        self._record: SlamRecord | None = None
        self._summary: Summary | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        if self._session is not None:
            self._session.close()
            self._session = None
        session, self._next_session = self._next_session or self._new_session(), None
        try:
            obs, info = self.env.reset(seed=seed, options=options)
            session.wait_ready()
        except BaseException:
            session.close()
            raise
        self._session = session
        self._run = SlamRun(session)
        self._steps = 0
        self._record = self._summary = None
        self._feed(obs, info)
        # A SLAM runs only once and takes half a second to load: the next episode's loads while this one goes on.
        self._next_session = self._new_session()
        return self._with_slam(obs, info, fresh=True)

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, Info]:
        if self._session is None or self._record is not None:
            raise gym.error.ResetNeeded("the episode has not begun or has ended: call reset() before step()")
        obs, progress, terminated, truncated, info = self.env.step(action)
        self._steps += 1
        fresh = self._steps % (self.slam_params.stride + 1) == 0 and not self._session.outcome
        reward = float(progress)
        if fresh:
            self._feed(obs, info)
            if self.slam_params.reward == "tracking" and self._run.last.state is not TrackingState.OK:
                reward -= 1.0
        terminated = terminated or bool(self._session.outcome)
        obs, info = self._with_slam(obs, info, fresh)
        if terminated or truncated:
            info["episode_slam"] = self.conclude()
        return obs, reward, terminated, truncated, info

    def conclude(self) -> Summary:
        """End the SLAM run, now if it still goes on, and return the results so far; may be called again."""
        if self._summary is None:
            results = summarize_slam(self.slam_record(), self.slam_params.map_policy)
            self._summary = {**results, **self._robot.summarize_drive()}
        return dict(self._summary)

    def slam_record(self) -> SlamRecord:
        """All that the evaluation needs of the episode's SLAM run; ends the run."""
        if self._record is None:
            self._record = self._run.finish()
        return self._record

    def slam_config(self) -> dict[str, Any]:
        """See `SlamParams.recorded`."""
        return dict(self._recorded)

    def slam_timing(self) -> dict[str, float | str]:
        """See `SlamRun.timing`; not in `info`, which is the same on every computer."""
        return self._run.timing()

    def slam_map_points(self) -> FloatArray | None:
        """See `SlamSession.map_points`; None before the first reset and after the episode's end."""
        return self._session.map_points() if self._session is not None and self._record is None else None

    @property
    def slam_pid(self) -> int | None:
        """Process id of the SLAM, None before the first reset."""
        return self._session.pid if self._session is not None else None

    def slam_log(self) -> str:
        """What the SLAM wrote to its standard output and error, the last MiB of it."""
        return self._session.log() if self._session is not None else ""

    def close(self) -> None:
        for session in (self._session, self._next_session):
            if session is not None:
                session.close()
        self._session = self._next_session = None
        super().close()

    def _new_session(self) -> SlamSession:
        session = self.slam_params.session(self._config)
        session.start()
        return session

    def _feed(self, obs: Observation, info: Info) -> None:
        self._run.feed(Frame(info["stamp_ns"], obs["rgb"], obs["depth"], info["T_world_cam"]))

    def _with_slam(self, obs: Observation, info: Info, fresh: bool) -> tuple[Observation, Info]:
        last = self._run.last
        info["slam"] = {
            "state": last.state.label,
            "T_map_cam": last.T_map_cam.copy(),
            "map_id": last.map_id,
            "tracked_points": last.tracked_points,
            "fresh": fresh,
            "event": str(last.event) if fresh else str(SlamEvent.NONE),
        }
        return {**obs, "slam_state": np.int64(last.state)}, info
