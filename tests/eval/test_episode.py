import json
import math
from dataclasses import asdict, replace

import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.eval import evaluate
from slamgym.eval.accuracy import rpe, rpe_all_steps, segment_drift
from slamgym.eval.episode import summarize_slam
from slamgym.eval.robustness import MAP_POLICIES, final_by_frame
from slamgym.eval.trajectories import SequenceAttributes, Trajectory, interpolate
from slamgym.types import LossContext, SlamEvent

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
    "tracked_points_median", "lockstep_overruns", "distance_to_first_loss_m", "frames_without_truth", "frames_dropped",
    "map_policy", "map_results", "loss_causes", "failure", "log_tail",
}  # fmt: skip
MOTION = set(SequenceAttributes._fields) - {"frames", "duration_s", "path_length_m"}
KEYS = {*ACCURACY, *FAR_APART, *ROBUSTNESS, *MOTION}


def is_nan(summary, *keys):
    return all(math.isnan(summary[key]) for key in keys)


@pytest.mark.parametrize("online", ["", ".", "0", "x", "....", "0x", "00", "..000x11", "0000000"])
@pytest.mark.parametrize("outcome", ["", "crashed", "timeout"])
@pytest.mark.parametrize("map_policy", MAP_POLICIES)
@pytest.mark.parametrize("truth", ["known", "unknown", "interpolated"])
def test_keys_and_json_types_whatever_happened(make_record, online, outcome, map_policy, truth):
    record = make_record(online, outcome=outcome)
    if truth == "unknown":
        record = replace(record, T_world_cam=np.full_like(record.T_world_cam, np.nan))
    if truth == "interpolated":
        record = replace(record, has_truth=np.zeros(len(online), dtype=np.bool_))
    summary = summarize_slam(record, map_policy)
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


def context(cause):
    return LossContext(*[0.5] * 14, cause=cause, explanation="in words")


def test_a_run_in_pieces_by_each_policy(make_record):
    record = make_record("000x11111x22x0")
    largest, first, each = (summarize_slam(record, policy) for policy in ("largest", "first", "each"))
    assert [s["map_policy"] for s in (largest, first, each)] == ["largest", "first", "each"]
    assert [s["completion"] for s in (largest, first, each)] == pytest.approx([5 / 14, 4 / 14, 11 / 14])
    # Steps with both ends in one map: 4, 2 and 7 of 13.
    assert [s["completion_of_time"] for s in (largest, first, each)] == pytest.approx([4 / 13, 2 / 13, 7 / 13])
    for summary in (largest, first, each):
        assert [summary[key] for key in ACCURACY] == pytest.approx([0.0] * len(ACCURACY), abs=1e-6)
        assert summary["map_results"] == largest["map_results"]
    found = [
        [result[key] for key in ("map_id", "frames", "share", "start_s", "end_s")] for result in each["map_results"]
    ]
    assert found == [
        pytest.approx([0, 4, 4 / 14, 0.0, 1.3]),
        pytest.approx([1, 5, 5 / 14, 0.4, 0.8]),
        pytest.approx([2, 2, 2 / 14, 1.0, 1.1]),
    ]
    ate = [result["ate_rmse_m"] for result in each["map_results"]]
    assert ate == pytest.approx([0.0, 0.0, np.nan], abs=1e-6, nan_ok=True)


def test_the_first_map_is_the_one_that_it_became(make_record):
    record = make_record("00x1111x222222", final="11.1111.222222", events={3: SlamEvent.MAPS_MERGED})
    completions = [summarize_slam(record, policy)["completion"] for policy in MAP_POLICIES]
    assert completions == pytest.approx([6 / 14, 6 / 14, 12 / 14])
    assert [result["map_id"] for result in summarize_slam(record)["map_results"]] == [1, 2]
    taken_back = make_record("00x111x22222", final="...111.22222")
    assert summarize_slam(taken_back, "first")["completion"] == pytest.approx(3 / 12)


def test_errors_of_all_maps_are_pooled_and_small_maps_cannot_be_judged(make_record):
    record = make_record("00000x11111111x22")
    rng = np.random.default_rng(0)
    record.final.T_map_cam[5:13, :3, 3] += 0.1 * rng.normal(size=(8, 3))
    alone, each = summarize_slam(record), summarize_slam(record, "each")
    assert (alone["completion"], each["completion"]) == (8 / 17, 15 / 17)
    assert 0.05 < alone["ate_rmse_m"] == each["map_results"][1]["ate_rmse_m"]
    # 8 frames with errors beside 5 without any; the two of the last map leave their alignment open.
    assert each["ate_rmse_m"] == pytest.approx(alone["ate_rmse_m"] * np.sqrt(8 / 13), rel=1e-6)
    # 7 and 4 and 1 pairs of neighbours, of which those in the second map are off.
    assert each["rpe_step_trans_rmse_m"] == pytest.approx(alone["rpe_step_trans_rmse_m"] * np.sqrt(7 / 12), rel=1e-6)
    perfect = summarize_slam(make_record("00000x11111111x22"), "each")
    # 13 right ones of 15 estimated and 17 true poses.
    assert perfect["f1_area"] == pytest.approx(2 * 13 / (15 + 17), rel=1e-6)
    assert perfect["correct_rate"] == pytest.approx(13 / 16)


def test_no_relative_error_spans_two_maps(make_record):
    record = make_record("0" * 30 + "1" * 25 + "x" + "0" * 24)
    record.final.T_map_cam[:, :3, 3] += 0.1 * np.random.default_rng(0).normal(size=(79, 3))
    (est_T, map_ids), ref_T = final_by_frame(record), record.T_world_cam
    poses = {"tracked": map_ids >= 0, "map_ids": map_ids}
    got = summarize_slam(record, "each")
    second = rpe(ref_T, est_T, 1, "seconds", stamps_ns=record.stamps_ns, **poses)
    expected = {
        "rpe_step_trans_rmse_m": rpe(ref_T, est_T, **poses).trans_m.rmse,
        "rpe_second_trans_rmse_m": second.trans_m.rmse,
        "rpe_metre_trans_rmse_m": rpe(ref_T, est_T, 1, "metres", **poses).trans_m.rmse,
        "rpe_trans_rmse_m": rpe_all_steps(ref_T, est_T, **poses).trans_rmse_m,
        "drift_trans_percent": segment_drift(ref_T, est_T, **poses).trans_percent,
        "drift_segments": segment_drift(ref_T, est_T, **poses).segments,
    }
    assert {key: got[key] for key in expected} == pytest.approx(expected)


def test_the_held_robot_goes_on_in_a_new_map(make_record):
    record = make_record("00000xxx11xxx222")
    position = record.T_world_cam[:, :3, 3]
    held = np.array([0, 1, 2, 3, 4, 4, 4, 4, 8, 9, 9, 9, 9, 13, 14, 15])
    error_m = np.linalg.norm(position - position[held], axis=1)
    assert summarize_slam(record, "each")["ate_held_rmse_m"] == pytest.approx(np.sqrt(np.mean(error_m**2)), rel=1e-6)
    held[8:] = 4
    error_m = np.linalg.norm(position - position[held], axis=1)
    assert summarize_slam(record)["ate_held_rmse_m"] == pytest.approx(np.sqrt(np.mean(error_m**2)), rel=1e-6)


def test_online_maps_are_chosen_by_the_policy_too(make_record):
    """Online maps 0 (off by 5 cm) and 1 (perfect) were one in the end."""
    record = make_record("0" * 20 + "x" + "1" * 30, final="0" * 51, events={21: SlamEvent.MAPS_MERGED})
    record.T_map_cam[:20, 2, 3] += 0.05 * (-1.0) ** np.arange(20)
    largest, first, each = (summarize_slam(record, policy)["ate_online_rmse_m"] for policy in MAP_POLICIES)
    assert (largest, first) == (pytest.approx(0.0, abs=1e-6), pytest.approx(0.05, rel=0.1))
    assert each == pytest.approx(first * np.sqrt(20 / 50))


def test_an_unknown_map_policy_is_refused(make_record):
    with pytest.raises(ConfigError, match="unknown map policy 'larges'; did you mean 'largest'"):
        summarize_slam(make_record("000"), "larges")


def test_without_a_truth_what_needs_none_still_comes(make_record):
    record = make_record("..000000xx00x1111", events={12: SlamEvent.LOST, 13: SlamEvent.NEW_MAP})
    known, unknown = (
        summarize_slam(record),
        summarize_slam(replace(record, T_world_cam=np.full_like(record.T_world_cam, np.nan))),
    )
    same = {
        "status", "success", "map_policy", "completion", "completion_of_time", "loss_count", "losses_per_minute",
        "mean_time_between_losses_s", "relocalized_count", "mean_time_to_relocalize_s", "time_to_first_loss_s",
        "time_to_initialize_s", "frames_fed", "frames_tracked", "tracked_points_median", "maps", "loops_closed",
        "loss_causes", "failure", "log_tail", "lockstep_overruns", "frames_dropped",
    }  # fmt: skip
    assert {key: unknown[key] for key in same} == {key: known[key] for key in same}
    assert (unknown["frames_without_truth"], unknown["drift_segments"]) == (17, 0)
    assert is_nan(unknown, *(KEYS - same - {"frames_without_truth", "drift_segments", "losses", "map_results"}))
    for loss, expected in zip(unknown["losses"], known["losses"], strict=True):
        assert is_nan(loss, "distance_m", "rotation_deg")
        assert loss | {"distance_m": 0, "rotation_deg": 0} == expected | {"distance_m": 0, "rotation_deg": 0}
    for result, expected in zip(unknown["map_results"], known["map_results"], strict=True):
        assert is_nan(result, "ate_rmse_m")
        assert result | {"ate_rmse_m": 0} == expected | {"ate_rmse_m": 0}


def with_hole(record, *, nan):
    """Without the truth of frames 10 to 19, told by `has_truth` or by NaN."""
    stamps_ns, T = record.stamps_ns, record.T_world_cam
    real = ~np.isin(np.arange(len(T)), np.arange(10, 20))
    filled = np.full_like(T, np.nan) if nan else interpolate(Trajectory(stamps_ns[real], T[real]), stamps_ns)
    T = np.where(real[:, None, None], T, filled)
    return replace(record, T_world_cam=T, has_truth=None if nan else real), real


@pytest.mark.parametrize("nan", [False, True])
@pytest.mark.filterwarnings("ignore:the truth has no pose for 10 of 40 frames")
def test_frames_without_a_truth_are_tracked_or_lost_but_not_judged(make_record, nan):
    """As in the evaluation of the same run's files."""
    record, real = with_hole(make_record("..000000000000xxxx000000000xx00000000000"), nan=nan)
    record.final.T_map_cam[:, :3, 3] += 0.1 * np.random.default_rng(0).normal(size=(32, 3))
    truth = Trajectory(record.stamps_ns[real], record.T_world_cam[real])
    estimate = Trajectory(record.final.stamps_ns, record.final.T_map_cam)
    expected = evaluate(truth, estimate, frames_ns=record.stamps_ns).summary
    got = summarize_slam(record)
    both = KEYS & expected.keys() - {"losses"}
    assert both >= {*ACCURACY, *FAR_APART, *MOTION, "f1_area", "correct_rate", "completion", "ate_held_rmse_m"} - {
        "ate_online_rmse_m"
    }
    assert {key: got[key] for key in both} == pytest.approx({key: expected[key] for key in both}, nan_ok=True)
    assert [loss | {"outcome": ""} for loss in got["losses"]] == [
        pytest.approx(loss | {"outcome": ""}) for loss in expected["losses"]
    ]
    assert got["completion"] == 32 / 40
    # A pose is not judged in the hole, however wrong it is.
    record.final.T_map_cam[8:12, :3, 3] += 100.0
    again = summarize_slam(record)
    assert {key: again[key] for key in both} == pytest.approx({key: got[key] for key in both}, nan_ok=True)


def test_losses_carry_what_was_seen_and_their_causes_are_counted(make_record):
    causes = {3: "rotation", 5: "dark", 8: "rotation"}
    record = replace(make_record("000x0x00xx0x"), contexts={frame: context(cause) for frame, cause in causes.items()})
    summary = summarize_slam(record)
    assert [loss["context"] and loss["context"]["cause"] for loss in summary["losses"]] == [*causes.values(), None]
    assert summary["losses"][0]["context"] == asdict(context("rotation"))
    assert list(summary["loss_causes"].items()) == [("rotation", 2), ("dark", 1)]
    assert json.loads(json.dumps(summary["losses"]))[1]["context"]["explanation"] == "in words"
    assert (summary["time_to_first_loss_s"], summary["distance_to_first_loss_m"]) == pytest.approx((0.3, 0.3))


def test_a_crash_tells_why(make_record):
    told = {"failure": "killed by signal 11", "log_tail": "loading\nsegmentation fault\n", "frames_dropped": 3}
    summary = summarize_slam(replace(make_record("000xx", outcome="crashed"), **told))
    assert (summary["failure"], summary["frames_dropped"]) == ("killed by signal 11", 3)
    assert summary["log_tail"] == ["loading", "segmentation fault"]
    assert summarize_slam(replace(make_record("000xx"), log_tail="bye\n"))["log_tail"] == []


def test_an_offline_slam_has_no_online_poses(make_record):
    record = make_record("..000000x000")
    record = replace(record, T_map_cam=np.full_like(record.T_map_cam, np.nan))
    summary = summarize_slam(record)
    assert summary["ate_rmse_m"] == pytest.approx(0.0, abs=1e-6)
    assert is_nan(summary, "ate_online_rmse_m")
    assert (summary["completion"], summary["loss_count"]) == (pytest.approx(9 / 12), 1)
