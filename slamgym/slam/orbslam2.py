"""ORB-SLAM2 (Mur-Artal and Tardos, T-RO 2017) with an RGB-D camera, by its Python bindings of the same name.

The only file that imports orbslam2. What its bindings do not tell is inferred, as found out with a real build:

- They have no getter for a pose. That of the last frame is the last point of the trajectory, while the state is OK;
  that a frame "has a pose" is also said of the first lost one.
- A lost frame repeats the last tracked one in the trajectory, stamp included.
- A map that is lost with five keyframes or fewer is thrown away at the next frame: the trajectory starts anew, and is
  read out of bounds while the new map has no keyframe.
"""

import sys
from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from slamgym.errors import SlamError
from slamgym.files import recorded_hash
from slamgym.slam.backend import SlamConfig, untracked
from slamgym.slam.orb_settings import Clock, OrbOptions, classic_settings, memory_file
from slamgym.slam.vocabulary import vocabulary_hash, vocabulary_path
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult

_INSTALL = (
    "build ORB-SLAM2 and its Python bindings (jskinn/ORB_SLAM2-PythonBindings) for Python "
    f"{sys.version_info.major}.{sys.version_info.minor} and put the folder of orbslam2*.so on PYTHONPATH, or run its "
    "program rgbd_tum with the slam backend 'command'"
)
_NEEDED = (
    *("set_use_viewer", "initialize", "process_image_rgbd"),
    *("get_tracking_state", "get_num_matched_features", "get_trajectory_points"),
)


class OrbSlam2:
    """One run of ORB-SLAM2."""

    Options = OrbOptions
    loop_closures = (True,)  # nothing in it turns loop closing off
    has_background_threads = True
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        _module_path()
        vocabulary_path(OrbOptions.checked(config.options).vocabulary)

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        options = OrbOptions.checked(config.options)
        return {
            "orbslam2_sha256": recorded_hash(_module_path()),
            "vocabulary_sha256": vocabulary_hash(options.vocabulary),
        }

    def __init__(self, config: SlamConfig) -> None:
        options = OrbOptions.checked(config.options)
        self._library = _load()
        text = classic_settings(config, options, is_rgb=True, depth_units=1.0)
        self._slam = _start(self._library, vocabulary_path(options.vocabulary), text)
        self._clock = Clock()
        self._origin_s: float | None = None
        self._map_id = -1
        self._was_ok = False
        self._tracked_ns: list[int] = []

    def track(self, frame: Frame) -> TrackResult:
        self._slam.process_image_rgbd(frame.rgb, frame.depth, self._clock.seconds(frame.stamp_ns))
        tracked_points = self._slam.get_num_matched_features()
        was_ok, self._was_ok = self._was_ok, self._slam.get_tracking_state() == self._library.TrackingState.OK
        if not self._was_ok:
            state = TrackingState.NOT_INITIALIZED if self._map_id < 0 else TrackingState.LOST
            return untracked(state, SlamEvent.LOST if was_ok else SlamEvent.NONE, tracked_points)
        points = self._slam.get_trajectory_points()
        event = self._event_when_ok(points[0][0], was_ok)
        self._tracked_ns.append(frame.stamp_ns)
        return TrackResult(TrackingState.OK, to_poses(points[-1:])[0], self._map_id, tracked_points, event)

    def finish(self) -> SlamTrajectory:
        """The trajectory of the map that is left. No shutdown: it empties the trajectory, and the process ends."""
        points = self._slam.get_trajectory_points() if self._has_map() else []
        seconds = np.array([point[0] for point in points], dtype=np.float64)
        stamps_ns = np.rint(seconds * 1e9).astype(np.int64) + self._clock.first_ns
        stamps_ns, first = np.unique(stamps_ns, return_index=True)
        is_tracked = np.isin(stamps_ns, self._tracked_ns)
        T_map_cam = to_poses([points[row] for row in first[is_tracked]])
        return SlamTrajectory(stamps_ns[is_tracked], T_map_cam, np.full(len(T_map_cam), self._map_id, dtype=np.int64))

    def _event_when_ok(self, origin_s: float, was_ok: bool) -> SlamEvent:
        """origin_s: stamp of the trajectory's first point, where the map began."""
        if origin_s == self._origin_s:
            return SlamEvent.NONE if was_ok else SlamEvent.RELOCALIZED
        self._origin_s = origin_s
        self._map_id += 1
        return SlamEvent.MAP_RESET if self._map_id else SlamEvent.INITIALIZED

    def _has_map(self) -> bool:
        states = self._library.TrackingState
        return self._map_id >= 0 and self._slam.get_tracking_state() in (states.OK, states.LOST)


def to_poses(points: Sequence[Sequence[float]]) -> FloatArray:
    """T_map_cam (N, 4, 4) of N points of 13 numbers: seconds, and 3x4 of the pose by rows, in float32's precision."""
    T = np.tile(np.eye(4), (len(points), 1, 1))
    T[:, :3] = np.array([point[1:] for point in points], dtype=np.float64).reshape(-1, 3, 4)
    if len(T):
        T[:, :3, :3] = Rotation.from_matrix(T[:, :3, :3]).as_matrix()
    return T


def _module_path() -> Path:
    spec = find_spec("orbslam2")
    # Without an origin it is but a folder of that name.
    if spec is None or spec.origin is None:
        raise SlamError(f"slam backend 'orbslam2': the module orbslam2 is missing; {_INSTALL}")
    return Path(spec.origin)


def _load() -> Any:
    try:
        library = import_module("orbslam2")
    except ImportError as error:
        raise SlamError(f"slam backend 'orbslam2': orbslam2 cannot be loaded ({error}); {_INSTALL}") from error
    if missing := [name for name in _NEEDED if not hasattr(getattr(library, "System", None), name)]:
        raise SlamError(
            f"slam backend 'orbslam2': expected bindings whose System has {', '.join(_NEEDED)}; "
            f"{library.__file__} lacks {', '.join(missing)}; {_INSTALL}"
        )
    return library


def _start(library: Any, vocabulary: Path, settings_text: str) -> Any:
    with memory_file(settings_text) as (_, path):
        slam = library.System(str(vocabulary), path, library.Sensor.RGBD)
        slam.set_use_viewer(False)
        slam.initialize()
    return slam
