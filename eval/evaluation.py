"""One estimate against the truth, both poses over time: accuracy and robustness of anybody's trajectories."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from slamgym.eval import doubts
from slamgym.eval.reference import EvalParams, Reference, max_gap_s, prepare
from slamgym.eval.robustness import covered_frames, find_gaps, held_ate, is_success
from slamgym.eval.summary import (
    MOTION_RATES,
    FramePoses,
    accuracy_summary,
    align_frames,
    correctness_summary,
    motion_summary,
    tracking_summary,
)
from slamgym.eval.trajectories import Trajectory, associate, match_stamps, step_sizes
from slamgym.types import BoolArray, IntArray, LossEvent, Summary


@dataclass(frozen=True, slots=True, eq=False)
class Evaluation:
    """What came out, at N frames.

    frames: their poses; real: bool (N,), where the truth has a pose; tracked: bool (N,), which frames count as tracked;
    losses; summary: see `evaluate`.
    """

    frames: FramePoses
    real: BoolArray
    tracked: BoolArray
    losses: list[LossEvent]
    summary: Summary


def evaluate(
    ref: Trajectory, est: Trajectory, params: EvalParams | None = None, frames_ns: IntArray | None = None
) -> Evaluation:
    """Compare the estimate with the truth.

    frames_ns: int64 (N,), increasing, the stamps of the frames that the SLAM was given. With them a frame is tracked
    when the estimate has a pose for it, and every run of frames without one, after the first pose, is a loss. Without
    them the poses of the truth, its holes filled, stand for the frames, of which a camera takes fewer: so times without
    a pose up to `max_gap_s` count as tracked, and only longer ones are losses. Errors are in any case those of an
    estimated pose against the true one that belongs to its own stamp; a frame without a true one, as in a hole of the
    truth, is still tracked or lost.

    The summary holds, in JSON types, NaN for what cannot be told:

    - `status`: "ok" (tracked at the end), "lost", "init_failed" (no pose); `success`: see `is_success`.
    - all of `accuracy_summary`: with frames over these, without over the associated poses one after another; `scale`
      that "sim3" corrected, else 1. Absolute errors are NaN where the poses leave the alignment open.
    - all of `tracking_summary` and `correctness_summary`; `time_to_initialize_s`.
    - `frames`: how many there are, or true poses that stand for them; `frames_without_truth`: those of them in holes or
      beyond the ends of the truth; `poses` of the estimate; `matched`: those with a true pose; `max_gap_s`, as it was
      taken; `duration_s`, `distance_m` of the truth.
    - only with frames, else NaN: `f1_area`; `ate_held_rmse_m`: ATE over all frames when the last pose is held where
      there is none (`held_ate`); all of `motion_summary`.

    Raises TrajectoryError when no pose of the estimate, or no frame, has a true pose, ConfigError for `max_gap_s` with
    frames. Warns (TrajectoryWarning) of what makes figures mean something else than they seem to, such as holes in the
    truth, poses without a true one, stamps that are not those of the frames, orientations of another body.
    """
    params = params or EvalParams()
    return evaluate_at(prepare(ref, params, frames_ns), est, params)


def evaluate_at(reference: Reference, est: Trajectory, params: EvalParams) -> Evaluation:
    """`evaluate` against a sequence that `prepare` made ready with the same parameters."""
    whole = reference.whole
    doubts.tell(doubts.of_the_order(reference.truth, est) + doubts.of_repeated_poses(est))
    pairs = _pairs(reference.truth, est, params)
    compare = _at_given_frames if reference.frames_known else _at_true_poses
    compared = compare(reference, pairs, est, params)
    frames, judged, tracked = compared.frames, compared.judged, compared.tracked
    real = reference.real | frames.judged
    losses = find_gaps(whole.stamps_ns, whole.T, tracked)
    n = int(judged.judged.sum())
    accuracy = accuracy_summary(judged)
    doubts.tell(doubts.of_orientations(accuracy["ate_rot_median_deg"]))
    summary = {
        **_outcome(tracked, losses),
        **accuracy,
        "scale": compared.scale,
        **tracking_summary(whole.stamps_ns, whole.T, tracked, losses),
        **correctness_summary(frames, n, int(real.sum()), frames_known=reference.frames_known),
        "time_to_initialize_s": _time_to_first(whole.stamps_ns, est.stamps_ns),
        "frames": len(whole) if reference.frames_known else len(reference.truth),
        "frames_without_truth": int((~real).sum()),
        "poses": len(est),
        "matched": n,
        "max_gap_s": compared.max_gap_s,
        "duration_s": float(whole.stamps_ns[-1] - whole.stamps_ns[0]) * 1e-9,
        "distance_m": float(step_sizes(whole.T)[0].sum()),
    }
    if reference.frames_known:
        summary["ate_held_rmse_m"] = held_ate(frames.ref_T[real], frames.est_T[real], frames.judged[real]).rmse
        summary |= motion_summary(whole.stamps_ns, whole.T)
    else:
        # These need to know what a frame is: the truth has more poses than the camera took.
        summary |= dict.fromkeys(("f1_area", "ate_held_rmse_m", *MOTION_RATES), np.nan)
    return Evaluation(frames, real, tracked, losses, summary)


class _Pairs(NamedTuple):
    """Poses of truth and estimate that belong together, and their rows in both."""

    rows: IntArray
    est_rows: IntArray
    poses: FramePoses


class _Compared(NamedTuple):
    """Aligned poses at all frames; those that errors are taken over; which frames are tracked, with what gaps."""

    frames: FramePoses
    judged: FramePoses
    scale: float
    tracked: BoolArray
    max_gap_s: float


def _pairs(truth: Trajectory, est: Trajectory, params: EvalParams) -> _Pairs:
    rows = est_rows = np.empty(0, dtype=np.int64)
    if len(est):
        rows, est_rows = associate(truth, est, params.max_difference_ns, params.association)
    # Each pose of the shorter trajectory comes up at most once, but only those of the truth are in order: the partners
    # of two that lie close together may be crossed.
    in_order = len(np.unique(rows)) == len(rows)
    stamps_ns = truth.stamps_ns[rows] if in_order else est.stamps_ns[est_rows]
    poses = FramePoses(stamps_ns, truth.T[rows], est.T[est_rows], np.ones(len(rows), dtype=np.bool_))
    return _Pairs(rows, est_rows, poses)


def _at_given_frames(reference: Reference, pairs: _Pairs, est: Trajectory, params: EvalParams) -> _Compared:
    """A frame is tracked when it has a pose, whether or not the truth has one too."""
    whole = reference.whole
    frame_rows, est_rows = match_stamps(whole.stamps_ns, est.stamps_ns, _frame_bound_ns(whole, params))
    doubts.tell(doubts.of_stamps(whole.stamps_ns[frame_rows], est.stamps_ns[est_rows]))
    tracked = np.zeros(len(whole), dtype=np.bool_)
    tracked[frame_rows] = True
    pair_of = np.full(len(est), -1)
    pair_of[pairs.est_rows] = np.arange(len(pairs.est_rows))
    with_truth = pair_of[est_rows] >= 0
    placed = _placed(whole, frame_rows[with_truth], pairs.poses, pair_of[est_rows[with_truth]])
    frames, scale = align_frames(placed, params.alignment)
    return _Compared(frames, frames, scale, tracked, 0.0)


def _at_true_poses(reference: Reference, pairs: _Pairs, est: Trajectory, params: EvalParams) -> _Compared:
    """A pose of the truth is tracked when it lies in a short gap of the estimate."""
    whole, truth = reference.whole, reference.truth
    judged, scale = align_frames(pairs.poses, params.alignment)
    rows = np.searchsorted(whole.stamps_ns, truth.stamps_ns)[pairs.rows]
    frames = _placed(whole, rows, judged, np.arange(len(rows)))
    longest_s = max_gap_s(truth, est, params)
    doubts.tell(doubts.of_the_ends(truth, est, longest_s))
    tracked = frames.judged | covered_frames(whole.stamps_ns, est.stamps_ns, longest_s)
    return _Compared(frames, judged, scale, tracked, longest_s)


def _placed(whole: Trajectory, rows: IntArray, pairs: FramePoses, chosen: IntArray) -> FramePoses:
    """The chosen pairs in their rows of all frames."""
    ref_T, est_T, judged = whole.T.copy(), np.full_like(whole.T, np.nan), np.zeros(len(whole), dtype=np.bool_)
    ref_T[rows], est_T[rows], judged[rows] = pairs.ref_T[chosen], pairs.est_T[chosen], True
    return pairs._replace(stamps_ns=whole.stamps_ns, ref_T=ref_T, est_T=est_T, judged=judged)


def _frame_bound_ns(whole: Trajectory, params: EvalParams) -> int:
    """Half of the usual time between frames at most, so that a lost frame does not get its neighbour's pose."""
    steps_ns = np.diff(whole.stamps_ns)
    return min(params.max_difference_ns, int(np.median(steps_ns)) // 2) if len(steps_ns) else params.max_difference_ns


def _outcome(tracked: BoolArray, losses: list[LossEvent]) -> Summary:
    status = "init_failed" if not tracked.any() else "ok" if tracked[-1] else "lost"
    return {"status": status, "success": is_success(status, len(losses), float(tracked.mean()))}


def _time_to_first(stamps_ns: IntArray, poses_ns: IntArray) -> float:
    return max(float(poses_ns[0] - stamps_ns[0]) * 1e-9, 0.0) if len(poses_ns) else np.nan
