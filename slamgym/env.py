"""`HomeRobot-v0`: a home robot with an RGB-D camera that drives through a house."""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from slamgym import sensors
from slamgym.agents.path import WAYPOINT_COUNT, Path
from slamgym.agents.planner import plan_path
from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.drive import summarize_drive
from slamgym.geometry import mast_camera_pose
from slamgym.params import DriveParams, SlamInLoopParams, split_params
from slamgym.render import Renderer
from slamgym.robot import DifferentialDrive
from slamgym.scenes.house import House
from slamgym.stage import Stage, load_stage
from slamgym.types import FloatArray, Summary

Observation = dict[str, Any]
Info = dict[str, Any]

BLUR_SAMPLES = 5
END_REACHED_M = 0.05
RESET_OPTIONS = ("tour", "stretch_m")


class HomeRobotEnv(gym.Env[Observation, NDArray[np.float32]]):
    """A differential-drive robot follows a planned path; one step is one camera frame.

    Keywords: the fields of `DriveParams`, and `render_mode`. `gym.make` also passes the fields of `SlamInLoopParams`
    when a SLAM is in the loop; they are kept in `slam_params` for `SlamWrapper`.

    Action: Box(2) in [-1, 1]: forward speed (below 0: reverse) and turn rate (above 0: left), scaled by the parameters.
    Observation: `rgb` uint8 (H, W, 3), `depth` float32 (H, W) in metres along the optical axis with 0 = no measurement,
    `waypoints` float32 (5, 2): the next points of the path, 0.2 m apart, in the robot's frame (x forward, y left).
    Info: `stamp_ns`, `T_world_cam` (4, 4), `robot` (x, y, yaw), `speed_mps`, `yaw_rate_radps`, `progress_m`,
    `path_length_m`, `goal_m` (along the path to the next goal that it was planned to, infinite after the last),
    `distance_m`, `collision`, `action_scale` (m/s and rad/s of an action of 1).

    The drive ends within `END_REACHED_M` of the path's end.

    The reset seed picks the path only; `reset(options={"tour": "round_trip"})` plans one that returns to its start, and
    `{"stretch_m": (a, b)}` takes the metres a to b of the planned one, to its end at most: the robot starts at rest at
    a, and all that is told of the path, progress and goals too, is told of the stretch, from 0 at a.
    Raises ConfigError for a bad parameter, SceneError and RenderError at the first reset.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 30}  # noqa: RUF012  Gymnasium's form

    def __init__(self, render_mode: str | None = None, **params: Any) -> None:
        if render_mode not in (None, "rgb_array"):
            raise ConfigError(unknown_word("render_mode", str(render_mode), ["rgb_array"]))
        self.params, self.slam_params = self._check(params)
        self.params.scene_source()
        self.render_mode = render_mode
        self.metadata = {**type(self).metadata, "render_fps": self.params.fps}
        self.action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)
        camera = self.params.camera
        self.observation_space = spaces.Dict(
            rgb=spaces.Box(0, 255, (camera.height, camera.width, 3), np.uint8),
            depth=spaces.Box(0.0, np.inf, (camera.height, camera.width), np.float32),
            waypoints=spaces.Box(-np.inf, np.inf, (WAYPOINT_COUNT, 2), np.float32),
        )
        self._renderer: Renderer | None = None
        self._robot: DifferentialDrive | None = None
        self._house: House | None = None

    @staticmethod
    def _check(params: dict[str, Any]) -> tuple[DriveParams, SlamInLoopParams | None]:
        return DriveParams.checked(params), None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        super().reset(seed=seed)
        tour, stretch_m = _checked_options(options)
        path_seed, noise_seed = self.np_random.integers(2**63, size=2)
        self.stage = stage = load_stage(self.params)
        self.grid = stage.grid
        path = plan_path(stage.grid, stage.free, self.params.path_length_m, np.random.default_rng(path_seed), tour=tour)
        self.path: Path = path if stretch_m is None else _stretch(path, stretch_m)
        self._noise_rng = np.random.default_rng(noise_seed)
        robot = self._enter(stage)
        x, y = self.path.xy[0]
        self._state = self._before = robot.reset(x, y, self.path.heading_at(0.0))
        self._step = 0
        self._progress = 0.0
        self._distance = 0.0
        self._poses: list[FloatArray] = []
        self._last = self._observe()
        return self._last, self._info()

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, Info]:
        if self._robot is None or self._renderer is None:
            raise gym.error.ResetNeeded("call reset() before step()")
        forward, turn = _checked_action(action)
        self._before = self._state
        self._state = self._robot.step(
            forward * self.params.speed, turn * self.params.top_turn_rate, 1.0 / self.params.fps
        )
        self._step += 1
        self._distance += float(np.hypot(self._state.x - self._before.x, self._state.y - self._before.y))
        progress_before = self._progress
        self._progress = self.path.project(np.array([self._state.x, self._state.y]), progress_before)
        terminated = self._progress >= self.path.length_m - END_REACHED_M
        self._last = self._observe()
        return self._last, self._progress - progress_before, terminated, False, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """The colour image of the last observation, uint8 (H, W, 3), when `render_mode` is "rgb_array"."""
        if self._renderer is None:
            raise gym.error.ResetNeeded("call reset() before render()")
        return self._last["rgb"].copy() if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        if self._renderer is not None:
            self._renderer.close()
        if self._robot is not None:
            self._robot.close()
        self._renderer = self._robot = None

    def summarize_drive(self) -> Summary:
        """What was really driven since the reset, see `slamgym.eval.drive.summarize_drive`."""
        return summarize_drive(
            np.array([self._stamp_ns(step) for step in range(len(self._poses))]),
            np.array(self._poses),
            self.path.xy,
            self.params.speed,
        )

    def _enter(self, stage: Stage) -> DifferentialDrive:
        """Take robot and renderer into the stage's house, the same ones as long as it is the same."""
        params = self.params
        if stage.house is not self._house:
            self.close()
        self._house = stage.house
        if self._robot is None:
            self._robot = DifferentialDrive(stage.house)
        if self._renderer is None:
            self._renderer = Renderer(
                stage.house, params.camera, params.lighting, params.brightness, params.multisampling
            )
        return self._robot

    def _observe(self) -> Observation:
        """Render at the robot's pose, add the sensor's noise, and remember the true pose of the camera."""
        self._poses.append(self._camera_pose(1.0))
        rgb, depth = self._render_blurred()
        if self.params.rgb_noise > 0:
            rgb = sensors.rgb_noise(rgb, self.params.rgb_noise, self._noise_rng)
        if self.params.depth_noise == "icl_nuim":
            depth = sensors.icl_nuim_depth_noise(depth, self._noise_rng)
        state = self._state
        waypoints = self.path.waypoints(self._progress, state.x, state.y, state.yaw)
        return {"rgb": rgb, "depth": depth, "waypoints": waypoints}

    def _render_blurred(self) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """The exposure ends at the frame's stamp; depth is measured at its end."""
        assert self._renderer is not None
        rgb, depth = self._renderer.render(self._poses[-1])
        if self.params.motion_blur == 0 or self._step == 0:
            return rgb, depth
        total = rgb.astype(np.float32)
        for earlier in np.linspace(0.0, self.params.motion_blur, BLUR_SAMPLES)[1:]:
            total += self._renderer.render(self._camera_pose(1.0 - earlier))[0]
        return np.rint(total / BLUR_SAMPLES).astype(np.uint8), depth

    def _camera_pose(self, fraction: float) -> FloatArray:
        """T_world_cam at a fraction of the way from the last step's state (0) to this one's (1)."""
        before, now = self._before, self._state
        x, y, yaw = (
            (1 - fraction) * a + fraction * b for a, b in ((before.x, now.x), (before.y, now.y), (before.yaw, now.yaw))
        )
        return mast_camera_pose(x, y, yaw, self.params.camera_height)

    def _stamp_ns(self, step: int) -> int:
        return round(step * 1e9 / self.params.fps)

    def _info(self) -> Info:
        state = self._state
        return {
            "stamp_ns": self._stamp_ns(self._step),
            "T_world_cam": self._poses[-1].copy(),
            "robot": np.array([state.x, state.y, state.yaw]),
            "speed_mps": state.speed,
            "yaw_rate_radps": state.yaw_rate,
            "progress_m": self._progress,
            "path_length_m": self.path.length_m,
            "goal_m": self.path.next_goal(self._progress) - self._progress,
            "distance_m": self._distance,
            "collision": state.collided,
            "action_scale": np.array([self.params.speed, self.params.top_turn_rate]),
        }


class HomeRobotForSlamEnv(HomeRobotEnv):
    """The same robot; it also takes the fields of `SlamInLoopParams` and keeps them for `SlamWrapper`.

    Keywords of `gym.make` reach only this constructor, not the wrappers around it.
    """

    @staticmethod
    def _check(params: dict[str, Any]) -> tuple[DriveParams, SlamInLoopParams | None]:
        return split_params(params)


def _checked_options(options: dict[str, Any] | None) -> tuple[str, Any]:
    """The tour, and the stretch where one is asked for."""
    options = options or {}
    for key in options:
        if key not in RESET_OPTIONS:
            raise ConfigError(unknown_word("reset option", str(key), RESET_OPTIONS))
    return str(options.get("tour", "one_way")), options.get("stretch_m")


def _stretch(path: Path, stretch_m: Any) -> Path:
    try:
        start_m, end_m = (float(metres) for metres in stretch_m)
    except (TypeError, ValueError):
        start_m = end_m = np.nan
    end_m = min(end_m, path.length_m)
    if not 0.0 <= start_m < end_m - END_REACHED_M:
        raise ConfigError(
            f"stretch_m: expected two distances along the path of {path.length_m:.2f} m, the first of at least 0 and "
            f"the second more than {END_REACHED_M} m beyond it, got {stretch_m!r}"
        )
    return path.between(start_m, end_m)


def _checked_action(action: NDArray[np.float32]) -> tuple[float, float]:
    values = np.asarray(action, dtype=np.float64)
    if values.shape != (2,) or not np.isfinite(values).all():
        raise ConfigError(f"action: expected two finite numbers, forward and turn in [-1, 1], got {action!r}")
    forward, turn = np.clip(values, -1.0, 1.0)
    return float(forward), float(turn)
