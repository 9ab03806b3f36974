"""The summary of one SLAM run: what `info["episode_slam"]` and `episode.json` hold."""

from typing import Any

import numpy as np

from slamgym.eval.accuracy import ErrorStats, absolute_errors
from slamgym.eval.robustness import (
    cause_counts,
    estimate_by_frame,
    evaluated_frames,
    final_by_frame,
    find_losses,
    frames_by_policy,
    hold_last_pose,
    is_success,
    status,
    tracked_frames,
    true_poses,
)
from slamgym.eval.summary import (
    FramePoses,
    absolute_errors_of,
    accuracy_summary,
    align_maps,
    correctness_summary,
    motion_summary,
    still,
    tracking_summary,
)
from slamgym.types import BoolArray, FloatArray, IntArray, LossEvent, SlamEvent, SlamRecord, Summary


def summarize_slam(record: SlamRecord, map_policy: str = "largest") -> Summary:
    """Accuracy and robustness of one SLAM run, in JSON types; what cannot be told is NaN.

    `map_policy` says in which maps of the final trajectory, merges followed, a frame counts as tracked: in the
    "largest" by frames, in the "first" that any frame is in, or in "each". Every map is aligned to the truth on its
    own, and no pair of frames in two maps makes a relative error or a segment. So with "each" `ate_*` are over the
    errors of all maps together, without those of fewer than 3 poses, which leave the alignment open; `rpe_*` and
    `drift_*` over the pairs within any one map; and the robot of `ate_held_rmse_m` is put where it is whenever a new
    map begins. That forgives a run to fall into pieces: read `map_results` beside it.

    Without a true pose, NaN or not `has_truth`, a frame is tracked or lost as any other, but nothing is judged there.
    Without any, what needs none still comes: status, completion, losses, maps, times.

    - `status`: "ok", "lost", "init_failed", "crashed" or "timeout"; `success`: see `is_success`, where dropped frames
      count as not tracked. `failure`: why the
      SLAM crashed or hung, in one line, else ""; `log_tail`: the last lines that it printed then, else none.
    - `map_policy`; `map_results`: one mapping a map, in the order of their first frames: `map_id`, `frames` and their
      `share` of those fed, `start_s`, `end_s` of the first and last of them, `ate_rmse_m`.
    - all of `accuracy_summary`: of the final trajectory in the evaluated maps, after rigid alignment; NaN for a SLAM
      that crashed or hung before it gave one. `ate_online_rmse_m`: ATE of the poses as they were emitted, in the online
      map that the policy picks of those that became the evaluated ones; NaN for an offline SLAM. ATE is NaN below 3
      poses.
    - all of `tracking_summary` and `correctness_summary`: over the fed frames, of which those in an evaluated map are
      tracked; of a SLAM without a final trajectory by the poses as they were emitted. `loss_causes`: how many losses
      each cause had.
    - `ate_held_rmse_m`: ATE over all fed frames with a true pose when the last pose is held where there is none
      (`held_ate`).
    - `frames_fed`; `frames_tracked`: those with state OK, in any map; `tracked_points_median`: over these;
      `frames_without_truth`.
    - `maps`: maps that frames were tracked in as they were fed; `loops_closed`: loops seen to close.
    - `time_to_initialize_s`: from the first fed frame.
    - `lockstep_overruns`: frames for which lock-step gave up waiting; above 0 the result depends on the computer.
      `frames_dropped`: frames not fed in real time because the SLAM was busy.
    - all of `motion_summary`, of the fed frames.

    Raises ConfigError for another map policy.
    """
    ref_T, real = true_poses(record)
    tracked, ok = evaluated_frames(record, map_policy), tracked_frames(record)
    final, estimate = (_in_maps(record, *poses) for poses in (final_by_frame(record), estimate_by_frame(record)))
    evaluated = _only(estimate, tracked)
    losses = find_losses(record)
    tracking = tracking_summary(record.stamps_ns, ref_T, tracked, losses)
    return {
        "status": status(record),
        "success": is_success(status(record), len(losses), _share_of_all(tracked, record.frames_dropped)),
        "map_policy": map_policy,
        **accuracy_summary(_only(final, tracked)),
        "ate_online_rmse_m": _online_ate(record, tracked, map_policy),
        "ate_held_rmse_m": _held_ate(evaluated, real),
        **tracking,
        **correctness_summary(evaluated, int((ok & real).sum()), int(real.sum()), frames_known=True),
        "map_results": _map_results(final, estimate_by_frame(record)[1]),
        **_counts(record, real),
        **_ending(record, losses),
        **motion_summary(record.stamps_ns, ref_T),
    }


def _share_of_all(tracked: BoolArray, dropped: int) -> float:
    """Share of the frames that came, those included that were dropped because the SLAM was busy, that is tracked."""
    came = len(tracked) + dropped
    return float(tracked.sum()) / came if came else 0.0


def _in_maps(record: SlamRecord, T_map_cam: FloatArray, map_id: IntArray) -> FramePoses:
    """The fed frames, each map aligned on its own; judged where there is a pose in a map and a true one."""
    ref_T, real = true_poses(record)
    judged = (map_id >= 0) & real & np.isfinite(T_map_cam).all(axis=(1, 2))
    known_T = still(len(real)) if ref_T is None else ref_T
    return align_maps(FramePoses(record.stamps_ns, known_T, T_map_cam, judged), map_id)


def _only(poses: FramePoses, frames: BoolArray) -> FramePoses:
    return poses._replace(judged=poses.judged & frames)


def _ate_rmse(poses: FramePoses) -> float:
    return ErrorStats.of(absolute_errors_of(poses)[0]).rmse


def _online_ate(record: SlamRecord, tracked: BoolArray, map_policy: str) -> float:
    # Maps that were merged in the end had origins of their own before: never align two of them together.
    online = np.where(tracked, record.map_id, -1)
    return _ate_rmse(_only(_in_maps(record, record.T_map_cam, online), frames_by_policy(online, map_policy)))


def _held_ate(poses: FramePoses, real: BoolArray) -> float:
    """As `held_ate`, of maps that are aligned already."""
    if not real.any():
        return np.nan
    ref_T = poses.ref_T[real]
    held_T = hold_last_pose(poses.est_T[real], poses.judged[real], ref_T[0])
    return ErrorStats.of(absolute_errors(ref_T, held_T)[0]).rmse


def _map_results(final: FramePoses, map_id: IntArray) -> list[Summary]:
    return [_map_result(final, map_id == one, one) for one in dict.fromkeys(map_id[map_id >= 0].tolist())]


def _map_result(final: FramePoses, frames: BoolArray, map_id: int) -> Summary:
    at_s = (final.stamps_ns[frames] - final.stamps_ns[0]) * 1e-9
    return {
        "map_id": map_id,
        "frames": len(at_s),
        "share": float(frames.mean()),
        "start_s": float(at_s[0]),
        "end_s": float(at_s[-1]),
        "ate_rmse_m": _ate_rmse(_only(final, frames)),
    }


def _counts(record: SlamRecord, real: BoolArray) -> Summary:
    ok = tracked_frames(record)
    return {
        "frames_fed": len(ok),
        "frames_tracked": int(ok.sum()),
        "frames_without_truth": int((~real).sum()),
        "tracked_points_median": float(np.median(record.tracked_points[ok])) if ok.any() else np.nan,
        "maps": len(np.unique(record.map_id[ok])),
        "loops_closed": record.events.count(SlamEvent.LOOP_CLOSED),
        "time_to_initialize_s": _time_to_first(record.stamps_ns, ok),
    }


def _ending(record: SlamRecord, losses: list[LossEvent]) -> dict[str, Any]:
    return {
        "loss_causes": cause_counts(losses),
        "failure": record.failure,
        "log_tail": record.log_tail.splitlines() if record.outcome else [],
        "lockstep_overruns": record.lockstep_overruns,
        "frames_dropped": record.frames_dropped,
    }


def _time_to_first(stamps_ns: IntArray, ok: BoolArray) -> float:
    return float(stamps_ns[np.argmax(ok)] - stamps_ns[0]) * 1e-9 if ok.any() else np.nan
