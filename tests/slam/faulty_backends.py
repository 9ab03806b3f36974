# ruff: noqa: ARG002, ARG003
"""SLAMs that misbehave, for the harness to survive. They run in the worker process."""

import ctypes
import os
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import replace

import numpy as np

from slamgym.errors import SlamError
from slamgym.slam.backend import SlamConfig, SlamOptions, untracked
from slamgym.types import Frame, SlamTrajectory, TrackingState, TrackResult


class FaultOptions(SlamOptions):
    """fault_frame: the frame, counted from 1, that it misbehaves at."""

    fault_frame: int = 3


class Healthy:
    """Answers the mean grey value as its number of tracked points, so that tests see which frame it got."""

    Options = FaultOptions
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
        self.fault_frame = FaultOptions.checked(config.options).fault_frame

    def track(self, frame: Frame) -> TrackResult:
        self.stamps_ns.append(frame.stamp_ns)
        if len(self.stamps_ns) == self.fault_frame:
            self.misbehave()
        return TrackResult(TrackingState.OK, np.eye(4), 0, int(frame.rgb.mean()))

    def misbehave(self) -> None:
        pass

    def finish(self) -> SlamTrajectory:
        return SlamTrajectory.of([(stamp_ns, np.eye(4), 0) for stamp_ns in self.stamps_ns])


class Sleeps(Healthy):
    def misbehave(self) -> None:
        time.sleep(1e6)


class HoldsGil(Healthy):
    """Hangs as C++ code does that never gives the interpreter lock back."""

    def misbehave(self) -> None:
        ctypes.PyDLL(None).sleep(1_000_000)


class Spins(Healthy):
    def misbehave(self) -> None:
        while True:
            pass


class Segfaults(Healthy):
    def misbehave(self) -> None:
        ctypes.string_at(0)


class GrowsMemory(Healthy):
    """10 MB a time, without an end."""

    def misbehave(self) -> None:
        hoard = []
        while True:
            hoard.append(b"x" * 10_000_000)
            time.sleep(0.002)


class LeavesChildren(Healthy):
    """Starts a program that starts another, and hangs."""

    def misbehave(self) -> None:
        subprocess.Popen([sys.executable, "-c", "import subprocess; subprocess.run(['sleep', '1000'])"])
        time.sleep(1e6)


class LeavesFiles(Healthy):
    def misbehave(self) -> None:
        tempfile.mkdtemp()
        os.abort()


class Aborts(Healthy):
    def misbehave(self) -> None:
        os.abort()


class Exits(Healthy):
    def misbehave(self) -> None:
        os._exit(0)


class Raises(Healthy):
    def misbehave(self) -> None:
        raise ValueError("the third frame is one too many")


class RaisesOwnError(Healthy):
    """An error of slamgym's own that comes while tracking is a crash like any other."""

    def misbehave(self) -> None:
        raise SlamError("raised while tracking")


class Chatters(Healthy):
    """50 MB on the file descriptors that C++ writes to."""

    def misbehave(self) -> None:
        line = b"x" * 1023 + b"\n"
        for _ in range(25):
            os.write(1, line * 1024)
            os.write(2, line * 1024)
        os.write(1, b"the last line\n")


class AnswersUnpicklable(Healthy):
    def track(self, frame: Frame) -> TrackResult:
        return lambda: None  # type: ignore[return-value]


class AnswersNothing(Healthy):
    def track(self, frame: Frame) -> TrackResult:
        return None  # type: ignore[return-value]


class LacksLibrary(Healthy):
    def __init__(self, config: SlamConfig) -> None:
        raise SlamError("libslam.so is missing; install it")


class AbortsAtStart(Healthy):
    def __init__(self, config: SlamConfig) -> None:
        os.abort()


class AbortsAtFinish(Healthy):
    def finish(self) -> SlamTrajectory:
        os.abort()


class HangsAtFinish(Healthy):
    def finish(self) -> SlamTrajectory:
        time.sleep(1e6)
        raise AssertionError


class WorksBehind(Healthy):
    """A thread of its own works for 0.1 s after each frame."""

    has_background_threads = True

    def track(self, frame: Frame) -> TrackResult:
        threading.Thread(target=_burn_cpu, args=(0.1,)).start()
        return super().track(frame)


class WorksForEver(WorksBehind):
    def track(self, frame: Frame) -> TrackResult:
        threading.Thread(target=_burn_cpu, args=(1e6,), daemon=True).start()
        return Healthy.track(self, frame)


class Polls(Healthy):
    """A thread that looks for work every 3 ms and finds none: that is idling."""

    has_background_threads = True

    def __init__(self, config: SlamConfig) -> None:
        super().__init__(config)
        threading.Thread(target=_poll, daemon=True).start()


def _burn_cpu(seconds: float) -> None:
    until = time.thread_time() + seconds
    while time.thread_time() < until:
        pass


def _poll() -> None:
    while True:
        time.sleep(0.003)


class LosesEveryThird(Healthy):
    def track(self, frame: Frame) -> TrackResult:
        result = super().track(frame)
        return untracked(TrackingState.LOST) if len(self.stamps_ns) % 3 == 0 else result


class Slow(Healthy):
    """Takes 0.1 s for a frame."""

    def track(self, frame: Frame) -> TrackResult:
        time.sleep(0.1)
        return super().track(frame)


class LostForThree(Healthy):
    """Lost from the fault's frame on, for three frames."""

    def track(self, frame: Frame) -> TrackResult:
        result = super().track(frame)
        lost = self.fault_frame <= len(self.stamps_ns) < self.fault_frame + 3
        return untracked(TrackingState.LOST) if lost else result


class Offline(Healthy):
    """Answers only at the end, with poses for all frames but the first and the third."""

    offline = True

    def track(self, frame: Frame) -> TrackResult:
        super().track(frame)
        return untracked(TrackingState.NOT_INITIALIZED)

    def finish(self) -> SlamTrajectory:
        self.stamps_ns = [stamp for k, stamp in enumerate(self.stamps_ns) if k not in (0, 2)]
        return super().finish()


class AnswersNanPoses(Healthy):
    def track(self, frame: Frame) -> TrackResult:
        return replace(super().track(frame), T_map_cam=np.full((4, 4), np.nan))


class FinishesWithNanPoses(Healthy):
    def finish(self) -> SlamTrajectory:
        final = super().finish()
        return replace(final, T_map_cam=np.full_like(final.T_map_cam, np.nan))


class FinishesWithOtherStamps(Healthy):
    """In microseconds, say."""

    def finish(self) -> SlamTrajectory:
        final = super().finish()
        return replace(final, stamps_ns=final.stamps_ns // 1000 + 1)


class LeavesASession(Healthy):
    """Starts a program in a session of its own through one that ends at once, as launchers do, and hangs."""

    def misbehave(self) -> None:
        program = "import subprocess; subprocess.Popen(['sleep', '1000'], start_new_session=True)"
        subprocess.run([sys.executable, "-c", program], check=True)
        time.sleep(1e6)


class GrowsBehind(Healthy):
    """A thread of its own takes ever more memory after the fault's frame."""

    has_background_threads = True

    def misbehave(self) -> None:
        threading.Thread(target=_hoard, daemon=True).start()


def _hoard() -> None:
    hoard: list[bytes] = []
    while len(hoard) < 200:
        hoard.append(b"x" * 10_000_000)
        time.sleep(0.002)
    _burn_cpu(1e6)
