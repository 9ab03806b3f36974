import json
import math

import numpy as np
import pytest

from slamgym.errors import ConfigError, TrajectoryError, TrajectoryWarning
from slamgym.eval.evaluation import EvalParams, evaluate
from slamgym.eval.summary import without_nan
from slamgym.eval.trajectories import Trajectory
from slamgym.geometry import inverse, mast_camera_pose

FRAME_NS = 100_000_000
T_WORLD_MAP = mast_camera_pose(3.0, -2.0, 0.7, 1.0)


def drive(n):
    """n poses, 0.1 s, 0.1 m and 0.05 rad apart."""
    yaw = 0.05 * np.arange(n)
    xy = np.cumsum(0.1 * np.column_stack([np.cos(yaw), np.sin(yaw)]), axis=0)
    T = np.array([mast_camera_pose(*xy[i], yaw[i], 1.0) for i in range(n)]).reshape(n, 4, 4)
    return Trajectory(np.arange(n, dtype=np.int64) * FRAME_NS, T)


def estimate(truth, chosen, moved=None):
    """The truth in another frame at the chosen poses; moved: how far each is off upwards, metres."""
    T = inverse(T_WORLD_MAP) @ truth.T[chosen]
    if moved is not None:
        T[:, :3, 3] += np.outer(moved, inverse(T_WORLD_MAP)[:3, 2])
    return Trajectory(truth.stamps_ns[chosen], T)


def test_a_perfect_estimate():
    truth = drive(100)
    summary = evaluate(truth, estimate(truth, np.arange(100))).summary
    assert (summary["status"], summary["success"], summary["losses"], summary["scale"]) == ("ok", True, [], 1.0)
    assert (summary["completion"], summary["completion_time"], summary["completion_distance"]) == (1.0, 1.0, 1.0)
    assert (summary["correct_rate"], summary["relocalization_score"]) == (1.0, 1.0)
    assert (summary["frames"], summary["poses"], summary["matched"]) == (100, 100, 100)
    errors = [value for key, value in summary.items() if key.startswith(("ate", "rpe", "drift"))]
    assert errors == pytest.approx([0.0] * len(errors), abs=1e-6)


def test_without_frames_only_long_gaps_are_losses():
    truth = drive(100)
    every_fifth = np.arange(0, 100, 5)
    without_a_while = every_fifth[(every_fifth <= 30) | (every_fifth >= 60)]
    assert evaluate(truth, estimate(truth, every_fifth)).summary["completion"] == 1.0
    summary = evaluate(truth, estimate(truth, without_a_while)).summary
    # Frames 31 to 59 lie in the gap of 3 s.
    assert summary["completion"] == pytest.approx(0.71)
    (loss,) = summary["losses"]
    assert (loss["start_frame"], loss["end_frame"], loss["outcome"]) == (31, 59, "relocalized")
    assert (summary["status"], summary["success"], summary["loss_count"]) == ("ok", False, 1)
    assert math.isnan(summary["f1_area"])
    # Each pose holds until the next one, at most 1 s: all but 2 of the 9.9 s.
    assert summary["correct_rate"] == pytest.approx(7.9 / 9.9)


def test_with_frames_every_frame_without_a_pose_is_a_loss():
    truth = drive(100)
    frames_ns = truth.stamps_ns[::5]
    kept = np.array([0, 5, 15, 20, 25])
    summary = evaluate(truth, estimate(truth, kept), frames_ns=frames_ns).summary
    assert (summary["frames"], summary["completion"]) == (20, 5 / 20)
    assert [(loss["start_frame"], loss["end_frame"]) for loss in summary["losses"]] == [(2, 2), (6, 19)]
    assert (summary["status"], summary["time_to_first_loss_s"]) == ("lost", pytest.approx(1.0))
    # 5 perfect poses of 5 estimated and 20 true ones: F1 = 2 * 5 / (5 + 20) at every threshold.
    assert summary["f1_area"] == pytest.approx(0.4, abs=1e-6)
    # Steps between neighbouring frames with a pose: 0-5, 15-20, 20-25 of 0-95.
    assert summary["completion_time"] == pytest.approx(3 / 19)


def test_frames_in_a_relative_error_keep_their_place():
    truth = drive(60)
    kept = np.array([*range(20), *range(40, 60)])
    jump = np.where(kept < 20, 0.0, 0.3)
    with_frames = evaluate(truth, estimate(truth, kept, jump), frames_ns=truth.stamps_ns).summary
    without = evaluate(truth, estimate(truth, kept, jump)).summary
    assert with_frames["rpe_step_trans_rmse_m"] == pytest.approx(0.0, abs=1e-6)
    # One pair in 39 spans the jump: the poses beside it follow one another.
    assert without["rpe_step_trans_rmse_m"] == pytest.approx(0.3 / np.sqrt(39), rel=1e-3)


def test_an_empty_estimate_was_never_initialised():
    truth = drive(50)
    summary = evaluate(truth, Trajectory(np.empty(0, np.int64), np.empty((0, 4, 4)))).summary
    assert (summary["status"], summary["success"], summary["completion"]) == ("init_failed", False, 0.0)
    assert (summary["correct_rate"], summary["relocalization_score"]) == (0.0, 0.0)
    assert math.isnan(summary["ate_rmse_m"])
    assert math.isnan(summary["mean_time_between_losses_s"])
    assert math.isnan(summary["time_to_initialize_s"])


@pytest.mark.parametrize(("alignment", "needed"), [("se3", 3), ("sim3", 3), ("first_pose", 1), ("none", 1)])
def test_below_the_poses_that_an_alignment_needs_there_is_no_ate(alignment, needed):
    truth = drive(50)
    for n in range(1, 4):
        result = evaluate(truth, estimate(truth, np.arange(n)), EvalParams(alignment=alignment))
        assert math.isnan(result.summary["ate_rmse_m"]) == (n < needed)
        assert (result.summary["correct_rate"] == 0.0) == (n < needed or alignment == "none")


def test_lost_at_once_and_never_again():
    truth = drive(50)
    summary = evaluate(truth, estimate(truth, np.array([0])), frames_ns=truth.stamps_ns).summary
    assert (summary["status"], summary["completion"], summary["loss_count"]) == ("lost", 0.02, 1)
    assert summary["losses"][0]["outcome"] == "never"
    assert summary["mean_time_between_losses_s"] == 0.0


def test_the_scale_is_corrected_only_when_asked_for():
    truth = drive(60)
    half = estimate(truth, np.arange(60))
    half = Trajectory(half.stamps_ns, half.T * np.array([[1, 1, 1, 0.5]] * 3 + [[1, 1, 1, 1]]))
    assert evaluate(truth, half).summary["ate_rmse_m"] > 0.1
    scaled = evaluate(truth, half, EvalParams(alignment="sim3")).summary
    assert scaled["scale"] == pytest.approx(2.0)
    assert scaled["ate_rmse_m"] == pytest.approx(0.0, abs=1e-6)
    assert scaled["rpe_step_trans_rmse_m"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("convention", ["tum", "evo"])
@pytest.mark.parametrize("rate", [1, 3])
@pytest.mark.filterwarnings("ignore:80 of the estimate")
def test_estimates_denser_or_sparser_than_the_truth(convention, rate):
    dense = drive(120)
    sparse = Trajectory(dense.stamps_ns[::rate] + 7_000_000, dense.T[::rate])
    params = EvalParams(association=convention, max_difference_s=0.06)
    for truth, est in ((dense, sparse), (sparse, dense)):
        summary = evaluate(truth, est, params).summary
        assert summary["status"] == "ok"
        assert summary["matched"] >= 40
        assert np.isfinite(summary["rpe_second_trans_rmse_m"])


def test_nothing_is_mutated_and_everything_is_json():
    truth = drive(40)
    est = estimate(truth, np.arange(0, 40, 2))
    before = [array.copy() for array in (truth.stamps_ns, truth.T, est.stamps_ns, est.T)]
    result = evaluate(truth, est, EvalParams(alignment="sim3"), truth.stamps_ns)
    for array, copy in zip((truth.stamps_ns, truth.T, est.stamps_ns, est.T), before, strict=True):
        np.testing.assert_array_equal(array, copy)
    json.dumps(without_nan(result.summary), allow_nan=False)


def test_frames_and_truth_that_have_holes_are_told():
    truth = drive(100)
    with_hole = Trajectory(np.delete(truth.stamps_ns, np.s_[30:60]), np.delete(truth.T, np.s_[30:60], axis=0))
    everywhere = estimate(truth, np.arange(100))
    with pytest.warns(TrajectoryWarning, match=r"1 holes of more than 1 s, 3\.1 s in all"):
        summary = evaluate(with_hole, everywhere).summary
    assert (summary["frames"], summary["completion"], summary["losses"]) == (100, 1.0, [])
    # 2.1 of the 9.9 s cannot be judged: the pose at 2.9 s holds for no longer than 1 s.
    assert summary["correct_rate"] == pytest.approx(7.8 / 9.9)
    with pytest.warns(TrajectoryWarning, match="30 of 100 frames have no true pose"):
        summary = evaluate(with_hole, everywhere, frames_ns=truth.stamps_ns).summary
    assert (summary["frames"], summary["completion"]) == (70, 1.0)


@pytest.mark.filterwarnings("ignore:the truth has 1 holes")
def test_getting_lost_in_a_hole_of_the_truth_counts():
    truth = drive(100)
    with_hole = Trajectory(np.delete(truth.stamps_ns, np.s_[30:60]), np.delete(truth.T, np.s_[30:60], axis=0))
    summary = evaluate(with_hole, estimate(truth, np.r_[0:40, 55:100])).summary
    assert summary["completion"] == pytest.approx(0.85, abs=0.011)
    (loss,) = summary["losses"]
    assert (loss["start_s"], loss["duration_s"]) == pytest.approx((4.0, 1.5), abs=0.11)


def test_what_has_nothing_in_common_is_refused():
    truth = drive(20)
    later = Trajectory(truth.stamps_ns + 10**12, truth.T)
    with pytest.raises(TrajectoryError, match="same clock"):
        evaluate(truth, later)
    with pytest.raises(TrajectoryError, match="frames with a true pose"):
        evaluate(truth, truth, frames_ns=later.stamps_ns)
    with pytest.raises(ConfigError, match="did you mean 'sim3'"):
        EvalParams.checked({"alignment": "sim"})
    with pytest.raises(ConfigError, match="max_gap_s"):
        EvalParams.checked({"max_gap_s": -1})
