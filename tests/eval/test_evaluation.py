import json
import math

import numpy as np
import pytest

from slamgym.errors import ConfigError, TrajectoryError, TrajectoryWarning
from slamgym.eval import EvalParams, evaluate
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
    shares = ("completion", "completion_of_time", "completion_of_distance", "correct_rate")
    assert [summary[key] for key in shares] == [1.0] * 4
    assert [summary[key] for key in ("frames", "poses", "matched", "frames_without_truth")] == [100, 100, 100, 0]
    errors = [value for key, value in summary.items() if key.startswith(("ate", "rpe", "drift_t", "drift_r"))]
    assert np.nanmax(errors) < 1e-5


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
    # Each pose holds until the next one, at most 1 s: all but 2 of the 9.9 s.
    assert summary["correct_rate"] == pytest.approx(7.9 / 9.9)
    unknown = ("f1_area", "ate_held_rmse_m", "velocity_m_per_frame", "acceleration_m_per_s2", "turning_on_spot_share")
    assert all(math.isnan(summary[key]) for key in unknown)
    assert (summary["duration_s"], summary["distance_m"]) == pytest.approx((9.9, 9.9))


@pytest.mark.filterwarnings("ignore:the truth begins")
def test_without_frames_the_rate_of_the_estimate_tells_what_is_a_gap():
    """6 poses in 0.05 s, then none for 0.94 s, ten times: lost for most of the time, though never for 1 s."""
    truth = Trajectory(np.arange(1000, dtype=np.int64) * 10_000_000, drive(1000).T)
    bursts = np.concatenate([np.arange(6) + 100 * k for k in range(10)])
    summary = evaluate(truth, estimate(truth, bursts)).summary
    assert (summary["max_gap_s"], summary["loss_count"], summary["success"]) == (0.1, 10, False)
    assert summary["completion"] == pytest.approx(0.06)
    asked = evaluate(truth, estimate(truth, bursts), EvalParams(max_gap_s=0.96)).summary
    assert (asked["max_gap_s"], asked["completion"], asked["loss_count"]) == (0.96, 1.0, 0)


def test_with_frames_every_frame_without_a_pose_is_a_loss():
    truth = drive(100)
    frames_ns = truth.stamps_ns[::5]
    kept = np.array([0, 5, 15, 20, 25])
    summary = evaluate(truth, estimate(truth, kept), frames_ns=frames_ns).summary
    assert (summary["frames"], summary["completion"], summary["max_gap_s"]) == (20, 5 / 20, 0.0)
    assert [(loss["start_frame"], loss["end_frame"]) for loss in summary["losses"]] == [(2, 2), (6, 19)]
    assert (summary["status"], summary["time_to_first_loss_s"]) == ("lost", pytest.approx(1.0))
    # 5 perfect poses of 5 estimated and 20 true ones: F1 = 2 * 5 / (5 + 20) at every threshold.
    assert summary["f1_area"] == pytest.approx(0.4, abs=1e-6)
    # Steps between neighbouring frames with a pose: 0-5, 15-20, 20-25 of 0-95.
    assert summary["completion_of_time"] == pytest.approx(3 / 19)
    # A pose holds until the next frame: 5 of 19 steps begin with one.
    assert summary["correct_rate"] == pytest.approx(5 / 19)
    # Held: right at five frames; from frame 25 on the robot believes that it stands there.
    held_m = np.linalg.norm(truth.positions[::5] - truth.positions[[0, 5, 5, 15, 20, *[25] * 15]], axis=1)
    assert summary["ate_held_rmse_m"] == pytest.approx(np.sqrt(np.mean(held_m**2)), rel=1e-6)
    assert summary["velocity_m_per_frame"] == pytest.approx(0.5, rel=0.02)


def test_errors_are_those_at_the_stamps_of_the_poses_and_not_of_the_frames():
    """Poses 13 ms after the frames, perfect at their own stamps: the truth has 200 poses a second."""
    n = np.arange(2000)
    T = np.array([mast_camera_pose(0.005 * i, 0.3 * np.sin(0.005 * i), 0.0, 1.0) for i in n])
    truth = Trajectory(n * 5_000_000, T)
    frames_ns = truth.stamps_ns[::7]
    late = estimate(truth, np.arange(2, 1998, 7))
    with pytest.warns(TrajectoryWarning, match="poses lie 10 ms from the frames"):
        summary = evaluate(truth, late, frames_ns=frames_ns).summary
    assert summary["completion"] > 0.99
    assert summary["ate_rmse_m"] == pytest.approx(0.0, abs=1e-6)


def test_a_lost_frame_does_not_get_the_pose_of_its_neighbour():
    truth = Trajectory(np.arange(100, dtype=np.int64) * 10_000_000, drive(100).T)
    summary = evaluate(truth, estimate(truth, np.delete(np.arange(100), 50)), frames_ns=truth.stamps_ns).summary
    assert (summary["loss_count"], summary["losses"][0]["start_frame"]) == (1, 50)
    assert summary["ate_rmse_m"] == pytest.approx(0.0, abs=1e-6)


def test_pairs_that_cross_are_no_obstacle():
    """The closest pair comes first, so the partners of two poses that lie close together may be crossed."""
    ms = 1_000_000
    truth = drive(6)
    truth = Trajectory(np.array([0, 20, 40, 60, 80, 100]) * ms, truth.T)
    est = Trajectory(np.array([0, 21, 29, 59, 81, 100]) * ms, truth.T)
    crossed = Trajectory(np.array([0, 19, 38, 41, 80, 100]) * ms, truth.T)
    for other in (est, crossed):
        summary = evaluate(truth, other, EvalParams(max_difference_s=0.1)).summary
        assert summary["matched"] == 6
        assert np.isfinite(summary["rpe_step_trans_rmse_m"])


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
    assert summary["correct_rate"] == 0.0
    assert math.isnan(summary["ate_rmse_m"])
    assert math.isnan(summary["mean_time_between_losses_s"])
    assert math.isnan(summary["time_to_initialize_s"])


@pytest.mark.parametrize(("alignment", "needed"), [("se3", 3), ("sim3", 3), ("first_pose", 1), ("none", 1)])
@pytest.mark.filterwarnings("ignore:the truth begins", "ignore:orientations are off")
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
@pytest.mark.filterwarnings("ignore:the estimate has 120 poses", "ignore:orientations are off")
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


def with_hole(truth):
    """Without the poses from 3.0 to 5.9 s."""
    return Trajectory(np.delete(truth.stamps_ns, np.s_[30:60]), np.delete(truth.T, np.s_[30:60], axis=0))


@pytest.mark.parametrize("known", [False, True])
def test_a_hole_of_the_truth_is_told_and_what_lies_in_it_not_judged(known):
    truth = drive(100)
    with pytest.warns(TrajectoryWarning, match=r"no pose for 30 of 100 frames \(1 holes of 3\.1 s in all\)"):
        summary = evaluate(
            with_hole(truth), estimate(truth, np.arange(100)), frames_ns=truth.stamps_ns if known else None
        ).summary
    assert (summary["completion"], summary["completion_of_time"], summary["losses"]) == (1.0, 1.0, [])
    assert (summary["frames"], summary["frames_without_truth"]) == (100 if known else 70, 30)
    # Before the hole the last pose holds for 1 s, or until the next frame.
    assert summary["correct_rate"] == pytest.approx((6.9 if known else 7.8) / 9.9)


@pytest.mark.filterwarnings("ignore:the truth has no pose")
@pytest.mark.parametrize("known", [False, True])
def test_getting_lost_in_a_hole_of_the_truth_counts(known):
    truth = drive(100)
    summary = evaluate(
        with_hole(truth), estimate(truth, np.r_[0:40, 55:100]), frames_ns=truth.stamps_ns if known else None
    ).summary
    assert summary["completion"] == pytest.approx(0.85, abs=0.011)
    assert summary["success"] is False
    (loss,) = summary["losses"]
    assert (loss["start_s"], loss["duration_s"]) == pytest.approx((4.0, 1.5), abs=0.11)


@pytest.mark.filterwarnings("ignore:the truth has no pose")
def test_getting_lost_after_the_end_of_the_truth_counts():
    truth = drive(100)
    half = Trajectory(truth.stamps_ns[:50], truth.T[:50])
    summary = evaluate(half, estimate(truth, np.arange(60)), frames_ns=truth.stamps_ns).summary
    assert (summary["status"], summary["completion"], summary["frames_without_truth"]) == ("lost", 0.6, 50)


def test_on_a_straight_path_the_orientations_settle_the_roll():
    T = np.array([mast_camera_pose(0.01 * i, 0.0, 0.0, 1.0) for i in range(100)])
    truth = Trajectory(np.arange(100, dtype=np.int64) * FRAME_NS, T)
    shaky = T.copy()
    shaky[:, :3, 3] += 1e-3 * np.random.default_rng(0).normal(size=(100, 3))
    summary = evaluate(truth, Trajectory(truth.stamps_ns, T_WORLD_MAP @ shaky)).summary
    assert summary["ate_rmse_m"] < 2e-3
    assert summary["ate_rot_max_deg"] < 1.0
    assert summary["correct_rate"] == 1.0


@pytest.mark.filterwarnings("ignore:orientations are off")
def test_a_stuck_estimate_is_a_result_for_every_alignment():
    truth = drive(50)
    stuck = Trajectory(truth.stamps_ns, np.tile(np.eye(4), (50, 1, 1)))
    for alignment in ("se3", "sim3"):
        with pytest.warns(TrajectoryWarning, match="49 poses repeat the one before"):
            summary = evaluate(truth, stuck, EvalParams(alignment=alignment)).summary
        assert math.isnan(summary["ate_rmse_m"]) == (alignment == "sim3")
        assert summary["correct_rate"] < 0.2


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
    with pytest.raises(ConfigError, match="no max_gap_s with frames"):
        evaluate(truth, truth, EvalParams(max_gap_s=0.5), truth.stamps_ns)
    with pytest.raises(TrajectoryError, match="a truth with poses"):
        evaluate(Trajectory(truth.stamps_ns[:0], truth.T[:0]), truth)
