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
    Exposure,
    completion_of,
    correct_poses,
    correct_rate,
    exposure,
    failure_rates,
    precision_recall_area,
)
from slamgym.eval.trajectories import SequenceAttributes, sequence_attributes, step_sizes
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
    frame, or bool (N,), which do; then R_free (3, 3) or (N, 3, 3) is the `free_turn` of the alignment. map_id: int64
    (N,), the map of each pose; one map when left out.
    """

    stamps_ns: IntArray
    ref_T: FloatArray
    est_T: FloatArray
    judged: BoolArray
    aligned: bool | BoolArray = False
    R_free: FloatArray | None = None
    map_id: IntArray | None = None

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
    moved = np.full_like(poses.est_T, np.nan)
    moved[poses.judged], R_free, scale = _aligned(ref_T, est_T, alignment)
    return poses._replace(est_T=moved, aligned=True, R_free=R_free), scale


def align_maps(poses: FramePoses, map_id: IntArray) -> FramePoses:
    """The poses of each map, map_id int64 (N,), after a rigid alignment of its own over its judged frames.

    A map of fewer than 3 judged poses leaves it open: the first of them is laid onto the true one, good enough to go on
    from there, and they are not `aligned`.
    """
    n = len(map_id)
    moved, R_free, aligned = np.full_like(poses.est_T, np.nan), np.tile(np.eye(3), (n, 1, 1)), np.zeros(n, np.bool_)
    for one in np.unique(map_id[poses.judged]):
        rows = poses.judged & (map_id == one)
        ref_T, est_T = poses.ref_T[rows], poses.est_T[rows]
        aligned[rows] = enough = is_determined(ref_T, est_T, "se3")
        moved[rows], R_free[rows], _ = _aligned(ref_T, est_T, "se3" if enough else "first_pose")
    return poses._replace(est_T=moved, aligned=aligned, R_free=R_free, map_id=map_id)


def _aligned(ref_T: FloatArray, est_T: FloatArray, alignment: str) -> tuple[FloatArray, FloatArray, float]:
    """The estimate after `align`, the `free_turn` that this leaves, and its scale."""
    similarity = align(ref_T, est_T, alignment)
    moved = similarity.apply(est_T)
    return moved, free_turn(ref_T, moved) if alignment in ("se3", "sim3") else np.eye(3), similarity.scale


def absolute_errors_of(poses: FramePoses) -> tuple[FloatArray, FloatArray]:
    """Absolute errors, metres and degrees, of the judged frames; none of those that are not aligned."""
    judged = poses.judged & poses.aligned
    return absolute_errors(poses.ref_T[judged], poses.turned_T[judged])


def accuracy_summary(poses: FramePoses) -> Summary:
    """Errors of the judged frames; NaN where there are none, or no pair is far enough apart.

    - `ate_rmse_m`, `ate_rot_rmse_deg`, and mean, median, std, min, max in place of rmse: absolute errors, NaN unless
      the poses are aligned. Orientations are compared after the `free_turn`.
    - `rpe_step_trans_rmse_m`, `rpe_step_rot_mean_deg`: relative errors over one frame; `rpe_second_*`: over 1 s;
      `rpe_metre_*`: over 1 m of the true path; `rpe_trans_rmse_m`, `rpe_rot_mean_deg`: over all steps, NaN above
      10,000 frames. Both ends of a pair are in one map.
    - `drift_trans_percent`, `drift_rot_deg_per_m`: over segments of 1 to 8 m; `drift_segments`: how many these are
      (`segment_drift`).
    """
    stamps_ns, ref_T, est_T, judged = poses[:4]
    map_ids = poses.map_id
    ate = PoseErrorStats.of(*absolute_errors_of(poses))
    drift = segment_drift(ref_T, est_T, tracked=judged, map_ids=map_ids)
    return {
        **{f"ate_{name}_m": value for name, value in asdict(ate.trans_m).items()},
        **{f"ate_rot_{name}_deg": value for name, value in asdict(ate.rot_deg).items()},
        **_rpe("rpe_step", rpe(ref_T, est_T, tracked=judged, map_ids=map_ids)),
        **_rpe("rpe_second", rpe(ref_T, est_T, 1, "seconds", stamps_ns=stamps_ns, tracked=judged, map_ids=map_ids)),
        **_rpe("rpe_metre", rpe(ref_T, est_T, 1, "metres", tracked=judged, map_ids=map_ids)),
        **_rpe_all_steps(poses),
        "drift_trans_percent": drift.trans_percent,
        "drift_rot_deg_per_m": drift.rot_deg_per_m,
        "drift_segments": drift.segments,
    }


def _rpe(name: str, errors: PoseErrorStats) -> Summary:
    return {f"{name}_trans_rmse_m": errors.trans_m.rmse, f"{name}_rot_mean_deg": errors.rot_deg.mean}


def _rpe_all_steps(poses: FramePoses) -> Summary:
    trans_rmse_m, rot_mean_deg = np.nan, np.nan
    if poses.judged.any() and len(poses.judged) <= ALL_STEPS_LIMIT:
        trans_rmse_m, rot_mean_deg = rpe_all_steps(poses.ref_T, poses.est_T, poses.judged, poses.map_id)
    return {"rpe_trans_rmse_m": trans_rmse_m, "rpe_rot_mean_deg": rot_mean_deg}


def correctness_summary(poses: FramePoses, n_est: int, n_truth: int, *, frames_known: bool) -> Summary:
    """How much of what there was to be tracked came out right; NaN without frames or true poses.

    n_est, n_truth: numbers of estimated poses that can be judged, or belong to another map, and of true ones.

    - `correct_rate`: OpenLORIS' one, of poses correct within 0.1 m and 10 degrees. Where the frames are known, a frame
      without a correct pose ends the time for which the one before holds.
    - `f1_area`: SubT-MRS' F1, here of position errors, over thresholds up to 0.5 m.
    """
    stamps_ns, judged = poses.stamps_ns, poses.judged & poses.aligned
    if not (len(stamps_ns) and n_truth):
        return {"correct_rate": np.nan, "f1_area": np.nan}
    trans_m, rot_deg = absolute_errors_of(poses)
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
    stamps_ns: IntArray, ref_T: FloatArray | None, tracked: BoolArray, losses: Sequence[LossEvent]
) -> Summary:
    """How much was tracked, and how often that broke; stamps_ns and ref_T as in `FramePoses`, tracked bool (N,).

    Without a truth, ref_T None, all that is measured along the path is NaN.

    - `completion`: share of the frames that is tracked; `completion_of_time`, `completion_of_distance`: of the time and
      of the true path.
    - `losses`: list of `LossEvent`s as mappings; `loss_count`; `time_to_first_loss_s`, `distance_to_first_loss_m` along
      the true path, from the first frame.
    - `losses_per_minute`, `losses_per_metre`, `mean_time_between_losses_s`, `mean_distance_between_losses_m`,
      `relocalized_count`, `mean_time_to_relocalize_s`: see `failure_rates`.
    """
    drive = _exposure(stamps_ns, ref_T, tracked)
    shares = completion_of(drive, tracked)
    return {
        "completion": shares.frames,
        "completion_of_time": shares.time,
        "completion_of_distance": shares.distance,
        "losses": [asdict(loss) for loss in losses],
        "time_to_first_loss_s": losses[0].start_s if losses else np.nan,
        "distance_to_first_loss_m": _distance_to(ref_T, losses[0].start_frame) if losses else np.nan,
        **failure_rates(losses, drive)._asdict(),
    }


def _exposure(stamps_ns: IntArray, ref_T: FloatArray | None, tracked: BoolArray) -> Exposure:
    if ref_T is not None:
        return exposure(stamps_ns, ref_T, tracked)
    return exposure(stamps_ns, still(len(stamps_ns)), tracked)._replace(distance_m=np.nan, tracked_m=np.nan)


def _distance_to(ref_T: FloatArray | None, frame: int) -> float:
    return np.nan if ref_T is None else float(step_sizes(ref_T[: frame + 1])[0].sum())


def still(n: int) -> FloatArray:
    """Poses (n, 4, 4) in place of true ones that nobody knows."""
    return np.tile(np.eye(4), (n, 1, 1))


def motion_summary(stamps_ns: IntArray, ref_T: FloatArray | None) -> Summary:
    """How the camera moved, a frame and a second: those of `slamgym.eval.trajectories.SequenceAttributes` that are
    rates, which mean little where the frames are not those of the camera; NaN without a truth.
    """
    if ref_T is None:
        return dict.fromkeys(MOTION_RATES, np.nan)
    attributes = sequence_attributes(stamps_ns, ref_T)._asdict()
    return {name: attributes[name] for name in MOTION_RATES}


def without_nan(value: Any) -> Any:
    """A summary, or a part of one, for JSON, which has neither NaN nor infinity: null stands for "cannot be told"."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
