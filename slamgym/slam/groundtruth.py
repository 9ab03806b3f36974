"""The oracle: a SLAM that is never wrong. It shows what the harness itself adds to the figures: nothing."""

import numpy as np

from slamgym.geometry import inverse
from slamgym.slam.backend import SlamConfig, SlamOptions, untracked
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult


class GroundTruth:
    """Answers each frame's true pose relative to the first one; a frame whose pose is not known is not tracked."""

    Options: type[SlamOptions] = SlamOptions
    loop_closures = (False,)
    has_background_threads = False
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        """It needs nothing."""

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:  # noqa: ARG003
        return {}

    def __init__(self, config: SlamConfig) -> None:  # noqa: ARG002
        self._poses: list[tuple[int, FloatArray, int]] = []
        self._T_map_world: FloatArray | None = None
        self._event = SlamEvent.INITIALIZED

    def track(self, frame: Frame) -> TrackResult:
        if not np.isfinite(frame.T_world_cam).all():
            return self._blind()
        event, self._event = self._event, SlamEvent.NONE
        T_map_cam = self.locate(frame.T_world_cam)
        self._poses.append((frame.stamp_ns, T_map_cam, 0))
        return TrackResult(TrackingState.OK, T_map_cam, map_id=0, tracked_points=0, event=event)

    def locate(self, T_world_cam: FloatArray) -> FloatArray:
        """T_map_cam (4, 4) of the next frame, whose true pose (4, 4) is known."""
        if self._T_map_world is None:
            self._T_map_world = inverse(T_world_cam)
        return self._T_map_world @ T_world_cam

    def finish(self) -> SlamTrajectory:
        return SlamTrajectory.of(self._poses)

    def _blind(self) -> TrackResult:
        """Answer for a frame without a true pose; the next one that has one tells that it is found again."""
        if not self._poses:
            return untracked(TrackingState.NOT_INITIALIZED)
        event = SlamEvent.LOST if self._event is SlamEvent.NONE else SlamEvent.NONE
        self._event = SlamEvent.RELOCALIZED
        return untracked(TrackingState.LOST, event)
