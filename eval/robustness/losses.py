"""Which frames were tracked, losses, status, success.

A frame is tracked when its state was OK as it was fed; poses that a SLAM writes for other frames are guesses, and never
count.
"""

from typing import cast

import numpy as np

from slamgym.geometry import inverse, rotation_angle
from slamgym.types import BoolArray, FloatArray, LossEvent, SlamEvent, SlamRecord, TrackingState

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

    `start_s` counts from the first fed frame. Distance and rotation are those of the true path, added up from frame to
    frame. The outcome is told by the event of the first tracked frame after the run, and where that says nothing of it,
    by whether the map is still the one from before.
    """
    ok = tracked_frames(record)
    first = int(np.argmax(ok)) if ok.any() else len(ok)
    # A tracked frame past the end closes a run that is still open there.
    edges = first + np.flatnonzero(np.diff(np.append(ok[first:], True)))
    starts, ends = edges[0::2] + 1, edges[1::2]
    return [_loss(record, int(start), int(end)) for start, end in zip(starts, ends, strict=True)]


def _loss(record: SlamRecord, start: int, end: int) -> LossEvent:
    after = min(end + 1, len(record.states) - 1)
    distance_m, rotation_rad = _motion(record.T_world_cam[start : after + 1])
    return LossEvent(
        start_frame=start,
        end_frame=end,
        start_s=seconds_between(record, 0, start),
        duration_s=seconds_between(record, start, after),
        distance_m=distance_m,
        rotation_deg=float(np.rad2deg(rotation_rad)),
        outcome=_outcome(record, start, end),
    )


def _outcome(record: SlamRecord, start: int, end: int) -> str:
    after = end + 1
    if after == len(record.states):
        return "never"
    same_map = record.map_id[start - 1] == record.map_id[after]
    return _OUTCOMES.get(record.events[after], "relocalized" if same_map else "new_map")


def _motion(T: FloatArray) -> tuple[float, float]:
    """Length in metres and turning in radians of the path along the poses (N, 4, 4)."""
    if len(T) < 2:
        return 0.0, 0.0
    steps = inverse(T[:-1]) @ T[1:]
    return float(np.linalg.norm(steps[:, :3, 3], axis=1).sum()), float(rotation_angle(steps).sum())


def seconds_between(record: SlamRecord, first: int, last: int) -> float:
    """Time from one fed frame to another, seconds."""
    return float(record.stamps_ns[last] - record.stamps_ns[first]) * 1e-9


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
