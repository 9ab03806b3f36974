"""A drive while it is driven, in the viewer Rerun (rerun.io) or in a file for it. The only file that imports rerun.

On the timeline `stamp`, the simulated time:

world/camera             true pose of the camera's optical frame, its lens, and below it `rgb` and `depth`
world/planned_path       on the floor
world/true_path          of the camera
world/estimated_path     by the SLAM; each map is laid to the truth by its first pose alone, since its origin is its own
world/map_points         points of the map that the last frame was tracked by, where the backend tells them
robot/speed_mps, slam/tracked_points, slam/state, slam/events
"""

import os
import sys
import sysconfig
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import cv2
import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.env import HomeRobotEnv, Info, Observation
from slamgym.errors import ConfigError, OutputError
from slamgym.files import check_free
from slamgym.geometry import inverse
from slamgym.rollout import RobotEnv
from slamgym.types import FloatArray, SlamEvent, Summary

try:
    import rerun as rr
    import rerun.blueprint as rrb
except ModuleNotFoundError:
    raise ConfigError("live view: expected the module rerun, which is missing; pip install 'slamgym[rerun]'") from None

SUFFIX = ".rrd"
ANSWER_S = 20.0
"""Longest wait for the viewer or the disk, when the view opens and when it closes."""
SCREEN_VARIABLES = {"DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"}
JPEG_QUALITY = 85
DEPTH_UNITS_A_M = 1000
"""Depth is shown to the millimetre; the SLAM gets it as it is."""
TRAIL_SPACING_M = 0.03
"""Between two points of a path that is shown: it is sent anew whenever it has grown."""
GREY, ORANGE, BLUE, GREEN = (150, 150, 150), (230, 159, 0), (86, 180, 233), (0, 158, 115)
"""Planned, true and estimated path, map points: to be seen in the viewer's dark theme and in its light one."""
STATE_COLOURS = {"not_initialized": GREY, "ok": GREEN, "lost": (213, 94, 0)}
ALARMING = {SlamEvent.LOST, SlamEvent.MAP_RESET, SlamEvent.CRASHED, SlamEvent.TIMEOUT}


def check_live_file(path: Path) -> None:
    """Raises ConfigError for another suffix, OutputError where a file cannot be written or another would be lost."""
    if path.suffix != SUFFIX:
        raise ConfigError(f"live view: expected a file name that ends in {SUFFIX}, got {str(path)!r}")
    check_free(path, "file")


@contextmanager
def live_view(path: Path | None = None) -> Iterator[Callable[[RobotEnv], "LiveView"]]:
    """What shows the next episode of an environment: in Rerun's viewer, which it opens, or in the .rrd file `path`.

    However the block ends, the file then holds all frames until there. Raises what `check_live_file` raises, and
    OutputError when the viewer does not open or the file cannot be written to its end; that somebody closes the viewer
    is no error.

    >>> with live_view(Path("drive.rrd")) as show:
    ...     run_episode(show(env), PathFollower(), seed=7)
    """
    _check_screen() if path is None else check_live_file(path)
    recording = rr.RecordingStream("slamgym")

    def show(env: RobotEnv) -> LiveView:
        _open(recording, path)
        return LiveView(env, recording)

    try:
        yield show
    finally:
        _close(recording, path)


class LiveView(gym.Wrapper[Observation, NDArray[np.float32], Observation, NDArray[np.float32]]):
    """Shows one episode of a HomeRobot environment, with a SLAM or without one; changes nothing of it.

    Showing a frame takes some milliseconds, which a SLAM in real time sees as lateness.
    """

    def __init__(self, env: RobotEnv, recording: rr.RecordingStream) -> None:
        super().__init__(env)
        robot = env.unwrapped
        if not isinstance(robot, HomeRobotEnv):
            raise ConfigError(f"live view: expected a HomeRobot environment, got {env}")
        self._robot = robot
        self._log = recording.log
        self._recording = recording

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Observation, Info]:
        obs, info = self.env.reset(seed=seed, options=options)
        self._true_path, self._estimated_path = _Trail(), _Trail()
        self._T_world_map: dict[int, FloatArray] = {}
        self._state = ""
        self._show_surroundings()
        self._show(obs, info)
        return obs, info

    def step(self, action: NDArray[np.float32]) -> tuple[Observation, float, bool, bool, Info]:
        obs, reward, terminated, truncated, info = self.env.step(action)
        self._show(obs, info)
        return obs, float(reward), terminated, truncated, info

    def _show_surroundings(self) -> None:
        path_xyz = np.pad(self._robot.path.xy, ((0, 0), (0, 1)))
        states = rr.StateConfiguration(values=list(STATE_COLOURS), colors=list(STATE_COLOURS.values()))
        self._log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._log("world/planned_path", rr.LineStrips3D([path_xyz], colors=GREY), static=True)
        self._log("world/camera", _pinhole(self._robot.params.camera), static=True)
        self._log("slam/state", states, static=True)

    def _show(self, obs: Observation, info: Info) -> None:
        self._recording.set_time("stamp", duration=np.timedelta64(info["stamp_ns"], "ns"))
        T_world_cam = info["T_world_cam"]
        self._log("world/camera", rr.Transform3D(translation=T_world_cam[:3, 3], mat3x3=T_world_cam[:3, :3]))
        self._log("world/camera/rgb", rr.Image(obs["rgb"]).compress(jpeg_quality=JPEG_QUALITY))
        self._log("world/camera/depth", _depth_image(obs["depth"]))
        self._log("robot/speed_mps", rr.Scalars(info["speed_mps"]))
        self._show_trail("world/true_path", self._true_path, T_world_cam[:3, 3], ORANGE)
        if "slam" in info and info["slam"]["fresh"]:
            self._show_slam(info["slam"], T_world_cam)
        if "episode_slam" in info:
            self._log("slam/events", rr.TextLog(_result(info["episode_slam"]), level=rr.TextLogLevel.INFO))

    def _show_slam(self, slam: dict[str, Any], T_world_cam: FloatArray) -> None:
        self._log("slam/tracked_points", rr.Scalars(slam["tracked_points"]))
        if slam["state"] != self._state:
            self._state = slam["state"]
            self._log("slam/state", rr.StateChange(state=self._state))
        if slam["event"]:
            level = rr.TextLogLevel.WARN if slam["event"] in ALARMING else rr.TextLogLevel.INFO
            self._log("slam/events", rr.TextLog(slam["event"], level=level))
        if slam["state"] == "ok":
            self._show_estimate(slam["T_map_cam"], slam["map_id"], T_world_cam)
        else:
            self._estimated_path.end_strip()
            self._log("world/map_points", rr.Clear(recursive=False))

    def _show_estimate(self, T_map_cam: FloatArray, map_id: int, T_world_cam: FloatArray) -> None:
        if map_id not in self._T_world_map:
            self._T_world_map[map_id] = T_world_cam @ inverse(T_map_cam)
            self._estimated_path.end_strip()
        T_world_map = self._T_world_map[map_id]
        self._show_trail("world/estimated_path", self._estimated_path, (T_world_map @ T_map_cam)[:3, 3], BLUE)
        points = self.env.get_wrapper_attr("slam_map_points")()
        if points is not None:
            points_in_world = points @ T_world_map[:3, :3].T + T_world_map[:3, 3]
            self._log("world/map_points", rr.Points3D(points_in_world, colors=GREEN, radii=rr.Radius.ui_points(1.5)))

    def _show_trail(self, entity: str, trail: "_Trail", point: FloatArray, colour: tuple[int, int, int]) -> None:
        if trail.add(point):
            self._log(entity, rr.LineStrips3D(trail.strips, colors=colour))


class _Trail:
    """A path that grows, in strips; those of one point are not to be seen."""

    def __init__(self) -> None:
        self._strips: list[list[FloatArray]] = [[]]

    @property
    def strips(self) -> list[FloatArray]:
        return [np.array(strip) for strip in self._strips if strip]

    def add(self, point: FloatArray) -> bool:
        """Go on to the point (3,), metres; whether the path has grown."""
        strip = self._strips[-1]
        grows = not strip or bool(np.linalg.norm(point - strip[-1]) >= TRAIL_SPACING_M)
        if grows:
            strip.append(point.copy())
        return grows

    def end_strip(self) -> None:
        """The next point begins a new strip."""
        if self._strips[-1]:
            self._strips.append([])


def _check_screen() -> None:
    if sys.platform == "linux" and not SCREEN_VARIABLES & os.environ.keys():
        raise OutputError(f"live view: cannot open the viewer, since there is no screen; name a {SUFFIX} file")


def _open(recording: rr.RecordingStream, path: Path | None) -> None:
    try:
        if path is None:
            program = Path(sysconfig.get_path("scripts"), "rerun")  # also where the environment is not on the PATH
            rr.spawn(executable_path=str(program), recording=recording, default_blueprint=_layout())
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            recording.save(path, default_blueprint=_layout())
        recording.flush(timeout_sec=ANSWER_S)
    except (OSError, RuntimeError) as error:
        what, other = ("the viewer", f"a {SUFFIX} file") if path is None else (path, f"another {SUFFIX} file")
        recording.disconnect()
        raise OutputError(f"live view: cannot open {what} ({_first_line(error)}); name {other}") from None


def _close(recording: rr.RecordingStream, path: Path | None) -> None:
    try:
        recording.flush(timeout_sec=ANSWER_S)
    except RuntimeError as error:
        if path is not None:
            raise OutputError(f"live view: cannot write {path} to its end ({_first_line(error)}); make room") from None
    finally:
        recording.disconnect()


def _first_line(error: Exception) -> str:
    return str(error).strip().partition("\n")[0]


def _layout() -> rrb.Blueprint:
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial3DView(origin="world", name="house"),
            rrb.Vertical(
                rrb.Horizontal(
                    rrb.Spatial2DView(origin="world/camera", contents="world/camera/rgb", name="colour"),
                    rrb.Spatial2DView(origin="world/camera", contents="world/camera/depth", name="depth"),
                ),
                rrb.StateTimelineView(origin="slam/state", name="state"),
                rrb.TimeSeriesView(origin="slam/tracked_points", name="tracked points"),
                rrb.TimeSeriesView(origin="robot/speed_mps", name="speed, m/s"),
                rrb.TextLogView(origin="slam/events", name="events"),
                row_shares=[3, 1, 2, 2, 2],
            ),
            column_shares=[3, 2],
        ),
        rrb.TimePanel(timeline="stamp", state="collapsed"),
        collapse_panels=True,
    )


def _pinhole(camera: PinholeCamera) -> rr.Pinhole:
    return rr.Pinhole(
        focal_length=(camera.fx, camera.fy),
        principal_point=(camera.cx + 0.5, camera.cy + 0.5),  # Rerun counts from the image's corner
        resolution=(camera.width, camera.height),
        camera_xyz=rr.ViewCoordinates.RDF,
        image_plane_distance=0.3,
    )


def _depth_image(depth: NDArray[np.float32]) -> rr.EncodedDepthImage:
    """As PNG: raw it would be most of a file."""
    units = np.clip(np.rint(depth * DEPTH_UNITS_A_M), 0, np.iinfo(np.uint16).max).astype(np.uint16)
    png = cv2.imencode(".png", units, [cv2.IMWRITE_PNG_COMPRESSION, 1])[1].tobytes()
    return rr.EncodedDepthImage(png, media_type="image/png", meter=DEPTH_UNITS_A_M)


def _result(summary: Summary) -> str:
    ate = f"ATE {summary['ate_rmse_m']:.3f} m" if np.isfinite(summary["ate_rmse_m"]) else "no ATE"
    return f"end: {summary['status']}, {ate}, completion {summary['completion']:.0%}, losses: {summary['loss_count']}"
