"""The summary of one SLAM run: what `info["episode_slam"]` and `episode.json` hold."""

import numpy as np

from slamgym.eval.accuracy import ate, is_determined
from slamgym.eval.robustness import (
    estimate_by_frame,
    final_by_frame,
    find_losses,
    held_ate,
    is_success,
    most_frequent_map,
    status,
    tracked_frames,
)
from slamgym.eval.summary import (
    FramePoses,
    accuracy_summary,
    align_frames,
    correctness_summary,
    motion_summary,
    tracking_summary,
)
from slamgym.types import BoolArray, FloatArray, IntArray, SlamEvent, SlamRecord, Summary


def summarize_slam(record: SlamRecord) -> Summary:
    """Accuracy and robustness of one SLAM run, in JSON types; what cannot be told is NaN.

    - `status`: "ok", "lost", "init_failed", "crashed" or "timeout"; `success`: see `is_success`.
    - all of `accuracy_summary`: of the final trajectory in the evaluated map, after rigid alignment; NaN for a SLAM
      that crashed or hung before it gave one. `ate_online_rmse_m`: ATE of the poses as they were emitted, of one online
      map where several were merged later. ATE is NaN below 3 poses.
    - all of `tracking_summary` and `correctness_summary`: over the fed frames, of which those in the evaluated map are
      tracked; of a SLAM without a final trajectory by the poses as they were emitted.
    - `ate_held_rmse_m`: ATE over all fed frames when the last pose is held where there is none (`held_ate`).
    - `frames_fed`; `frames_tracked`: those with state OK, in any map; `tracked_points_median`: over these.
    - `maps`: maps that frames were tracked in as they were fed; `loops_closed`: loops seen to close.
    - `time_to_initialize_s`: from the first fed frame.
    - `lockstep_overruns`: frames for which lock-step gave up waiting; above 0 the result depends on the computer.
    - all of `motion_summary`, of the fed frames.
    """
    final = _frames(record, *final_by_frame(record))
    estimate = _frames(record, *estimate_by_frame(record))
    losses = find_losses(record)
    tracking = tracking_summary(record.stamps_ns, record.T_world_cam, estimate.judged, losses)
    ok = tracked_frames(record)
    return {
        "status": status(record),
        "success": is_success(status(record), len(losses), tracking["completion"]),
        **accuracy_summary(align_frames(final, "se3")[0]),
        "ate_online_rmse_m": _online_ate(record, estimate.judged),
        "ate_held_rmse_m": held_ate(record.T_world_cam, estimate.est_T, estimate.judged).rmse,
        **tracking,
        **correctness_summary(align_frames(estimate, "se3")[0], int(ok.sum()), len(ok), frames_known=True),
        **_counts(record),
        "lockstep_overruns": record.lockstep_overruns,
        **motion_summary(record.stamps_ns, record.T_world_cam),
    }


def _frames(record: SlamRecord, T_map_cam: FloatArray, map_id: IntArray) -> FramePoses:
    """The fed frames, of which those in the largest map can be judged."""
    judged = (map_id == most_frequent_map(map_id)) & (map_id >= 0)
    return FramePoses(record.stamps_ns, record.T_world_cam, T_map_cam, judged)


def _online_ate(record: SlamRecord, evaluated: BoolArray) -> float:
    # Maps that were merged in the end had origins of their own before: never align two of them together.
    online = np.where(evaluated, record.map_id, -1)
    frames = (online == most_frequent_map(online)) & (online >= 0)
    return _ate_rmse(record.T_world_cam[frames], record.T_map_cam[frames])


def _ate_rmse(ref_T: FloatArray, est_T: FloatArray) -> float:
    return ate(ref_T, est_T).trans_m.rmse if is_determined(ref_T, est_T, "se3") else np.nan


def _counts(record: SlamRecord) -> Summary:
    ok = tracked_frames(record)
    return {
        "frames_fed": len(ok),
        "frames_tracked": int(ok.sum()),
        "tracked_points_median": float(np.median(record.tracked_points[ok])) if ok.any() else np.nan,
        "maps": len(np.unique(record.map_id[ok])),
        "loops_closed": record.events.count(SlamEvent.LOOP_CLOSED),
        "time_to_initialize_s": _time_to_first(record.stamps_ns, ok),
    }


def _time_to_first(stamps_ns: IntArray, ok: BoolArray) -> float:
    return float(stamps_ns[np.argmax(ok)] - stamps_ns[0]) * 1e-9 if ok.any() else np.nan
