"""The figures of one estimate, under the same names for a SLAM run and for a trajectory file."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

import numpy as np

from slamgym.eval.accuracy import (
    PoseErrorStats,
    absolute_errors,
    align,
    free_turn,
    is_determined,
    rpe,
    rpe_all_steps,
    segment_drift,
)
from slamgym.eval.robustness import (
    completion_of,
    correct_poses,
    correct_rate,
    exposure,
    failure_rates,
    precision_recall_area,
)
from slamgym.eval.trajectories import SequenceAttributes, sequence_attributes
from slamgym.types import BoolArray, FloatArray, IntArray, LossEvent, Summary

CORRECT_TRANS_M, CORRECT_ROT_DEG = 0.1, 10.0
"""Absolute errors up to which a pose counts as correct."""

F1_MAX_M = 0.5
"""Upper end of the thresholds of `f1_area`."""

MOTION_RATES = tuple(name for name in SequenceAttributes._fields if "_per_" in name or name.endswith("_share"))

ALL_STEPS_LIMIT = 10_000
"""Frames above which the RPE over all steps, quadratic in time, is left out (NaN): it would take minutes."""


class FramePoses(NamedTuple):
    """Poses at N frames: stamps_ns int64 (N,), true ref_T (N, 4, 4), estimated est_T (N, 4, 4), of any value where the
    frame is not `judged`, bool (N,): where there is an estimated and a true pose. aligned: whether they share their
    frame; then R_free (3, 3) is the `free_turn` of the alignment.
    """

    stamps_ns: IntArray
    ref_T: FloatArray
    est_T: FloatArray
    judged: BoolArray
    aligned: bool = False
    R_free: FloatArray | None = None

    @property
    def turned_T(self) -> FloatArray:
        """The estimated poses with orientations to compare with the true ones."""
        turned = self.est_T.copy()
        if self.R_free is not None:
            turned[:, :3, :3] = self.R_free @ turned[:, :3, :3]
        return turned


def align_frames(poses: FramePoses, alignment: str) -> tuple[FramePoses, float]:
    """The poses after `alignment` over the judged frames, and its scale; as they are where these leave it open."""
    ref_T, est_T = poses.ref_T[poses.judged], poses.est_T[poses.judged]
    if not is_determined(ref_T, est_T, alignment):
        return poses, 1.0
    similarity = align(ref_T, est_T, alignment)
    moved = np.full_like(poses.est_T, np.nan)
    moved[poses.judged] = similarity.apply(est_T)
    by_positions = alignment in ("se3", "sim3")
    R_free = free_turn(ref_T, moved[poses.judged]) if by_positions else np.eye(3)
    return poses._replace(est_T=moved, aligned=True, R_free=R_free), similarity.scale


def _errors(poses: FramePoses) -> tuple[FloatArray, FloatArray]:
    """Absolute errors, metres and degrees, of the judged frames; none unless they are aligned."""
    judged = poses.judged & poses.aligned
    return absolute_errors(poses.ref_T[judged], poses.turned_T[judged])


def accuracy_summary(poses: FramePoses) -> Summary:
    """Errors of the judged frames; NaN where there are none, or no pair is far enough apart.

    - `ate_rmse_m`, `ate_rot_rmse_deg`, and mean, median, std, min, max in place of rmse: absolute errors, NaN unless
      the poses are aligned. Orientations are compared after the `free_turn`.
    - `rpe_step_trans_rmse_m`, `rpe_step_rot_mean_deg`: relative errors over one frame; `rpe_second_*`: over 1 s;
      `rpe_metre_*`: over 1 m of the true path; `rpe_trans_rmse_m`, `rpe_rot_mean_deg`: over all steps, NaN above
      10,000 frames.
    - `drift_trans_percent`, `drift_rot_deg_per_m`: over segments of 1 to 8 m; `drift_segments`: how many these are
      (`segment_drift`).
    """
    stamps_ns, ref_T, est_T, judged = poses[:4]
    ate = PoseErrorStats.of(*_errors(poses))
    drift = segment_drift(ref_T, est_T, tracked=judged)
    return {
        **{f"ate_{name}_m": value for name, value in asdict(ate.trans_m).items()},
        **{f"ate_rot_{name}_deg": value for name, value in asdict(ate.rot_deg).items()},
        **_rpe("rpe_step", rpe(ref_T, est_T, tracked=judged)),
        **_rpe("rpe_second", rpe(ref_T, est_T, 1, "seconds", stamps_ns=stamps_ns, tracked=judged)),
        **_rpe("rpe_metre", rpe(ref_T, est_T, 1, "metres", tracked=judged)),
        **_rpe_all_steps(ref_T, est_T, judged),
        "drift_trans_percent": drift.trans_percent,
        "drift_rot_deg_per_m": drift.rot_deg_per_m,
        "drift_segments": drift.segments,
    }


def _rpe(name: str, errors: PoseErrorStats) -> Summary:
    return {f"{name}_trans_rmse_m": errors.trans_m.rmse, f"{name}_rot_mean_deg": errors.rot_deg.mean}


def _rpe_all_steps(ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray) -> Summary:
    trans_rmse_m, rot_mean_deg = np.nan, np.nan
    if len(ref_T) <= ALL_STEPS_LIMIT:
        trans_rmse_m, rot_mean_deg = rpe_all_steps(ref_T, est_T, tracked)
    return {"rpe_trans_rmse_m": trans_rmse_m, "rpe_rot_mean_deg": rot_mean_deg}


def correctness_summary(poses: FramePoses, n_est: int, n_truth: int, *, frames_known: bool) -> Summary:
    """How much of what there was to be tracked came out right; NaN without frames.

    n_est, n_truth: numbers of estimated poses that can be judged, or belong to another map, and of true ones.

    - `correct_rate`: OpenLORIS' one, of poses correct within 0.1 m and 10 degrees. Where the frames are known, a frame
      without a correct pose ends the time for which the one before holds.
    - `f1_area`: SubT-MRS' F1, here of position errors, over thresholds up to 0.5 m.
    """
    stamps_ns, judged = poses.stamps_ns, poses.judged & poses.aligned
    if not len(stamps_ns):
        return {"correct_rate": np.nan, "f1_area": np.nan}
    trans_m, rot_deg = _errors(poses)
    correct = np.zeros(len(stamps_ns), dtype=np.bool_)
    correct[judged] = correct_poses(trans_m, rot_deg, max_trans_m=CORRECT_TRANS_M, max_rot_deg=CORRECT_ROT_DEG)
    counted = np.ones_like(judged) if frames_known else judged
    start_ns, end_ns = int(stamps_ns[0]), int(stamps_ns[-1])
    not_judged = np.full(max(n_est - len(trans_m), 0), np.nan)
    return {
        "correct_rate": correct_rate(stamps_ns[counted], correct[counted], start_ns, end_ns),
        "f1_area": precision_recall_area(np.concatenate([trans_m, not_judged]), n_truth, F1_MAX_M).f1,
    }


def tracking_summary(
    stamps_ns: IntArray, ref_T: FloatArray, tracked: BoolArray, losses: Sequence[LossEvent]
) -> Summary:
    """How much was tracked, and how often that broke; stamps_ns and ref_T as in `FramePoses`, tracked bool (N,).

    - `completion`: share of the frames that is tracked; `completion_of_time`, `completion_of_distance`: of the time and
      of the true path.
    - `losses`: list of `LossEvent`s as mappings; `loss_count`; `time_to_first_loss_s`, from the first frame.
    - `losses_per_minute`, `losses_per_metre`, `mean_time_between_losses_s`, `mean_distance_between_losses_m`,
      `relocalized_count`, `mean_time_to_relocalize_s`: see `failure_rates`.
    """
    drive = exposure(stamps_ns, ref_T, tracked)
    shares = completion_of(drive, tracked)
    return {
        "completion": shares.frames,
        "completion_of_time": shares.time,
        "completion_of_distance": shares.distance,
        "losses": [asdict(loss) for loss in losses],
        "time_to_first_loss_s": losses[0].start_s if losses else np.nan,
        **failure_rates(losses, drive)._asdict(),
    }


def motion_summary(stamps_ns: IntArray, ref_T: FloatArray) -> Summary:
    """How the camera moved, a frame and a second: those of `slamgym.eval.trajectories.SequenceAttributes` that are
    rates, which mean little where the frames are not those of the camera.
    """
    attributes = sequence_attributes(stamps_ns, ref_T)._asdict()
    return {name: attributes[name] for name in MOTION_RATES}


def without_nan(value: Any) -> Any:
    """A summary, or a part of one, for JSON, which has neither NaN nor infinity: null stands for "cannot be told"."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
