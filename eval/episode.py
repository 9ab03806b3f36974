"""The summary of one SLAM run: what `info["episode_slam"]` and `episode.json` hold."""

from dataclasses import asdict

import numpy as np

from slamgym.eval.accuracy import ate, rpe, rpe_all_steps
from slamgym.eval.robustness import (
    completion,
    estimate_by_frame,
    final_by_frame,
    find_losses,
    most_frequent_map,
    seconds_between,
    status,
    success,
    tracked_frames,
)
from slamgym.types import FloatArray, SlamEvent, SlamRecord, Summary


def summarize_slam(record: SlamRecord) -> Summary:
    """Accuracy and robustness of one SLAM run, in JSON types; what cannot be told is NaN.

    - `status`: "ok", "lost", "init_failed", "crashed" or "timeout"; `success`: "ok" and no loss.
    - `ate_rmse_m`: of the final trajectory; `ate_online_rmse_m`: of the poses as they were emitted, of one online map
      where several were merged later. Both over the evaluated map, after rigid alignment, NaN below 3 poses.
    - `rpe_trans_rmse_m`, `rpe_rot_mean_deg`: over all steps (`rpe_all_steps`); `rpe_step_trans_rmse_m`,
      `rpe_step_rot_mean_deg`: over a step of one fed frame. Final trajectory, evaluated map.
    - `completion`: fed frames tracked in the evaluated map / all fed frames.
    - `frames_fed`; `frames_tracked`: those with state OK, in any map; `tracked_points_median`: over these.
    - `maps`: maps that frames were tracked in as they were fed; `loops_closed`: loops seen to close.
    - `losses`: list of `LossEvent`s as mappings; `loss_count`.
    - `time_to_initialize_s`, `time_to_first_loss_s`: from the first fed frame.
    - `lockstep_overruns`: frames for which lock-step gave up waiting; above 0 the result depends on the computer.
    """
    return {
        "status": status(record),
        "success": success(record),
        **_final_accuracy(record),
        "ate_online_rmse_m": _online_ate(record),
        "completion": completion(record),
        **_counts(record),
        **_losses(record),
        "lockstep_overruns": record.lockstep_overruns,
    }


def _final_accuracy(record: SlamRecord) -> Summary:
    T, map_id = final_by_frame(record)
    best = (map_id == most_frequent_map(map_id)) & (map_id >= 0)
    step = rpe(record.T_world_cam, T, 1, best)
    all_steps = rpe_all_steps(record.T_world_cam, T, best)
    return {
        "ate_rmse_m": _ate_rmse(record.T_world_cam[best], T[best]),
        "rpe_trans_rmse_m": all_steps.trans_rmse_m,
        "rpe_rot_mean_deg": all_steps.rot_mean_deg,
        "rpe_step_trans_rmse_m": step.trans_m.rmse,
        "rpe_step_rot_mean_deg": step.rot_deg.mean,
    }


def _online_ate(record: SlamRecord) -> float:
    _, maps = estimate_by_frame(record)
    # Maps that were merged in the end had origins of their own before: never align two of them together.
    online = np.where(maps == most_frequent_map(maps), record.map_id, -1)
    frames = (online == most_frequent_map(online)) & (online >= 0)
    return _ate_rmse(record.T_world_cam[frames], record.T_map_cam[frames])


def _ate_rmse(ref_T: FloatArray, est_T: FloatArray) -> float:
    return ate(ref_T, est_T).rmse if len(ref_T) >= 3 else np.nan


def _counts(record: SlamRecord) -> Summary:
    ok = tracked_frames(record)
    return {
        "frames_fed": len(ok),
        "frames_tracked": int(ok.sum()),
        "tracked_points_median": float(np.median(record.tracked_points[ok])) if ok.any() else np.nan,
        "maps": len(np.unique(record.map_id[ok])),
        "loops_closed": record.events.count(SlamEvent.LOOP_CLOSED),
        "time_to_initialize_s": seconds_between(record, 0, int(np.argmax(ok))) if ok.any() else np.nan,
    }


def _losses(record: SlamRecord) -> Summary:
    losses = find_losses(record)
    return {
        "losses": [asdict(loss) for loss in losses],
        "loss_count": len(losses),
        "time_to_first_loss_s": losses[0].start_s if losses else np.nan,
    }
