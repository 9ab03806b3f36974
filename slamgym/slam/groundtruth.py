"""The oracle: a SLAM that is never wrong. It shows what the harness itself adds to the figures: nothing."""

import numpy as np
from pydantic import BaseModel, ConfigDict

from slamgym.geometry import inverse
from slamgym.slam.backend import SlamConfig
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult


class GroundTruthOptions(BaseModel):
    """It has none."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class GroundTruth:
    """Answers each frame's true pose relative to the first frame."""

    Options = GroundTruthOptions
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
        self._stamps_ns: list[int] = []
        self._poses: list[FloatArray] = []

    def track(self, frame: Frame) -> TrackResult:
        self._stamps_ns.append(frame.stamp_ns)
        self._poses.append(frame.T_world_cam)
        event = SlamEvent.NONE if len(self._poses) > 1 else SlamEvent.INITIALIZED
        T_map_cam = inverse(self._poses[0]) @ frame.T_world_cam
        return TrackResult(TrackingState.OK, T_map_cam, map_id=0, tracked_points=0, event=event)

    def finish(self) -> SlamTrajectory:
        T_world_cam = np.array(self._poses).reshape(-1, 4, 4)
        T_map_world = inverse(T_world_cam[0]) if len(T_world_cam) else np.eye(4)
        stamps_ns = np.array(self._stamps_ns, dtype=np.int64)
        return SlamTrajectory(stamps_ns, T_map_world @ T_world_cam, np.zeros(len(stamps_ns), dtype=np.int64))
