"""Frame-to-frame RGB-D odometry of OpenCV 5: a baseline without a map, without loop closing, without threads."""

import cv2
import numpy as np
from pydantic import Field

from slamgym.errors import SlamError
from slamgym.slam.backend import SlamConfig, untracked
from slamgym.slam.rgbd_matcher import Matcher, MatchOptions, View
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult


class OpenCvOptions(MatchOptions):
    """What is used of the images, what an answer of OpenCV has to fulfil to be believed, and when a map ends."""

    new_map_after_s: float = Field(1.0, ge=0, description="seconds without a match after which a new map may start")


class OpenCvOdometry:
    """Odometry from each frame to the last tracked one; its poses are never corrected later.

    A frame is tracked when the estimated motion predicts what it shows: of the edge pixels of the last tracked frame,
    enough reappear where they should and at the depth they should have, with correlated grey values, and they pin the
    motion down in all directions. `tracked_points` counts the edge pixels that reappear, of 10,000 at most; at the
    first frame of a map, all that there are. A lost camera is found again when a frame matches the last tracked one.
    When it is not for `new_map_after_s`, two consecutive frames that match each other start a new map at the second.
    """

    Options = OpenCvOptions
    loop_closures = (False,)
    has_background_threads = False
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:  # noqa: ARG003
        if not hasattr(cv2, "OdometrySettings"):
            raise SlamError(
                f"slam backend 'opencv': expected OpenCV 5, which has RGB-D odometry, got {cv2.__version__}; "
                "pip install 'opencv-python-headless>=5.0'"
            )

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:  # noqa: ARG003
        return {"opencv": cv2.__version__}

    def __init__(self, config: SlamConfig) -> None:
        # One run, one core: more threads are no quicker, and the answers are the same to the last bit.
        cv2.setNumThreads(1)
        self._options = OpenCvOptions.checked(config.options)
        self._matcher = Matcher(config.camera, self._options)
        self._reference: View | None = None
        self._T_map_reference: FloatArray = np.eye(4)
        self._previous: View | None = None
        self._lost_since_ns: int | None = None
        self._tracked: list[tuple[int, FloatArray, int]] = []
        self._map_id = -1

    def track(self, frame: Frame) -> TrackResult:
        view = self._matcher.look(frame)
        previous, self._previous = self._previous, view
        if self._reference is None:
            return self._start_map(view) if view.is_usable else untracked(TrackingState.NOT_INITIALIZED)
        match = self._matcher.match(self._reference, view)
        if match is not None:
            event = SlamEvent.NONE if self._lost_since_ns is None else SlamEvent.RELOCALIZED
            return self._move(view, self._T_map_reference @ match.T_reference_view, match.points, event)
        if self._lost_since_ns is None:
            self._lost_since_ns = view.stamp_ns
            return untracked(TrackingState.LOST, SlamEvent.LOST)
        lost_s = (view.stamp_ns - self._lost_since_ns) * 1e-9
        if lost_s > self._options.new_map_after_s and previous and self._matcher.match(previous, view):
            return self._start_map(view)
        return untracked(TrackingState.LOST)

    def finish(self) -> SlamTrajectory:
        return SlamTrajectory.of(self._tracked)

    def _start_map(self, view: View) -> TrackResult:
        self._map_id += 1
        event = SlamEvent.INITIALIZED if self._map_id == 0 else SlamEvent.NEW_MAP
        return self._move(view, np.eye(4), len(view.points), event)

    def _move(self, view: View, T_map_cam: FloatArray, points: int, event: SlamEvent) -> TrackResult:
        self._reference, self._T_map_reference, self._lost_since_ns = view, T_map_cam, None
        self._tracked.append((view.stamp_ns, T_map_cam, self._map_id))
        return TrackResult(TrackingState.OK, T_map_cam, self._map_id, points, event)
