"""One estimate against the truth, both poses over time: accuracy and robustness of anybody's trajectories."""

import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
from pydantic import Field

from slamgym.checked_params import Params
from slamgym.errors import TrajectoryError, TrajectoryWarning
from slamgym.eval.robustness import covered_frames, find_gaps
from slamgym.eval.summary import (
    FramePoses,
    accuracy_summary,
    align_frames,
    correctness_summary,
    motion_summary,
    tracking_summary,
)
from slamgym.eval.trajectories import Trajectory, associate, fill_holes, match_stamps
from slamgym.types import BoolArray, IntArray, LossEvent, Summary


class EvalParams(Params):
    """How an estimate is compared with the truth."""

    alignment: Literal["se3", "sim3", "first_pose", "none"] = Field(
        "se3", description="of the estimate to the truth; sim3 also corrects the scale, which hides an error of RGB-D"
    )
    association: Literal["tum", "evo"] = Field("tum", description="by whose rule poses belong together")
    max_difference_s: float = Field(0.02, ge=0, le=3600, description="longest time between two such poses, s")
    max_gap_s: float = Field(
        1.0, ge=0, le=3600, description="longest time without a pose that counts as tracked, s; 0 when frames are given"
    )

    @property
    def max_difference_ns(self) -> int:
        return round(self.max_difference_s * 1e9)


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """What came out, at N frames.

    frames: their poses. real: int64 (M,), which of them the truth has a pose for; the others fill holes of it.
    tracked: bool (N,), which count as tracked. losses; summary: see `evaluate`.
    """

    frames: FramePoses
    real: IntArray
    tracked: BoolArray
    losses: list[LossEvent]
    summary: Summary


def evaluate(
    ref: Trajectory, est: Trajectory, params: EvalParams | None = None, frames_ns: IntArray | None = None
) -> Evaluation:
    """Compare the estimate with the truth.

    frames_ns: int64 (N,), increasing, the stamps of the frames that the SLAM was given. With them a frame is tracked
    when the estimate has a pose for it, and every run of frames without one, after the first pose, is a loss. Without
    them the poses of the truth stand for the frames, of which a camera takes fewer: so times without a pose up to
    `max_gap_s` count as tracked, and only longer ones are losses.

    The summary holds, in JSON types, NaN for what cannot be told:

    - `status`: "ok" (tracked at the end), "lost", "init_failed" (no pose); `success`: "ok" and no loss.
    - all of `accuracy_summary`, over the associated poses one after another, with `frames_ns` over the frames; `scale`
      that "sim3" corrected, else 1. NaN where the alignment needs more poses than there are.
    - all of `tracking_summary`, `correctness_summary` (`f1_area` only with `frames_ns`) and `motion_summary`;
      `time_to_initialize_s`.
    - `frames`; `poses` of the estimate; `matched`: those with a true pose.

    Raises TrajectoryError when no pose of the estimate has a true one; warns (TrajectoryWarning) when many have none,
    when frames have none, and of long holes in the truth.
    """
    params = params or EvalParams()
    truth = ref if frames_ns is None else _at_frames(ref, frames_ns, params)
    rows, pairs, scale = _aligned_pairs(truth, est, params)
    whole = truth if frames_ns is not None else _without_holes(truth, params.max_gap_s)
    real = np.searchsorted(whole.stamps_ns, truth.stamps_ns)
    frames = _by_frame(whole, real[rows], pairs)
    tracked = frames.tracked
    if frames_ns is None:
        tracked = tracked | covered_frames(whole.stamps_ns, est.stamps_ns, params.max_gap_s)
    losses = find_gaps(whole.stamps_ns, whole.T, tracked)
    summary = {
        **_outcome(tracked, losses),
        **accuracy_summary(pairs if frames_ns is None else frames),
        "scale": scale,
        **tracking_summary(whole.stamps_ns, whole.T, tracked, losses),
        **correctness_summary(frames, len(est)),
        "time_to_initialize_s": _time_to_first(frames),
        "frames": len(whole),
        "poses": len(est),
        "matched": len(rows),
        **motion_summary(whole.stamps_ns, whole.T),
    }
    if frames_ns is None:
        # The truth has more poses than the camera took frames: its recall says nothing.
        summary["f1_area"] = np.nan
    return Evaluation(frames, real, tracked, losses, summary)


def _without_holes(ref: Trajectory, max_gap_s: float) -> Trajectory:
    """The truth with its holes filled, so that getting lost in one counts, with a warning."""
    filled = fill_holes(ref, max_gap_s)
    if len(filled) > len(ref):
        holes_s = np.diff(ref.stamps_ns) * 1e-9
        warnings.warn(
            f"the truth has {np.sum(holes_s > max_gap_s)} holes of more than {max_gap_s:g} s, "
            f"{holes_s[holes_s > max_gap_s].sum():.1f} s in all: estimated poses in them cannot be judged, and do not "
            "count as correct",
            TrajectoryWarning,
            stacklevel=3,
        )
    return filled


def _at_frames(ref: Trajectory, frames_ns: IntArray, params: EvalParams) -> Trajectory:
    """The truth at the frames; those without a true pose are left out, with a warning."""
    rows, kept = match_stamps(ref.stamps_ns, frames_ns, params.max_difference_ns)
    if not len(kept):
        raise TrajectoryError(
            f"expected frames with a true pose within {params.max_difference_s:g} s, got {len(frames_ns)} without: "
            "are frames and truth of the same sequence?"
        )
    if without := len(frames_ns) - len(kept):
        warnings.warn(
            f"{without} of {len(frames_ns)} frames have no true pose within {params.max_difference_s:g} s and are left "
            "out: what the SLAM did there cannot be judged",
            TrajectoryWarning,
            stacklevel=3,
        )
    return Trajectory(frames_ns[kept], ref.T[rows])


def _aligned_pairs(truth: Trajectory, est: Trajectory, params: EvalParams) -> tuple[IntArray, FramePoses, float]:
    """Rows of the truth that have an estimated pose, these poses as pairs, and the scale of the alignment."""
    rows = est_rows = np.empty(0, dtype=np.int64)
    if len(est):
        rows, est_rows = associate(truth, est, params.max_difference_ns, params.association)
    # In every convention each pose of the shorter trajectory comes up at most once.
    stamps_ns = est.stamps_ns[est_rows] if len(est) <= len(truth) else truth.stamps_ns[rows]
    pairs = FramePoses(stamps_ns, truth.T[rows], est.T[est_rows], np.ones(len(rows), dtype=np.bool_))
    return rows, *align_frames(pairs, params.alignment)


def _by_frame(truth: Trajectory, rows: IntArray, pairs: FramePoses) -> FramePoses:
    est_T, tracked = np.full_like(truth.T, np.nan), np.zeros(len(truth), dtype=np.bool_)
    est_T[rows], tracked[rows] = pairs.est_T, True
    return FramePoses(truth.stamps_ns, truth.T, est_T, tracked, pairs.aligned)


def _outcome(tracked: BoolArray, losses: list[LossEvent]) -> Summary:
    status = "init_failed" if not tracked.any() else "ok" if tracked[-1] else "lost"
    return {"status": status, "success": status == "ok" and not losses}


def _time_to_first(frames: FramePoses) -> float:
    first = int(np.argmax(frames.tracked))
    return float(frames.stamps_ns[first] - frames.stamps_ns[0]) * 1e-9 if frames.tracked.any() else np.nan
