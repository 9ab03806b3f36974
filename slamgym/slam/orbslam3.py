"""ORB-SLAM3 (Campos et al., T-RO 2021) with an RGB-D camera. The only file that imports pyorbslam3."""

import os
import stat
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from slamgym.errors import SlamError
from slamgym.geometry import from_quaternion
from slamgym.slam.backend import SlamConfig, untracked
from slamgym.slam.map_tracker import MapTracker, final_trajectory
from slamgym.slam.orb_settings import Clock, OrbOptions, memory_file, settings
from slamgym.slam.vocabulary import vocabulary_hash, vocabulary_path
from slamgym.types import FloatArray, Frame, IntArray, SlamTrajectory, TrackingState, TrackResult

_INSTALL = "pip install pyorbslam3, and on Debian: apt install libgl1 libegl1 libopengl0 libglx0 libsm6 libice6"


class OrbSlam3:
    """One run of ORB-SLAM3. It has to be alone in its process: the maps are followed by what the process prints."""

    Options = OrbOptions
    loop_closures = (True, False)
    has_background_threads = True
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        if find_spec("pyorbslam3") is None:
            raise SlamError(f"slam backend 'orbslam3': the module pyorbslam3 is missing; {_INSTALL}")
        vocabulary_path(OrbOptions.checked(config.options).vocabulary)

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        options = OrbOptions.checked(config.options)
        return {"pyorbslam3": version("pyorbslam3"), "vocabulary_sha256": vocabulary_hash(options.vocabulary)}

    def __init__(self, config: SlamConfig) -> None:
        options = OrbOptions.checked(config.options)
        self._output = _OwnOutput()
        self._slam = _start(vocabulary_path(options.vocabulary), settings(config, options))
        self._maps = MapTracker()
        self._clock = Clock()
        self._online: list[tuple[int, FloatArray, int]] = []

    def track(self, frame: Frame) -> TrackResult:
        # Before tracking: what the mapping threads printed since the last frame holds for this one.
        self._maps.read(self._output.new_text())
        answer = self._slam.track_rgbd(frame.rgb, frame.depth, self._clock.seconds(frame.stamp_ns))
        state, event = self._maps.update(answer.state.name)
        if state is not TrackingState.OK:
            return untracked(state, event, answer.num_tracked_points)
        T_map_cam = np.asarray(answer.pose_wc, dtype=np.float64)
        self._online.append((frame.stamp_ns, T_map_cam, self._maps.map_id))
        return TrackResult(state, T_map_cam, self._maps.map_id, answer.num_tracked_points, event)

    def map_points(self) -> FloatArray:
        return np.asarray(self._slam.tracked_map_points(), dtype=np.float64)

    def finish(self) -> SlamTrajectory:
        self._slam.shutdown()
        if all(map_id in self._maps.thrown_away for *_, map_id in self._online):
            return SlamTrajectory.of()  # ORB-SLAM3 crashes when it saves a trajectory without a map
        with memory_file() as (file, path):
            self._slam.save_trajectory_euroc(path)
            saved = read_saved(file.read().decode(), self._clock.first_ns)
        return final_trajectory(SlamTrajectory.of(self._online), saved, self._maps.thrown_away)


def _start(vocabulary: Path, settings_text: str) -> Any:
    try:
        library = import_module("pyorbslam3")
    except ImportError as error:
        raise SlamError(f"slam backend 'orbslam3': pyorbslam3 cannot be loaded ({error}); {_INSTALL}") from error
    with memory_file(settings_text) as (_, path):
        return library.Slam(vocabulary, path, library.Sensor.RGBD)


class _OwnOutput:
    """What this process has printed; its standard output has to be a file that can be read back."""

    def __init__(self) -> None:
        if not stat.S_ISREG(os.fstat(1).st_mode):
            raise SlamError("slam backend 'orbslam3': expected a file as standard output; run it in a SlamSession")
        self._read = os.fstat(1).st_size

    def new_text(self) -> str:
        """Whole lines printed since the last call."""
        new = os.pread(1, os.fstat(1).st_size - self._read, self._read)
        new = new[: new.rfind(b"\n") + 1]
        self._read += len(new)
        return new.decode(errors="replace")


def read_saved(text: str, first_stamp_ns: int) -> SlamTrajectory:
    """Frames of the biggest map from ORB-SLAM3's file in EuRoC form: nanoseconds, x y z in metres, qx qy qz qw."""
    rows = np.array([line.split() for line in text.splitlines()], dtype=np.float64).reshape(-1, 8)
    stamps_ns: IntArray = np.rint(rows[:, 0]).astype(np.int64) + first_stamp_ns
    T_map_cam = from_quaternion(rows[:, 1:4], rows[:, 4:8])
    return SlamTrajectory(stamps_ns, T_map_cam, np.zeros(len(rows), dtype=np.int64))
