# ruff: noqa: ARG002, ARG003
"""SLAMs that get lost for one known reason, which they see in the frames alone. Loaded by name, in a worker process."""

import os

import cv2
import numpy as np

from slamgym.slam.backend import SlamOptions, untracked
from slamgym.types import SlamEvent, SlamTrajectory, TrackingState, TrackResult

DARK = 40.0
QUICK_PX = 15.0
CLEAR = 0.1
"""Below that, phase correlation has found no movement that is the image's."""


class Picky:
    Options = SlamOptions
    loop_closures = (False, True)
    has_background_threads = False
    offline = False

    @classmethod
    def check(cls, config):
        pass

    @classmethod
    def versions(cls, config):
        return {}

    def __init__(self, config):
        self.before = None
        self.poses = []

    def track(self, frame):
        grey = frame.rgb.mean(axis=2).astype(np.float32)
        lost = self.poses and self.cannot_bear(grey)
        self.before = grey
        if lost:
            return untracked(TrackingState.LOST, SlamEvent.LOST)
        self.poses.append((frame.stamp_ns, np.eye(4), 0))
        return TrackResult(TrackingState.OK, np.eye(4), 0, 100)

    def finish(self):
        return SlamTrajectory.of(self.poses)


class AfraidOfTheDark(Picky):
    def cannot_bear(self, grey):
        return grey.mean() < DARK


class Dizzy(Picky):
    """Minds how far the whole image has moved since the last one."""

    def cannot_bear(self, grey):
        window = cv2.createHanningWindow(grey.shape[::-1], cv2.CV_32F)
        (dx, _), response = cv2.phaseCorrelate(self.before, grey, window)
        return abs(dx) > QUICK_PX and response > CLEAR


class Dies(Picky):
    """Takes its whole process with it, at the fifth frame."""

    def cannot_bear(self, grey):
        if len(self.poses) == 4:
            os._exit(1)
        return False


class Late(Picky):
    """Needs a frame to begin with."""

    def track(self, frame):
        if self.before is None:
            self.before = frame.rgb
            return untracked(TrackingState.NOT_INITIALIZED)
        return super().track(frame)

    def cannot_bear(self, grey):
        return False
