"""Which frames were tracked, what is known of their true poses, losses, status, success.

A frame is tracked when its state was OK as it was fed; poses that a SLAM writes for other frames are guesses, and never
count.
"""

from dataclasses import replace
from typing import cast

import numpy as np

from slamgym.eval.robustness.gaps import find_gaps
from slamgym.eval.trajectories import Trajectory, interpolate
from slamgym.types import BoolArray, FloatArray, LossEvent, SlamEvent, SlamRecord, TrackingState

STATUSES = ("ok", "lost", "init_failed", "crashed", "timeout")
"""All that `status` may say."""

SUCCESS_COMPLETION = 0.5
"""Share of the frames that a successful run tracks at least; see `is_success`."""

_OUTCOMES = {
    SlamEvent.RELOCALIZED: "relocalized",
    SlamEvent.MAPS_MERGED: "relocalized",
    SlamEvent.NEW_MAP: "new_map",
    SlamEvent.MAP_RESET: "map_reset",
}


def tracked_frames(record: SlamRecord) -> BoolArray:
    """Whether the state was OK, for each fed frame (N,)."""
    return cast(BoolArray, record.states == TrackingState.OK)


def true_poses(record: SlamRecord) -> tuple[FloatArray | None, BoolArray]:
    """True poses (N, 4, 4), to measure the path by, and which of them an estimated pose may be judged by, bool (N,).

    A pose that is NaN is interpolated between its neighbours, or that of the first or last known one beyond these;
    None where no pose is known at all.
    """
    T, stamps_ns = record.T_world_cam, record.stamps_ns
    known = np.asarray(np.isfinite(T).all(axis=(1, 2)))
    real = known if record.has_truth is None else known & record.has_truth
    if known.all():
        return T, real
    if not known.any():
        return None, real
    return interpolate(Trajectory(stamps_ns[known], T[known]), stamps_ns), real


def find_losses(record: SlamRecord) -> list[LossEvent]:
    """Maximal runs of fed frames, after the first initialisation, whose state is not OK.

    As `find_gaps`, by the `true_poses`; the outcome is told by the event of the first tracked frame after the run, and
    where that says nothing of it, by whether the map is still the one from before. The context is the record's.
    """
    gaps = find_gaps(record.stamps_ns, true_poses(record)[0], tracked_frames(record))
    return [replace(gap, outcome=_outcome(record, gap), context=record.contexts.get(gap.start_frame)) for gap in gaps]


def _outcome(record: SlamRecord, gap: LossEvent) -> str:
    after = gap.end_frame + 1
    if after == len(record.states):
        return "never"
    same_map = record.map_id[gap.start_frame - 1] == record.map_id[after]
    return _OUTCOMES.get(record.events[after], "relocalized" if same_map else "new_map")


def status(record: SlamRecord) -> str:
    """How the run ended: "crashed", "timeout", "init_failed" (never tracked), "ok" (tracked at the end) or "lost"."""
    ok = tracked_frames(record)
    if record.outcome:
        return record.outcome
    if not ok.any():
        return "init_failed"
    return "ok" if ok[-1] else "lost"


def is_success(status: str, loss_count: int, completion: float) -> bool:
    """Whether a run succeeded: tracked at its end ("ok"), without any loss, and for at least SUCCESS_COMPLETION of the
    frames: one that initialised just before its end has not.
    """
    return status == "ok" and loss_count == 0 and completion >= SUCCESS_COMPLETION
