"""A SLAM run as the user's process sees it. Whatever the SLAM does, the user's program goes on."""

import os
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Literal, Self

import numpy as np

from slamgym.errors import SlamgymError
from slamgym.slam.backend import BACKENDS, SlamConfig, check_config, load_backend, untracked
from slamgym.slam.frame_buffer import FrameBuffer
from slamgym.slam.idle import check_lockstep_possible, wait_until_idle
from slamgym.slam.process import WorkerProcess
from slamgym.slam.worker import Reply
from slamgym.types import Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult

Sync = Literal["lockstep", "free"]

LOCKSTEP_LIMIT_S = 5.0
"""Longest wait for the SLAM's threads after one frame."""

START_FINISH_TIMEOUT_S = 120.0
"""Loading a large vocabulary or a last bundle adjustment may take this long."""

_TAIL_BYTES = 2**20


class SlamSession:
    """One SLAM over one sequence, in a process of its own.

    Raises ConfigError or SlamError at once when the backend cannot honour the configuration. `start` may be called long
    before the first frame, so that the SLAM loads while something else goes on. After a crash, a Python error of the
    backend, or no answer within `timeout_s` seconds, `outcome` says "crashed" or "timeout" and `track` answers LOST.

    sync: "lockstep" lets the SLAM's threads finish after each frame, "free" feeds the next frame as soon as the SLAM
    has answered. log_path: file for what the SLAM prints, overwritten; None keeps it in a temporary file.
    """

    def __init__(
        self,
        backend: str,
        config: SlamConfig,
        sync: Sync = "lockstep",
        timeout_s: float = 20.0,
        log_path: Path | None = None,
    ) -> None:
        check_config(backend, config)
        self._has_threads = load_backend(backend).has_background_threads
        self._lockstep = sync == "lockstep" and self._has_threads
        if self._lockstep:
            check_lockstep_possible()
        self.backend = BACKENDS.get(backend, backend)
        """As "module:class": the worker does not know names that a user registered."""
        self._config = config
        self._timeout_s = timeout_s
        self._log_path = log_path
        self._log: IO[bytes] | None = None
        self._frames: FrameBuffer | None = None
        self._worker: WorkerProcess | None = None
        self._ready = False
        self._told = False
        self.outcome: Literal["", "crashed", "timeout"] = ""
        self.frames_tracked = 0
        """Frames that the SLAM answered."""
        self.lockstep_wait_s = 0.0
        """Time spent waiting for the SLAM's threads, over all frames."""
        self.lockstep_overruns = 0
        """Frames after which the threads still worked when the longest wait was over."""

    @property
    def pid(self) -> int | None:
        """Process id of the worker, None before `start`."""
        return None if self._worker is None else self._worker.pid

    def start(self) -> None:
        """Start the process and let it load, without waiting for it; a second call does nothing."""
        if self._worker is not None:
            return
        self._log = self._log_path.open("w+b") if self._log_path else tempfile.TemporaryFile()  # noqa: SIM115
        self._frames = FrameBuffer(self._config.camera)
        self._worker = WorkerProcess(self._frames.fd, self._log)
        with suppress(ConnectionError):  # waiting for the answer will tell
            self._worker.send("start", self.backend, self._config)

    def wait_ready(self) -> None:
        """Block until the SLAM can take frames. Raises the SlamError of a backend that says what it lacks."""
        if self._ready or self.outcome:
            return
        self.start()
        _, value = self._receive(START_FINISH_TIMEOUT_S)
        self._ready = True
        if isinstance(value, SlamgymError):
            self.close()
            raise value

    def track(self, frame: Frame) -> TrackResult:
        """What the SLAM says about the next frame. Raises ConfigError when the images do not fit the camera."""
        self.wait_ready()
        if self._frames is not None:
            self._frames.write(frame)
        result = self._ask(self._timeout_s, "track", frame.stamp_ns, frame.T_world_cam)
        if not isinstance(result, TrackResult):
            return self._gone()
        self.frames_tracked += 1
        if self._lockstep:
            self._wait_for_threads()
        return result

    def finish(self) -> SlamTrajectory:
        """End the run; the poses that the SLAM stands by, none when it is gone."""
        self.wait_ready()
        if self._has_threads and self._worker is not None and not self.outcome:
            # What is still queued belongs to the run, and saving while threads work is a race.
            wait_until_idle(self._worker.pid, START_FINISH_TIMEOUT_S)
        trajectory = self._ask(START_FINISH_TIMEOUT_S, "finish")
        if isinstance(trajectory, SlamTrajectory):
            return trajectory
        return SlamTrajectory(np.empty(0, np.int64), np.empty((0, 4, 4)), np.empty(0, np.int64))

    def log_tail(self, lines: int = 15) -> str:
        """The last lines that the SLAM printed; empty before `start` and after `close`."""
        if self._log is None or self._log.closed:
            return ""
        size = os.fstat(self._log.fileno()).st_size
        # Read without moving the offset: the worker writes at the same one.
        tail = os.pread(self._log.fileno(), _TAIL_BYTES, max(0, size - _TAIL_BYTES))
        return "\n".join(tail.decode(errors="replace").splitlines()[-lines:])

    def close(self) -> None:
        """End the process if it still runs and free everything; a second call does nothing."""
        if self._worker is not None:
            self._worker.kill()
        if self._frames is not None:
            self._frames.close()
        if self._log is not None:
            self._log.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _ask(self, timeout_s: float, request: str, *arguments: Any) -> Any:
        """The answer, or None when the SLAM is gone."""
        if self.outcome or self._worker is None:
            return None
        with suppress(ConnectionError):
            self._worker.send(request, *arguments)
        ok, value = self._receive(timeout_s)
        return value if ok else None

    def _receive(self, timeout_s: float) -> Reply:
        assert self._worker is not None
        try:
            reply = self._worker.receive(timeout_s)
        except TimeoutError:
            return self._lose("timeout")
        except ConnectionError:
            return self._lose("crashed")
        return reply if reply[0] else self._lose("crashed", reply[1])

    def _lose(self, outcome: Literal["crashed", "timeout"], reason: Any = None) -> Reply:
        assert self._worker is not None
        self.outcome = outcome
        self._worker.kill()
        return False, reason

    def _gone(self) -> TrackResult:
        event = SlamEvent.NONE if self._told else SlamEvent(self.outcome)
        self._told = True
        return untracked(TrackingState.LOST, event)

    def _wait_for_threads(self) -> None:
        assert self._worker is not None
        begin = time.monotonic()
        self.lockstep_overruns += not wait_until_idle(self._worker.pid, LOCKSTEP_LIMIT_S)
        self.lockstep_wait_s += time.monotonic() - begin
