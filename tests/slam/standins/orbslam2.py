"""Stands in for ORB-SLAM2's Python bindings: their interface and their quirks, as found out with a real build.

Its SLAM works for frames whose first red value is the camera's place on a line, in metres; one without depth it cannot
track. Every tracked frame is a keyframe. Finding its place again, it moves the whole map 0.25 m along y.
"""

import os
from enum import IntEnum
from pathlib import Path

import cv2
import numpy as np
from scipy.spatial.transform import Rotation

Sensor = IntEnum("Sensor", {"MONOCULAR": 0, "STEREO": 1, "RGBD": 2})
TrackingState = IntEnum(
    "TrackingState", {"SYSTEM_NOT_READY": -1, "NO_IMAGES_YET": 0, "NOT_INITIALIZED": 1, "OK": 2, "LOST": 3}
)


class System:
    def __init__(self, vocabulary: str, settings: str, sensor: Sensor = Sensor.RGBD, /) -> None:
        self._vocabulary, self._settings, self._sensor = vocabulary, settings, sensor
        self._state = TrackingState.SYSTEM_NOT_READY
        self._viewer = True
        self._reset_asked = False
        self._points: list[tuple[float, float]] = []
        self._was_reset = False

    def set_use_viewer(self, use: bool, /) -> None:
        self._viewer = use

    def initialize(self) -> bool:
        store = cv2.FileStorage(self._settings, cv2.FILE_STORAGE_READ)
        assert not self._viewer  # there is no screen
        if not Path(self._vocabulary).is_file() or not store.isOpened() or self._sensor is not Sensor.RGBD:
            os._exit(255)
        # Images come as this project has them, without a conversion.
        assert (store.getNode("Camera.RGB").real(), store.getNode("DepthMapFactor").real()) == (1, 1)
        self._shape = tuple(int(store.getNode(f"Camera.{side}").real()) for side in ("height", "width"))
        self._clear()
        return True

    def process_image_rgbd(self, rgb: np.ndarray, depth: np.ndarray, stamp_s: float, /) -> bool:
        assert (rgb.shape, depth.shape) == ((*self._shape, 3), self._shape)
        assert (rgb.dtype.name, depth.dtype.name) == ("uint8", "float32")
        if self._reset_asked:
            self._clear()
            self._was_reset = True
        was_ok = self._state is TrackingState.OK
        if not self._keyframes:
            return self._initialize_map(float(rgb[0, 0, 0]), bool(depth.any()), stamp_s)
        if depth.any():
            self._moved += 0.0 if was_ok else 0.25
            self._keyframes += 1
            self._state = TrackingState.OK
            self._points.append((stamp_s, float(rgb[0, 0, 0])))
            return True
        self._state = TrackingState.LOST
        self._reset_asked = self._keyframes <= 5
        if not self._reset_asked:
            self._points.append(self._points[-1])
        return was_ok

    def get_tracking_state(self) -> TrackingState:
        return self._state

    def get_num_matched_features(self) -> int:
        return 100 if self._state is TrackingState.OK else 3

    def get_trajectory_points(self) -> list[tuple[float, ...]]:
        if not self._keyframes:
            os.abort()  # it takes the pose of the first keyframe
        return [(stamp_s, *self._pose(x).ravel().tolist()) for stamp_s, x in self._points]

    def _initialize_map(self, x: float, has_depth: bool, stamp_s: float) -> bool:
        if self._was_reset and not has_depth:
            os.abort()
        self._state = TrackingState.OK if has_depth else TrackingState.NOT_INITIALIZED
        if has_depth:
            self._keyframes = 1
            self._points = [(stamp_s, x)]
        return has_depth

    def _pose(self, x: float) -> np.ndarray:
        """It turns by 0.1 rad a metre."""
        rotation = Rotation.from_rotvec([0.0, 0.1 * (x - self._points[0][1]), 0.0]).as_matrix()
        return np.column_stack([rotation, [x - self._points[0][1], self._moved, 0.0]]).astype(np.float32)

    def _clear(self) -> None:
        self._state = TrackingState.NO_IMAGES_YET
        self._keyframes = 0
        self._points = []
        self._moved = 0.0
        self._reset_asked = False
