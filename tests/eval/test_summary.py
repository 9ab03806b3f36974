"""Every key of a summary holds the figure that its name says, of a drive on which no two figures are alike."""

from dataclasses import asdict

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from slamgym.eval import summary
from slamgym.eval.accuracy import ate, rpe, rpe_all_steps, segment_drift
from slamgym.eval.robustness import completion, correct_rate, exposure, failure_rates, find_gaps, precision_recall_area
from slamgym.eval.summary import FramePoses, align_frames
from slamgym.eval.trajectories import sequence_attributes
from slamgym.geometry import mast_camera_pose

N = 400
LOST = np.r_[0:12, 100:130, 200:205, 390:400]


@pytest.fixture(scope="module")
def poses():
    """Uneven in time, speed and turning; errors of some 0.15 m and 9 degrees; four runs of frames without a pose."""
    rng = np.random.default_rng(0)
    stamps_ns = np.cumsum(rng.integers(20, 60, N)) * 1_000_000 + 1_700_000_000_000_000_000
    speed = np.concatenate([np.full(100, 0.01), np.full(100, 0.05), np.zeros(50), np.full(150, 0.03)])
    yaw = np.cumsum(np.where(speed == 0, 0.03, 0.01) * rng.choice([0.5, 1.5], N))
    xy = np.cumsum(speed[:, None] * np.column_stack([np.cos(yaw), np.sin(yaw)]), axis=0)
    ref_T = np.array([mast_camera_pose(*xy[i], yaw[i], 1.0) for i in range(N)])
    est_T = np.linalg.inv(ref_T[7]) @ ref_T
    est_T[:, :3, 3] += 0.09 * rng.normal(size=(N, 3))
    est_T[:, :3, :3] = est_T[:, :3, :3] @ Rotation.from_rotvec(0.09 * rng.normal(size=(N, 3))).as_matrix()
    judged = ~np.isin(np.arange(N), LOST)
    est_T[~judged] = np.nan
    return FramePoses(stamps_ns, ref_T, est_T, judged)


def test_accuracy(poses):
    stamps_ns, ref_T, est_T, judged = poses[:4]
    got = summary.accuracy_summary(align_frames(poses, "se3")[0])
    absolute = ate(ref_T[judged], est_T[judged])
    second = rpe(ref_T, est_T, 1.0, "seconds", stamps_ns=stamps_ns, tracked=judged)
    step, metre = rpe(ref_T, est_T, tracked=judged), rpe(ref_T, est_T, 1.0, "metres", tracked=judged)
    every, drift = rpe_all_steps(ref_T, est_T, judged), segment_drift(ref_T, est_T, tracked=judged)
    expected = {
        **{f"ate_{name}_m": value for name, value in asdict(absolute.trans_m).items()},
        **{f"ate_rot_{name}_deg": value for name, value in asdict(absolute.rot_deg).items()},
        "rpe_step_trans_rmse_m": step.trans_m.rmse,
        "rpe_step_rot_mean_deg": step.rot_deg.mean,
        "rpe_second_trans_rmse_m": second.trans_m.rmse,
        "rpe_second_rot_mean_deg": second.rot_deg.mean,
        "rpe_metre_trans_rmse_m": metre.trans_m.rmse,
        "rpe_metre_rot_mean_deg": metre.rot_deg.mean,
        "rpe_trans_rmse_m": every.trans_rmse_m,
        "rpe_rot_mean_deg": every.rot_mean_deg,
        "drift_trans_percent": drift.trans_percent,
        "drift_rot_deg_per_m": drift.rot_deg_per_m,
        "drift_segments": drift.segments,
    }
    assert got == pytest.approx(expected)
    assert len({round(value, 12) for value in got.values()}) == len(got)


def test_the_rpe_over_all_steps_is_left_out_where_it_would_take_minutes(poses, monkeypatch):
    monkeypatch.setattr(summary, "ALL_STEPS_LIMIT", N)
    assert np.isfinite(summary.accuracy_summary(poses)["rpe_trans_rmse_m"])
    monkeypatch.setattr(summary, "ALL_STEPS_LIMIT", N - 1)
    got = summary.accuracy_summary(poses)
    assert np.isnan([got["rpe_trans_rmse_m"], got["rpe_rot_mean_deg"]]).all()


def test_tracking(poses):
    stamps_ns, ref_T, _, tracked = poses[:4]
    losses = find_gaps(stamps_ns, ref_T, tracked)
    got = summary.tracking_summary(stamps_ns, ref_T, tracked, losses)
    shares, rates = completion(stamps_ns, ref_T, tracked), failure_rates(losses, exposure(stamps_ns, ref_T, tracked))
    assert got == {
        "completion": shares.frames,
        "completion_of_time": shares.time,
        "completion_of_distance": shares.distance,
        "losses": [asdict(loss) for loss in losses],
        "time_to_first_loss_s": (stamps_ns[100] - stamps_ns[0]) * 1e-9,
        "distance_to_first_loss_m": pytest.approx(np.linalg.norm(np.diff(ref_T[:101, :3, 3], axis=0), axis=1).sum()),
        **rates._asdict(),
    }
    assert (got["loss_count"], got["relocalized_count"]) == (3, 2)
    figures = [value for key, value in got.items() if key not in ("losses", "loss_count", "relocalized_count")]
    assert len({round(value, 9) for value in figures}) == len(figures)


@pytest.mark.parametrize("known", [True, False])
def test_correctness(poses, known):
    aligned, _ = align_frames(poses, "se3")
    stamps_ns, ref_T, est_T, judged = aligned[:4]
    trans_m = np.linalg.norm(ref_T[:, :3, 3] - est_T[:, :3, 3], axis=1)
    relative = Rotation.from_matrix(ref_T[judged, :3, :3]).inv() * Rotation.from_matrix(est_T[judged, :3, :3])
    rot_deg = np.full(N, np.nan)
    rot_deg[judged] = np.rad2deg(relative.magnitude())
    correct = (trans_m <= 0.1) & (rot_deg <= 10.0)
    # Both bounds decide on some frames.
    assert min((trans_m > 0.1).sum(), ((trans_m <= 0.1) & (rot_deg > 10.0)).sum()) > 10
    counted = np.ones(N, dtype=np.bool_) if known else judged
    got = summary.correctness_summary(aligned, N + 50, N - 20, frames_known=known)
    assert got["correct_rate"] == correct_rate(stamps_ns[counted], correct[counted], stamps_ns[0], stamps_ns[-1])
    errors = np.concatenate([trans_m[judged], np.full(N + 50 - judged.sum(), np.nan)])
    assert got["f1_area"] == pytest.approx(precision_recall_area(errors, N - 20, 0.5).f1)


def test_a_frame_that_is_known_to_be_lost_ends_what_counts_as_correct(poses):
    every_other = poses._replace(est_T=poses.ref_T, judged=np.arange(N) % 2 == 0, aligned=True)
    known, unknown = (
        summary.correctness_summary(every_other, N // 2, N, frames_known=known)["correct_rate"]
        for known in (True, False)
    )
    assert unknown == pytest.approx(1.0)
    assert known == pytest.approx(0.5, abs=0.05)


def test_poses_that_are_not_aligned_have_no_absolute_error_and_are_not_correct(poses):
    few = poses._replace(judged=np.arange(N) < 2, est_T=poses.ref_T)
    same, scale = align_frames(few, "se3")
    assert (same.aligned, scale) == (False, 1.0)
    assert np.isnan(summary.accuracy_summary(same)["ate_rmse_m"])
    assert summary.accuracy_summary(same)["rpe_step_trans_rmse_m"] == pytest.approx(0.0, abs=1e-9)
    assert summary.correctness_summary(same, 2, N, frames_known=True) == {"correct_rate": 0.0, "f1_area": 0.0}


def test_motion(poses):
    attributes = sequence_attributes(poses.stamps_ns, poses.ref_T)._asdict()
    got = summary.motion_summary(poses.stamps_ns, poses.ref_T)
    assert got == {key: attributes[key] for key in got}
    assert set(attributes) - set(got) == {"frames", "duration_s", "path_length_m"}
