"""Which frames were tracked, losses, status, success.

A frame is tracked when its state was OK as it was fed; poses that a SLAM writes for other frames are guesses, and never
count.
"""

from dataclasses import replace
from typing import cast

from slamgym.eval.robustness.gaps import find_gaps, seconds
from slamgym.types import BoolArray, LossEvent, SlamEvent, SlamRecord, TrackingState

STATUSES = ("ok", "lost", "init_failed", "crashed", "timeout")
"""All that `status` may say."""

_OUTCOMES = {
    SlamEvent.RELOCALIZED: "relocalized",
    SlamEvent.MAPS_MERGED: "relocalized",
    SlamEvent.NEW_MAP: "new_map",
    SlamEvent.MAP_RESET: "map_reset",
}


def tracked_frames(record: SlamRecord) -> BoolArray:
    """Whether the state was OK, for each fed frame (N,)."""
    return cast(BoolArray, record.states == TrackingState.OK)


def find_losses(record: SlamRecord) -> list[LossEvent]:
    """Maximal runs of fed frames, after the first initialisation, whose state is not OK.

    As `find_gaps`; the outcome is told by the event of the first tracked frame after the run, and where that says
    nothing of it, by whether the map is still the one from before.
    """
    gaps = find_gaps(record.stamps_ns, record.T_world_cam, tracked_frames(record))
    return [replace(gap, outcome=_outcome(record, gap.start_frame, gap.end_frame)) for gap in gaps]


def _outcome(record: SlamRecord, start: int, end: int) -> str:
    after = end + 1
    if after == len(record.states):
        return "never"
    same_map = record.map_id[start - 1] == record.map_id[after]
    return _OUTCOMES.get(record.events[after], "relocalized" if same_map else "new_map")


def seconds_between(record: SlamRecord, first: int, last: int) -> float:
    """Time from one fed frame to another, seconds."""
    return seconds(record.stamps_ns, first, last)


def status(record: SlamRecord) -> str:
    """How the run ended: "crashed", "timeout", "init_failed" (never tracked), "ok" (tracked at the end) or "lost"."""
    ok = tracked_frames(record)
    if record.outcome:
        return record.outcome
    if not ok.any():
        return "init_failed"
    return "ok" if ok[-1] else "lost"


def success(record: SlamRecord) -> bool:
    """Whether the SLAM tracked to the end without any loss."""
    return status(record) == "ok" and not find_losses(record)
