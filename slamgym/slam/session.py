"""A SLAM run as the user's process sees it. Whatever the SLAM does, the user's program goes on.

How the frames reach the SLAM is the `sync`; what each means for a result:

- "lockstep": the next frame waits until the SLAM's threads only idle, so how fast the computer is hardly matters. For
  results that others should be able to repeat.
- "realtime": frames come by the wall clock, as from a camera. Those that come while the SLAM is busy are dropped (when
  a recorded sequence is replayed; in a live drive they wait, and how late they were is told). The result is that of
  this SLAM on this computer under its present load.
- "free": each frame follows as soon as the SLAM has answered the last one. Its threads may lag behind as they never
  would with a camera, or get more time: quick, and good for nothing but a first look.
"""

import time
import warnings
from contextlib import ExitStack, closing
from dataclasses import dataclass
from typing import Any, Literal, Self, cast

from slamgym.errors import SlamError, SlamgymError, TrajectoryWarning
from slamgym.slam.backend import SlamConfig, backend_target, check_config, untracked
from slamgym.slam.frame_buffer import FrameBuffer
from slamgym.slam.idle import check_lockstep_possible, wait_until_idle
from slamgym.slam.log_file import LogFile
from slamgym.slam.process import Outcome, WorkerLostError, WorkerProcess
from slamgym.slam.scratch import ScratchFolder
from slamgym.types import FloatArray, Frame, SlamEvent, SlamTrajectory, TrackingState, TrackResult

Sync = Literal["lockstep", "realtime", "free"]

LOCKSTEP_LIMIT_S = 5.0
"""Longest wait for the SLAM's threads after one frame."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a SLAM may take before it is ended. frame_s: time for a frame. finish_s: time to load, and time to end, with
    a last bundle adjustment, or the whole work of an offline backend. memory_mb: memory.
    """

    frame_s: float = 20.0
    finish_s: float = 120.0
    memory_mb: float = 8000.0


class SlamSession:
    """One SLAM over one sequence, in a process of its own.

    Raises ConfigError or SlamError at once when the backend cannot honour the configuration. `start` may be called long
    before the first frame, so that the SLAM loads while something else goes on. After a crash, a Python error of the
    backend, too much memory, or no answer in time, `outcome` says "crashed" or "timeout", `failure` what happened, and
    `track` answers LOST.

    sync: see above; pacing by the wall clock is up to who feeds the frames.
    """

    def __init__(
        self,
        backend: str,
        config: SlamConfig,
        sync: Sync = "lockstep",
        limits: Limits = Limits(),
    ) -> None:
        kind = check_config(backend, config)
        self._has_threads = kind.has_background_threads
        self._lockstep = sync == "lockstep" and self._has_threads
        if self._lockstep:
            check_lockstep_possible()
        self.backend = backend_target(backend)
        """As "module:class": the worker does not know names that a user registered."""
        self.offline = kind.offline
        self.sync: Sync = sync
        self.config = config
        self._limits = limits
        self._log: LogFile | None = None
        self._frames: FrameBuffer | None = None
        self._worker: WorkerProcess | None = None
        self._opened = ExitStack()
        self._closed = False
        self._ready = False
        self._told = False
        self.outcome: Literal["", "crashed", "timeout"] = ""
        self.failure = ""
        """What happened, in one line, when there is an outcome."""
        self.track_s: list[float] = []
        """Time that the SLAM took for each frame that it answered, without the wait for its threads."""
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
        if self._closed:
            raise SlamError("slam session: expected an open one, got one after its close; make a new one")
        if self._worker is not None:
            return
        try:
            with ExitStack() as opened:
                self._log = opened.enter_context(closing(LogFile()))
                self._frames = opened.enter_context(closing(FrameBuffer(self.config.camera)))
                scratch = opened.enter_context(closing(ScratchFolder()))
                limit_mb = self._limits.memory_mb
                self._worker = WorkerProcess(self._frames.fd, self._log, scratch.path, limit_mb)
                opened.callback(self._worker.kill)
                self._opened = opened.pop_all()
        except OSError as error:
            raise SlamError(f"slam session: cannot start a process for the SLAM: {error}; free what it lacks") from None
        self._worker.send("start", self.backend, self.config)

    def wait_ready(self) -> None:
        """Block until the SLAM can take frames. Raises the SlamError of a backend that says what it lacks."""
        self.start()
        if self._ready or self.outcome:
            return
        error = self._receive(self._limits.finish_s, "while it loaded")
        self._ready = True
        if isinstance(error, SlamgymError):
            self.close()
            raise error

    def track(self, frame: Frame) -> TrackResult:
        """What the SLAM says about the next frame. Raises ConfigError when the images do not fit the camera."""
        self.wait_ready()
        assert self._frames is not None
        if not self.outcome:
            self._frames.write(frame)
        begin = time.monotonic()
        moment = f"at frame {len(self.track_s)}"
        result = self._ask(self._limits.frame_s, moment, "track", frame.stamp_ns, frame.T_world_cam)
        if not isinstance(result, TrackResult):
            return self._gone()
        self.track_s.append(time.monotonic() - begin)
        if self._lockstep:
            begin = time.monotonic()
            self.lockstep_overruns += not self._wait_until_idle(
                LOCKSTEP_LIMIT_S, f"after frame {len(self.track_s) - 1}"
            )
            self.lockstep_wait_s += time.monotonic() - begin
        return result

    def map_points(self) -> FloatArray | None:
        """Points (N, 3) of the map that the last frame was tracked by, metres in that map's frame; after a frame that
        was not tracked they mean nothing. None when the SLAM is gone, or its backend does not tell them.
        """
        moment = f"when asked for its map after frame {len(self.track_s) - 1}"
        return cast(FloatArray | None, self._ask(self._limits.frame_s, moment, "map_points"))

    def finish(self) -> SlamTrajectory:
        """End the run; the poses that the SLAM stands by, none when it is gone.

        Warns (TrajectoryWarning) of what had to be repaired in them.
        """
        self.wait_ready()
        if self._has_threads and self._worker is not None and not self.outcome:
            # What is still queued belongs to the run, and saving while threads work is a race.
            self._wait_until_idle(self._limits.finish_s, "when it was to end")
        answer = self._ask(self._limits.finish_s, "when it was to end", "finish")
        if answer is not None:
            trajectory, warned = answer
            for message in warned:
                warnings.warn(message, TrajectoryWarning, stacklevel=2)
            return cast(SlamTrajectory, trajectory)
        return SlamTrajectory.of()

    def log(self) -> str:
        """What the SLAM printed, the last MiB of it; empty before `start` and after `close`."""
        return self._log.tail() if self._log is not None else ""

    def close(self) -> None:
        """End the process if it still runs and free everything; a second call does nothing."""
        self._closed = True
        self._opened.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def _ask(self, timeout_s: float, moment: str, request: str, *arguments: Any) -> Any:
        """The answer, or None when the SLAM is gone."""
        if self.outcome or self._worker is None:
            return None
        self._worker.send(request, *arguments)
        value = self._receive(timeout_s, moment)
        return None if self.outcome else value

    def _receive(self, timeout_s: float, moment: str) -> Any:
        """What the worker answers, or what it failed with; `moment` says when, for `failure`."""
        assert self._worker is not None
        try:
            ok, value = self._worker.receive(timeout_s)
        except WorkerLostError as lost:
            self._lose(lost.outcome, f"{lost.why} {moment}")
            return None
        if not ok:
            text = str(value).strip() or type(value).__name__
            self._lose("crashed", f"{text.splitlines()[0]} ({moment})")
        return value

    def _lose(self, outcome: Outcome, failure: str) -> None:
        assert self._worker is not None
        self.outcome, self.failure = outcome, failure
        self._worker.kill()

    def _gone(self) -> TrackResult:
        event = SlamEvent.NONE if self._told else SlamEvent(self.outcome)
        self._told = True
        return untracked(TrackingState.LOST, event)

    def _wait_until_idle(self, limit_s: float, moment: str) -> bool:
        """Whether the SLAM's threads idled in time; a SLAM that takes too much memory meanwhile is ended."""
        assert self._worker is not None
        try:
            return wait_until_idle(self._worker.pid, limit_s, self._worker.look_after)
        except WorkerLostError as lost:
            self._lose(lost.outcome, f"{lost.why} {moment}")
            return True
