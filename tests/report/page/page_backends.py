"""SLAMs that go wrong as planned, so that a page has something to show. They run in the worker process."""

import os

import numpy as np

from slamgym.errors import SlamError
from slamgym.slam.backend import untracked
from slamgym.slam.groundtruth import GroundTruth
from slamgym.types import SlamEvent, TrackingState, TrackResult

LOST_FRAMES = (range(40, 52), range(60, 61))


class LosesTwice(GroundTruth):
    """A map until the first loss, another one, with its own origin, from then on."""

    def __init__(self, config):
        super().__init__(config)
        self.frames = 0

    def track(self, frame):
        number, self.frames = self.frames, self.frames + 1
        if any(number in lost for lost in LOST_FRAMES):
            return untracked(TrackingState.LOST, SlamEvent.LOST)
        second = number > LOST_FRAMES[0].start
        if number == LOST_FRAMES[0].stop:
            self._T_map_world = np.eye(4)
        T_map_cam = self.locate(frame.T_world_cam)
        T_map_cam[0, 3] += 0.05 * np.sin(number / 5)
        self._poses.append((frame.stamp_ns, T_map_cam, int(second)))
        event = SlamEvent.NEW_MAP if number == LOST_FRAMES[0].stop else SlamEvent.NONE
        return TrackResult(TrackingState.OK, T_map_cam, int(second), 300 - number, event)


class Crashes(GroundTruth):
    def track(self, frame):
        if len(self._poses) == 20:
            os.abort()
        return super().track(frame)


class Missing(GroundTruth):
    @classmethod
    def check(cls, config):  # noqa: ARG003
        raise SlamError("libslam.so is missing: install libslam")
