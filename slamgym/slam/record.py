"""From the frames that a SLAM is fed to the record that the evaluation needs."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from typing import NamedTuple

import numpy as np

from slamgym.computer import computer_name
from slamgym.eval.robustness import untracked_runs
from slamgym.slam.history import FrameHistory, WholeHistory
from slamgym.slam.pace import Pace
from slamgym.slam.session import SlamSession
from slamgym.types import (
    BoolArray,
    FloatArray,
    Frame,
    IntArray,
    LossContext,
    SlamEvent,
    SlamRecord,
    SlamTrajectory,
    TrackingState,
    TrackResult,
)

TAIL_LINES = 15
LONGEST_LINE = 300

_OTHER_STAMPS = "none of its final poses has the stamp of a frame: expected the stamps_ns of the frames"


class Fed(NamedTuple):
    """One frame's stamp and true pose, and what the SLAM said about it."""

    stamp_ns: int
    T_world_cam: FloatArray
    has_truth: bool
    result: TrackResult


class SlamRun:
    """One SLAM run: frames go in one by one, in the end a record comes out.

    In real time each frame waits until it is due; one that is late is fed all the same.
    """

    def __init__(self, session: SlamSession) -> None:
        self._session = session
        self._fed: list[Fed] = []
        self._initialized = self._lost = False
        self._history = FrameHistory(session.config.camera)
        self._whole = WholeHistory(session.config.camera) if session.offline else None
        self._contexts: dict[int, LossContext] = {}
        self._pace = Pace() if session.sync == "realtime" else None
        self._late_s: list[float] = []
        self._frames_dropped = 0
        self._ended = ""

    @property
    def last(self) -> TrackResult:
        """The answer to the last frame."""
        return self._fed[-1].result

    def feed(self, frame: Frame) -> TrackResult:
        """Give one frame to the SLAM."""
        self._session.wait_ready()
        if self._pace is not None and not self._session.outcome:
            self._late_s.append(self._pace.wait_for(frame.stamp_ns))
        result = self._session.track(frame)
        self._fed.append(Fed(frame.stamp_ns, frame.T_world_cam, frame.has_truth, result))
        if self._whole is not None:
            self._whole.add(frame)
        elif not self._session.outcome or result.event:
            self._history.add(frame, result)
            self._note_loss(result)
        return result

    def feed_or_drop(self, frame: Frame, following: Frame | None) -> None:
        """Feed a frame of a recording, unless in real time the one after it is due already.

        Once the SLAM is gone nothing is dropped: what it was not there for is not tracked.
        """
        overtaken = self._pace is not None and following is not None and self._pace.late_s(following.stamp_ns) >= 0
        if overtaken and not self._session.outcome:
            self._frames_dropped += 1
        else:
            self.feed(frame)

    def finish(self) -> SlamRecord:
        """End the run and put together the record of its frames, of which there must be at least one."""
        final = self._session.finish()
        self._ended = datetime.now(UTC).isoformat(timespec="seconds")
        results = [one.result for one in self._fed]
        truth_known = np.array([one.has_truth for one in self._fed])
        record = SlamRecord(
            stamps_ns=np.array([one.stamp_ns for one in self._fed], dtype=np.int64),
            T_world_cam=np.array([one.T_world_cam for one in self._fed]),
            states=np.array([result.state for result in results], dtype=np.int64),
            T_map_cam=np.array([result.T_map_cam for result in results]),
            map_id=np.array([result.map_id for result in results], dtype=np.int64),
            tracked_points=np.array([result.tracked_points for result in results], dtype=np.int64),
            events=tuple(result.event for result in results),
            final=final,
            has_truth=None if truth_known.all() else truth_known,
            outcome=self._session.outcome,
            failure=self._session.failure,
            log_tail=_last_lines(self._session.log()) if self._session.outcome else "",
            contexts=self._contexts,
            lockstep_overruns=self._session.lockstep_overruns,
            frames_dropped=self._frames_dropped,
        )
        if self._whole is not None:
            return _with_states_of(record, final, self._whole)
        if len(final.stamps_ns) and not np.isin(final.stamps_ns, record.stamps_ns).any():
            return replace(record, outcome="crashed", failure=_OTHER_STAMPS)
        return record

    def timing(self) -> dict[str, float | str]:
        """What the run took, and where; NaN where nothing was timed.

        `track_ms_median`, `track_ms_p95`: time of the SLAM for a frame; `lockstep_wait_s`: for its threads, in all;
        `late_ms_median`, `late_ms_max`: how late frames were fed in real time;
        `computer`: its processor; `ended`: when, in UTC as of ISO 8601, "" before.
        """
        track_ms, late_ms = 1e3 * np.array(self._session.track_s), 1e3 * np.array(self._late_s)
        return {
            "track_ms_median": float(np.median(track_ms)) if len(track_ms) else np.nan,
            "track_ms_p95": float(np.percentile(track_ms, 95)) if len(track_ms) else np.nan,
            "lockstep_wait_s": self._session.lockstep_wait_s,
            "late_ms_median": float(np.median(late_ms)) if len(late_ms) else np.nan,
            "late_ms_max": float(late_ms.max()) if len(late_ms) else np.nan,
            "computer": computer_name(),
            "ended": self._ended,
        }

    def _note_loss(self, result: TrackResult) -> None:
        """At the first frame of a loss, note what was seen: only now are the images at hand."""
        ok = result.state is TrackingState.OK
        if not ok and self._initialized and not self._lost:
            context = self._history.context()
            if outcome := self._session.outcome:
                context = replace(context, cause=outcome, explanation=self._session.failure)
            self._contexts[len(self._fed) - 1] = context
        self._initialized |= ok
        self._lost = not ok


def _last_lines(text: str) -> str:
    return "\n".join(line[:LONGEST_LINE] for line in text.splitlines()[-TAIL_LINES:])


def run_sequence(run: SlamRun, frames: Iterable[Frame]) -> SlamRecord:
    """Feed a whole sequence, in order. In real time a frame is dropped when the next one is due before it could be fed.

    When the SLAM is gone, the frames that are left count as not tracked.
    """
    for frame, following in _with_next(frames):
        run.feed_or_drop(frame, following)
    return run.finish()


def _with_next(frames: Iterable[Frame]) -> Iterator[tuple[Frame, Frame | None]]:
    before: Frame | None = None
    for frame in frames:
        if before is not None:
            yield before, frame
        before = frame
    if before is not None:
        yield before, None


def _with_states_of(record: SlamRecord, final: SlamTrajectory, history: WholeHistory) -> SlamRecord:
    """The record of an offline backend: a frame was tracked when the final trajectory has a pose at its stamp."""
    tracked: BoolArray = np.isin(record.stamps_ns, final.stamps_ns)
    map_id = np.full(len(tracked), -1, dtype=np.int64)
    map_id[tracked] = final.map_id[np.searchsorted(final.stamps_ns, record.stamps_ns[tracked])]
    states = np.where(tracked, TrackingState.OK, TrackingState.LOST).astype(np.int64)
    states[~np.logical_or.accumulate(tracked)] = TrackingState.NOT_INITIALIZED
    return replace(
        record,
        states=states,
        map_id=map_id,
        events=_events(tracked, map_id),
        contexts={start: history.context(start, tracked) for start, _ in untracked_runs(tracked)},
    )


def _events(tracked: BoolArray, map_id: IntArray) -> tuple[SlamEvent, ...]:
    events = [SlamEvent.NONE] * len(tracked)
    if tracked.any():
        events[int(np.argmax(tracked))] = SlamEvent.INITIALIZED
    for start, after in untracked_runs(tracked):
        events[start] = SlamEvent.LOST
        if after < len(tracked):
            same_map = map_id[start - 1] == map_id[after]
            events[after] = SlamEvent.RELOCALIZED if same_map else SlamEvent.NEW_MAP
    return tuple(events)
