"""The figures of one estimate, under the same names for a SLAM run and for a trajectory file."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

import numpy as np

from slamgym.eval.accuracy import PoseErrorStats, absolute_errors, align, rpe, rpe_all_steps, segment_drift
from slamgym.eval.robustness import (
    completion,
    correct_poses,
    correct_rate,
    exposure,
    failure_rates,
    precision_recall_area,
    relocalization_score,
)
from slamgym.eval.trajectories import sequence_attributes
from slamgym.types import BoolArray, FloatArray, IntArray, LossEvent, Summary

POSES_NEEDED = {"se3": 3, "sim3": 3, "first_pose": 1, "none": 0}
"""With fewer poses the alignment is open, and there is no absolute error."""

CORRECT_TRANS_M, CORRECT_ROT_DEG = 0.1, 10.0
"""Absolute errors up to which a pose counts as correct."""

F1_MAX_M = 0.5
"""Upper end of the thresholds of `f1_area`."""

ALL_STEPS_LIMIT = 10_000
"""Frames above which the RPE over all steps, quadratic in time, is left out (NaN): it would take minutes."""


class FramePoses(NamedTuple):
    """Poses at N frames: stamps_ns int64 (N,), true ref_T (N, 4, 4), estimated est_T (N, 4, 4), of any value where the
    frame is not `tracked`, bool (N,); aligned: whether ref_T and est_T share their frame.
    """

    stamps_ns: IntArray
    ref_T: FloatArray
    est_T: FloatArray
    tracked: BoolArray
    aligned: bool = False


def align_frames(poses: FramePoses, alignment: str) -> tuple[FramePoses, float]:
    """The poses after `alignment` over the tracked frames, and its scale; as they are where it needs more of these."""
    ref_T, est_T = poses.ref_T[poses.tracked], poses.est_T[poses.tracked]
    if len(ref_T) < POSES_NEEDED[alignment]:
        return poses, 1.0
    similarity = align(ref_T, est_T, alignment)
    moved = np.full_like(poses.est_T, np.nan)
    moved[poses.tracked] = similarity.apply(est_T)
    return poses._replace(est_T=moved, aligned=True), similarity.scale


def accuracy_summary(poses: FramePoses) -> Summary:
    """Errors of the tracked frames; NaN where there are none, or no pair is far enough apart.

    - `ate_rmse_m`, `ate_rot_rmse_deg`, and mean, median, std, min, max in place of rmse: absolute errors, NaN unless
      the poses are aligned.
    - `rpe_step_trans_rmse_m`, `rpe_step_rot_mean_deg`: relative errors over one frame; `rpe_second_*`: over 1 s;
      `rpe_metre_*`: over 1 m of the true path; `rpe_trans_rmse_m`, `rpe_rot_mean_deg`: over all steps, NaN above
      10,000 frames.
    - `drift_trans_percent`, `drift_rot_deg_per_m`: over segments of 1 to 8 m (`segment_drift`).
    """
    stamps_ns, ref_T, est_T, tracked, aligned = poses
    judged = tracked & aligned
    ate = PoseErrorStats.of(*absolute_errors(ref_T[judged], est_T[judged]))
    drift = segment_drift(ref_T, est_T, tracked=tracked)
    return {
        **{f"ate_{name}_m": value for name, value in asdict(ate.trans_m).items()},
        **{f"ate_rot_{name}_deg": value for name, value in asdict(ate.rot_deg).items()},
        **_rpe("rpe_step", rpe(ref_T, est_T, tracked=tracked)),
        **_rpe("rpe_second", rpe(ref_T, est_T, 1, "seconds", stamps_ns=stamps_ns, tracked=tracked)),
        **_rpe("rpe_metre", rpe(ref_T, est_T, 1, "metres", tracked=tracked)),
        **_rpe_all_steps(ref_T, est_T, tracked),
        "drift_trans_percent": drift.trans_percent,
        "drift_rot_deg_per_m": drift.rot_deg_per_m,
    }


def _rpe(name: str, errors: PoseErrorStats) -> Summary:
    return {f"{name}_trans_rmse_m": errors.trans_m.rmse, f"{name}_rot_mean_deg": errors.rot_deg.mean}


def _rpe_all_steps(ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray) -> Summary:
    trans_rmse_m, rot_mean_deg = np.nan, np.nan
    if len(ref_T) <= ALL_STEPS_LIMIT:
        trans_rmse_m, rot_mean_deg = rpe_all_steps(ref_T, est_T, tracked)
    return {"rpe_trans_rmse_m": trans_rmse_m, "rpe_rot_mean_deg": rot_mean_deg}


def correctness_summary(poses: FramePoses, n_est: int) -> Summary:
    """How much of what there was to be tracked came out right; NaN without frames.

    n_est: number of all estimated poses, also of those that the truth, or the evaluated map, has none for.

    - `correct_rate`, `relocalization_score`: OpenLORIS' ones; a pose is correct within 0.1 m and 10 degrees.
    - `f1_area`: SubT-MRS' F1, here of position errors, over thresholds up to 0.5 m.
    """
    stamps_ns, ref_T, est_T, tracked, aligned = poses
    if not len(stamps_ns):
        return {"correct_rate": np.nan, "relocalization_score": np.nan, "f1_area": np.nan}
    judged = tracked & aligned
    trans_m, rot_deg = absolute_errors(ref_T[judged], est_T[judged])
    correct = correct_poses(trans_m, rot_deg, max_trans_m=CORRECT_TRANS_M, max_rot_deg=CORRECT_ROT_DEG)
    start_ns, end_ns = int(stamps_ns[0]), int(stamps_ns[-1])
    without_truth = np.full(max(n_est - len(trans_m), 0), np.nan)
    return {
        "correct_rate": correct_rate(stamps_ns[judged], correct, start_ns, end_ns),
        "relocalization_score": relocalization_score(stamps_ns[judged], correct, start_ns),
        "f1_area": precision_recall_area(np.concatenate([trans_m, without_truth]), len(ref_T), F1_MAX_M).f1,
    }


def tracking_summary(
    stamps_ns: IntArray, ref_T: FloatArray, tracked: BoolArray, losses: Sequence[LossEvent]
) -> Summary:
    """How much was tracked, and how often that broke; the arrays as in `FramePoses`.

    - `completion`: share of the frames that is tracked; `completion_time`, `completion_distance`: of the time and of
      the true path.
    - `losses`: list of `LossEvent`s as mappings; `loss_count`; `time_to_first_loss_s`, from the first frame.
    - `losses_per_minute`, `losses_per_metre`, `mean_time_between_losses_s`, `mean_distance_between_losses_m`,
      `mean_time_to_relocalize_s`: see `failure_rates`.
    """
    shares = completion(stamps_ns, ref_T, tracked)
    rates = failure_rates(losses, exposure(stamps_ns, ref_T, tracked))
    return {
        "completion": shares.frames,
        "completion_time": shares.time,
        "completion_distance": shares.distance,
        "losses": [asdict(loss) for loss in losses],
        "loss_count": len(losses),
        "time_to_first_loss_s": losses[0].start_s if losses else np.nan,
        "losses_per_minute": rates.losses_per_minute,
        "losses_per_metre": rates.losses_per_metre,
        "mean_time_between_losses_s": rates.mean_time_between_s,
        "mean_distance_between_losses_m": rates.mean_distance_between_m,
        "mean_time_to_relocalize_s": rates.mean_time_to_relocalize_s,
    }


def motion_summary(stamps_ns: IntArray, ref_T: FloatArray) -> Summary:
    """How the camera moved: all of `slamgym.eval.trajectories.SequenceAttributes` but the number of frames."""
    attributes = sequence_attributes(stamps_ns, ref_T)._asdict()
    return {name: value for name, value in attributes.items() if name != "frames"}


def without_nan(value: Any) -> Any:
    """A summary, or a part of one, for JSON, which has neither NaN nor infinity: null stands for "cannot be told"."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
