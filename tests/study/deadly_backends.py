# ruff: noqa: ARG003
"""SLAMs that end the process which feeds them. They run in the SLAM's own process, whose parent that is."""

import os
import signal
import time
from pathlib import Path

import numpy as np

from slamgym.slam.backend import SlamConfig, SlamOptions
from slamgym.types import Frame, SlamTrajectory, TrackingState, TrackResult


class OnceOptions(SlamOptions):
    """marker: a file that is made when it happens; where it is there, nothing happens."""

    marker: Path = Path("/nowhere")


class KillsItsWorker:
    """Stands still, and kills its worker at the third frame."""

    Options = SlamOptions
    loop_closures = (False,)
    has_background_threads = False
    offline = False

    @classmethod
    def check(cls, config: SlamConfig) -> None:
        pass

    @classmethod
    def versions(cls, config: SlamConfig) -> dict[str, str]:
        return {}

    def __init__(self, config: SlamConfig) -> None:
        self.stamps_ns: list[int] = []
        self.config = config

    def track(self, frame: Frame) -> TrackResult:
        self.stamps_ns.append(frame.stamp_ns)
        if len(self.stamps_ns) == 3:
            self.misbehave()
        return TrackResult(TrackingState.OK, np.eye(4), 0, 100)

    def misbehave(self) -> None:
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(1e6)

    def finish(self) -> SlamTrajectory:
        return SlamTrajectory.of([(stamp_ns, np.eye(4), 0) for stamp_ns in self.stamps_ns])


class KillsItsWorkerOnce(KillsItsWorker):
    Options = OnceOptions

    def misbehave(self) -> None:
        marker = OnceOptions.checked(self.config.options).marker
        if not marker.exists():
            marker.touch()
            super().misbehave()
