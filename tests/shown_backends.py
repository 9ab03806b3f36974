# ruff: noqa: ARG002, ARG003
"""SLAMs to look at, for the tests of the live view. They run in the worker process."""

import numpy as np

from slamgym.geometry import inverse
from slamgym.slam.backend import SlamConfig, SlamOptions, untracked
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult

WORLD_POINTS = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
LOST_FROM, FOUND_FROM = 10, 15
ORIGINS = np.array([[[0.0, -1, 0, 3], [1, 0, 0, 2], [0, 0, 1, 1], [0, 0, 0, 1]], np.eye(4)])
"""T_world_map of its two maps."""


class TwoMaps:
    """Knows where it is, loses track at one frame, and goes on in a second map at another."""

    Options = SlamOptions
    loop_closures = ()
    has_background_threads = False
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        pass

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        return {}

    def __init__(self, config: SlamConfig) -> None:
        self.frames = 0
        self.map_id = 0
        self.poses: list[tuple[int, FloatArray, int]] = []

    def track(self, frame: Frame) -> TrackResult:
        number, self.frames = self.frames, self.frames + 1
        if LOST_FROM <= number < FOUND_FROM:
            return untracked(TrackingState.LOST, SlamEvent.LOST if number == LOST_FROM else SlamEvent.NONE)
        self.map_id = int(number >= FOUND_FROM)
        event = {0: SlamEvent.INITIALIZED, FOUND_FROM: SlamEvent.NEW_MAP}.get(number, SlamEvent.NONE)
        T_map_cam = inverse(ORIGINS[self.map_id]) @ frame.T_world_cam
        self.poses.append((frame.stamp_ns, T_map_cam, self.map_id))
        return TrackResult(TrackingState.OK, T_map_cam, self.map_id, 100 + number, event)

    def map_points(self) -> FloatArray:
        T_map_world = inverse(ORIGINS[self.map_id])
        points = WORLD_POINTS @ T_map_world[:3, :3].T + T_map_world[:3, 3]
        return np.vstack([points, np.full((1, 3), np.nan)])

    def finish(self) -> SlamTrajectory:
        return SlamTrajectory.of(self.poses)


class FlatMap(TwoMaps):
    """Tells the points of its map wrongly."""

    def map_points(self) -> FloatArray:
        return WORLD_POINTS[:, :2]
