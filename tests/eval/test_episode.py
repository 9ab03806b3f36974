import json
import math

import numpy as np
import pytest

from slamgym.eval.episode import summarize_slam
from slamgym.eval.trajectories import SequenceAttributes
from slamgym.types import SlamEvent

STATS = ("rmse", "mean", "median", "std", "min", "max")
ACCURACY = [
    *(f"ate_{name}_m" for name in STATS), *(f"ate_rot_{name}_deg" for name in STATS), "ate_online_rmse_m",
    "rpe_trans_rmse_m", "rpe_rot_mean_deg", "rpe_step_trans_rmse_m", "rpe_step_rot_mean_deg",
]  # fmt: skip
FAR_APART = [
    "rpe_second_trans_rmse_m", "rpe_second_rot_mean_deg", "rpe_metre_trans_rmse_m", "rpe_metre_rot_mean_deg",
    "drift_trans_percent", "drift_rot_deg_per_m",
]  # fmt: skip
ROBUSTNESS = {
    "status", "success", "ate_held_rmse_m", "completion", "completion_of_time", "completion_of_distance",
    "correct_rate", "drift_segments", "relocalized_count", "f1_area", "frames_fed", "frames_tracked", "maps",
    "loops_closed", "losses", "loss_count", "losses_per_minute", "losses_per_metre", "mean_time_between_losses_s",
    "mean_distance_between_losses_m", "mean_time_to_relocalize_s", "time_to_first_loss_s", "time_to_initialize_s",
    "tracked_points_median", "lockstep_overruns",
}  # fmt: skip
MOTION = set(SequenceAttributes._fields) - {"frames", "duration_s", "path_length_m"}
KEYS = {*ACCURACY, *FAR_APART, *ROBUSTNESS, *MOTION}


def is_nan(summary, *keys):
    return all(math.isnan(summary[key]) for key in keys)


@pytest.mark.parametrize("online", ["", ".", "0", "x", "....", "0x", "00", "..000x11", "0000000"])
@pytest.mark.parametrize("outcome", ["", "crashed", "timeout"])
def test_keys_and_json_types_whatever_happened(make_record, online, outcome):
    summary = summarize_slam(make_record(online, outcome=outcome))
    assert set(summary) == KEYS
    assert json.loads(json.dumps(summary)).keys() == KEYS


def test_perfect_run(make_record):
    summary = summarize_slam(make_record("..00000000", events={2: SlamEvent.INITIALIZED, 7: SlamEvent.LOOP_CLOSED}))
    assert [summary[key] for key in ACCURACY] == pytest.approx([0.0] * len(ACCURACY), abs=1e-6)
    assert (summary["status"], summary["success"], summary["losses"]) == ("ok", True, [])
    assert (summary["frames_fed"], summary["frames_tracked"], summary["maps"], summary["loops_closed"]) == (10, 8, 1, 1)
    assert summary["time_to_initialize_s"] == pytest.approx(0.2)
    assert summary["tracked_points_median"] == 5.5
    assert is_nan(summary, "time_to_first_loss_s")


def test_a_run_that_never_initialises_has_no_accuracy(make_record):
    summary = summarize_slam(make_record("....."))
    assert (summary["status"], summary["completion"], summary["loss_count"]) == ("init_failed", 0.0, 0)
    assert is_nan(summary, *ACCURACY, "time_to_initialize_s", "time_to_first_loss_s", "tracked_points_median")


def test_below_three_poses_there_is_no_ate_but_one_pair_gives_an_rpe(make_record):
    summary = summarize_slam(make_record("00xxx"))
    assert is_nan(summary, "ate_rmse_m", "ate_online_rmse_m")
    assert summary["rpe_step_trans_rmse_m"] == pytest.approx(0.0, abs=1e-9)
    assert (summary["status"], summary["time_to_first_loss_s"]) == ("lost", pytest.approx(0.2))


def test_one_pose_has_no_accuracy_at_all(make_record):
    summary = summarize_slam(make_record(".0xxx"))
    assert is_nan(summary, *ACCURACY)
    assert summary["completion"] == pytest.approx(0.2)


def test_maps_of_different_origin_are_never_aligned_together(make_record):
    summary = summarize_slam(make_record("00000x1111", events={6: SlamEvent.NEW_MAP}))
    assert [summary[key] for key in ACCURACY] == pytest.approx([0.0] * len(ACCURACY), abs=1e-6)
    assert (summary["maps"], summary["completion"]) == (2, 0.5)
    (loss,) = summary["losses"]
    assert (loss["start_frame"], loss["end_frame"], loss["outcome"]) == (5, 5, "new_map")


def test_after_a_merge_the_final_map_has_all_frames_and_the_online_ate_one_online_map(make_record):
    record = make_record("00000x1111", final="0000000000", events={6: SlamEvent.MAPS_MERGED})
    summary = summarize_slam(record)
    assert summary["completion"] == pytest.approx(0.9)
    assert [summary[key] for key in ACCURACY] == pytest.approx([0.0] * len(ACCURACY), abs=1e-6)


def test_final_and_online_errors_are_told_apart(make_record):
    summary = summarize_slam(make_record("0" * 40, online_error_m=0.05))
    assert summary["ate_rmse_m"] == pytest.approx(0.0, abs=1e-6)
    assert summary["ate_online_rmse_m"] == pytest.approx(0.05, rel=0.1)


def test_a_guessed_final_pose_never_counts(make_record):
    record = make_record("00000xx000", final="0000000000")
    expected = summarize_slam(record)
    record.final.T_map_cam[5:7, :3, 3] += 100.0
    assert summarize_slam(record) == expected
    assert expected["completion"] == pytest.approx(0.8)


def test_a_crash_leaves_the_online_accuracy(make_record):
    summary = summarize_slam(make_record("00000000xx", final="..........", outcome="crashed", online_error_m=0.05))
    assert is_nan(summary, "ate_rmse_m", "rpe_trans_rmse_m", "rpe_step_rot_mean_deg")
    assert summary["ate_online_rmse_m"] == pytest.approx(0.05, rel=0.2)
    assert (summary["status"], summary["completion"]) == ("crashed", 0.8)
    assert not np.isnan(summary["time_to_first_loss_s"])


def test_a_crash_is_judged_by_the_emitted_poses(make_record):
    summary = summarize_slam(make_record("..000000", final="........", outcome="crashed"))
    assert is_nan(summary, "ate_rmse_m")
    assert (summary["completion"], summary["f1_area"]) == (0.75, pytest.approx(2 * 6 / (6 + 8)))
    # Two of eight frames at the start are held at the first pose: 0.2 and 0.1 m away from it.
    assert summary["correct_rate"] == pytest.approx(5 / 7)
    assert summary["ate_held_rmse_m"] == pytest.approx(np.sqrt((0.2**2 + 0.1**2) / 8), rel=0.01)


def test_poses_in_other_maps_are_estimates_without_a_truth(make_record):
    summary = summarize_slam(make_record("000000x111", events={7: SlamEvent.NEW_MAP}))
    assert summary["f1_area"] == pytest.approx(2 * 6 / (9 + 10))


def test_success_needs_half_of_the_frames(make_record):
    assert summarize_slam(make_record("....0000"))["success"]
    assert not summarize_slam(make_record(".....000"))["success"]
    assert not summarize_slam(make_record("00000000", final=".....000"))["success"]


def test_a_drive_that_ends_before_its_merge_is_judged_online_by_one_map(make_record):
    """Two online maps that were one in the end: the larger of them, each with an origin of its own."""
    record = make_record("000x1111xx", final="000.1111..", events={4: SlamEvent.NEW_MAP}, online_error_m=0.1)
    merged = make_record("000x1111xx", final="111.1111..", online_error_m=0.1)
    assert summarize_slam(merged)["ate_online_rmse_m"] == summarize_slam(record)["ate_online_rmse_m"]
    assert 0.01 < summarize_slam(merged)["ate_online_rmse_m"] < 0.2
