import time
from dataclasses import asdict

import numpy as np
import pytest
from evo.core import geometry as evo_geometry
from evo.core import metrics as evo
from evo.core.trajectory import PosePath3D
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import ErrorStats, align_rigid, ate, rpe, rpe_all_steps, rpe_pooled
from slamgym.eval.trajectories import associate, read_tum
from slamgym.geometry import from_quaternion

seeds = st.integers(0, 2**32 - 1)
lengths = st.integers(4, 25)
scales = st.sampled_from([1e-6, 1e-3, 0.1, 3.0])


def random_pair(seed, n, noise):
    """A random walk and a noisy copy in another frame, (n, 4, 4) each; noise in metres and radians."""
    rng = np.random.default_rng(seed)
    turns = Rotation.from_rotvec(rng.normal(size=(n, 3)))
    ref_T = from_quaternion(np.cumsum(rng.normal(size=(n, 3)), axis=0), turns.as_quat())
    shake = Rotation.from_rotvec(noise * rng.normal(size=(n, 3)))
    noise_T = from_quaternion(noise * rng.normal(size=(n, 3)), shake.as_quat())
    return ref_T, np.linalg.inv(random_frame(rng)) @ ref_T @ noise_T


def random_frame(rng):
    return from_quaternion(10.0 * rng.normal(size=(1, 3)), rng.normal(size=(1, 4)))[0]


def evo_stats(metric, ref_T, est_T, align=False):
    ref, est = (PosePath3D(poses_se3=list(T)) for T in (ref_T, est_T))
    if align:
        est.align(ref)
    metric.process_data((ref, est))
    stats = metric.get_all_statistics()
    stats.pop("sse")
    return stats


def evo_rpe(relation, ref_T, est_T, delta):
    return evo_stats(evo.RPE(relation, delta, evo.Unit.frames, all_pairs=True), ref_T, est_T)


def slow_rpe_by_step(ref_T, est_T, tracked, map_ids):
    """For every step with pairs: squared translation errors and rotation errors in degrees, by the definition."""
    by_step = []
    for d in range(1, len(ref_T)):
        errors = []
        for i in range(len(ref_T) - d):
            j = i + d
            if tracked[i] and tracked[j] and map_ids[i] == map_ids[j]:
                ref_step, est_step = np.linalg.inv(ref_T[i]) @ ref_T[j], np.linalg.inv(est_T[i]) @ est_T[j]
                error = np.linalg.inv(ref_step) @ est_step
                angle = np.degrees(Rotation.from_matrix(error[:3, :3]).magnitude())
                errors.append((np.sum(error[:3, 3] ** 2), angle))
        if errors:
            by_step.append(np.array(errors).T)
    return by_step


@given(seeds, lengths, scales)
@settings(deadline=None, max_examples=40)
def test_alignment_equals_evo(seed, n, noise):
    ref_T, est_T = random_pair(seed, n, noise)
    source, target = est_T[:, :3, 3], ref_T[:, :3, 3]
    R, t, _ = evo_geometry.umeyama_alignment(source.T, target.T)
    T_target_source = align_rigid(source, target)
    np.testing.assert_allclose(T_target_source[:3, :3], R, atol=1e-9)
    np.testing.assert_allclose(T_target_source[:3, 3], t, atol=1e-9)
    np.testing.assert_array_equal(T_target_source[3], [0, 0, 0, 1])


@given(seeds, lengths, scales)
@settings(deadline=None, max_examples=40)
def test_ate_equals_evo(seed, n, noise):
    ref_T, est_T = random_pair(seed, n, noise)
    for alignment, align in (("rigid", True), ("none", False)):
        expected = evo_stats(evo.APE(evo.PoseRelation.translation_part), ref_T, est_T, align)
        assert asdict(ate(ref_T, est_T, alignment)) == pytest.approx(expected, abs=1e-9)


@given(seeds, lengths, scales, st.integers(1, 3))
@settings(deadline=None, max_examples=40)
def test_rpe_equals_evo(seed, n, noise, delta):
    ref_T, est_T = random_pair(seed, n, noise)
    stats = rpe(ref_T, est_T, delta)
    trans = evo_rpe(evo.PoseRelation.translation_part, ref_T, est_T, delta)
    rot = evo_rpe(evo.PoseRelation.rotation_angle_deg, ref_T, est_T, delta)
    assert asdict(stats.trans_m) == pytest.approx(trans, abs=1e-9)
    assert asdict(stats.rot_deg) == pytest.approx(rot, abs=1e-7 if noise > 1 else 1e-9)


@given(seeds, st.integers(2, 15), st.floats(0.0, 1.0))
@settings(deadline=None, max_examples=40)
def test_rpe_over_all_steps_equals_its_definition(seed, n, tracked_share):
    rng = np.random.default_rng(seed)
    ref_T, est_T = random_pair(seed, n, 0.3)
    tracked = rng.random(n) < tracked_share
    map_ids = rng.integers(0, 2, size=n)
    by_step = slow_rpe_by_step(ref_T, est_T, tracked, map_ids)
    est_T[~tracked] = np.nan
    all_steps = rpe_all_steps(ref_T, est_T, tracked, map_ids)
    pooled = rpe_pooled(ref_T, est_T, tracked, map_ids)
    if not by_step:
        assert np.isnan([*all_steps, *pooled]).all()
        return
    assert all_steps.trans_rmse_m == pytest.approx(np.mean([np.sqrt(trans_sq.mean()) for trans_sq, _ in by_step]))
    assert all_steps.rot_mean_deg == pytest.approx(np.mean([rot.mean() for _, rot in by_step]))
    assert pooled.trans_rmse_m == pytest.approx(np.sqrt(np.mean(np.concatenate([trans_sq for trans_sq, _ in by_step]))))
    assert pooled.rot_mean_deg == pytest.approx(np.mean(np.concatenate([rot for _, rot in by_step])))


def test_a_step_counts_the_frames_without_a_pose():
    ref_T, est_T = random_pair(0, 5, 0.1)
    tracked = np.array([True, False, True, False, True])
    assert np.isnan(rpe(ref_T, est_T, 1, tracked).trans_m.rmse)
    expected = rpe(ref_T[::2], est_T[::2], 1)
    assert rpe(ref_T, est_T, 2, tracked) == expected


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-9, 1e-5, 0.5, 3.0, np.pi])
def test_rotation_errors_are_exact_for_any_angle(angle):
    ref_T, _ = random_pair(1, 2, 0.1)
    est_T = ref_T.copy()
    est_T[1, :3, :3] = est_T[1, :3, :3] @ Rotation.from_rotvec([0.0, angle, 0.0]).as_matrix()
    assert rpe(ref_T, est_T).rot_deg.mean == pytest.approx(np.degrees(angle), rel=1e-6, abs=1e-13)


def test_the_relative_error_does_not_depend_on_the_frame_of_the_map():
    ref_T, est_T = random_pair(2, 20, 0.1)
    moved = random_frame(np.random.default_rng(3)) @ est_T
    assert rpe_all_steps(ref_T, moved) == pytest.approx(rpe_all_steps(ref_T, est_T))


@pytest.mark.parametrize("direction", [[1.0, 0.0, 0.0], [0.3, -0.5, 0.8], [0.0, 0.0, 0.0]])
def test_alignment_of_points_on_a_line_or_in_one_place(direction):
    target = np.linspace(0.0, 5.0, 6)[:, None] * np.array(direction)
    turn = Rotation.from_euler("xyz", [0.4, -1.0, 2.0])
    source = turn.apply(target) + np.array([1.0, 2.0, 3.0])
    T = align_rigid(source, target)
    moved = source @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(moved, target, atol=1e-12)
    assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


def test_alignment_never_mirrors():
    target = np.random.default_rng(0).normal(size=(10, 3))
    T = align_rigid(target * [1.0, 1.0, -1.0], target)
    assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


def test_no_scale_is_corrected():
    target = np.random.default_rng(0).normal(size=(10, 3))
    np.testing.assert_allclose(np.linalg.det(align_rigid(2.0 * target, target)), 1.0)


def test_statistics_of_nothing_are_nan():
    assert np.isnan(list(asdict(ErrorStats.of(np.empty(0))).values())).all()


@pytest.mark.parametrize("n", [0, 1])
def test_relative_errors_without_any_pair_are_nan(n):
    T = np.tile(np.eye(4), (n, 1, 1))
    assert np.isnan([*rpe_all_steps(T, T), *rpe_pooled(T, T), rpe(T, T).trans_m.rmse]).all()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda ref, est: ate(ref[:2], est[:2]), "at least 3 pairs of points, got 2"),
        (lambda ref, est: ate(ref, est[:3]), r"got shapes \(5, 4, 4\) and \(3, 4, 4\)"),
        (lambda ref, est: ate(ref, est * np.nan), "finite"),
        (lambda ref, est: ate(ref, est, "rigit"), "did you mean 'rigid'"),
        (lambda ref, est: rpe(ref, est * np.nan), "mask them"),
        (lambda ref, est: rpe(ref, est, 0), "at least 1 frame"),
        (lambda ref, est: rpe(ref, est[:3]), "in pairs"),
        (lambda ref, est: align_rigid(ref[:, 0], est[:, 0]), r"expected two arrays \(N, 3\)"),
    ],
)
def test_what_cannot_be_evaluated_is_refused(call, message):
    with pytest.raises(TrajectoryError, match=message):
        call(*random_pair(0, 5, 0.1))


def test_two_thousand_frames_over_all_steps_take_about_a_second():
    ref_T, est_T = random_pair(0, 2000, 0.1)
    start = time.process_time()
    rpe_all_steps(ref_T, est_T)
    assert time.process_time() - start < 2.0


@pytest.fixture(scope="module")
def fr2_desk(shared_data):
    folder = shared_data / "trajectories"
    ref = read_tum(folder / "fr2_desk_groundtruth.txt", repeated_stamps="last")
    return ref, read_tum(folder / "fr2_desk_ORB.txt")


def associated(ref, est, max_difference_ns, convention):
    i, j = associate(ref, est, max_difference_ns, convention)
    return ref.T[i], est.T[j]


def test_published_ate_of_the_tum_tools(fr2_desk):
    ref_T, est_T = associated(*fr2_desk, 20_000_000, "tum")
    assert len(ref_T) == 2223
    published = ErrorStats(rmse=0.008144, mean=0.007514, median=0.007432, std=0.003140, min=0.000332, max=0.024329)
    assert asdict(ate(ref_T, est_T)) == pytest.approx(asdict(published), abs=6e-7)


def test_published_ate_of_evo(fr2_desk):
    ref_T, est_T = associated(*fr2_desk, 10_000_000, "evo")
    published = ErrorStats(rmse=0.008119, mean=0.007492, median=0.007415, std=0.003129, min=0.000350, max=0.024300)
    stats = ate(ref_T, est_T)
    assert asdict(stats) == pytest.approx(asdict(published), abs=6e-7)
    # One estimate lies exactly between two true poses; evo's float stamps round that tie to the later one.
    assert stats.rmse**2 * len(ref_T) == pytest.approx(0.143305, abs=2.5e-6)


def test_published_rpe(fr2_desk):
    stats = rpe(*associated(*fr2_desk, 10_000_000, "evo")).trans_m
    published = {"rmse": 0.003490, "mean": 0.003038, "median": 0.002750, "max": 0.019485}
    assert {key: asdict(stats)[key] for key in published} == pytest.approx(published, abs=6e-7)


def test_published_ate_of_rgbdslam(shared_data):
    folder = shared_data / "trajectories"
    pair = read_tum(folder / "freiburg1_xyz-groundtruth.txt"), read_tum(folder / "freiburg1_xyz-rgbdslam.txt")
    ref_T, est_T = associated(*pair, 10_000_000, "evo")
    assert ate(ref_T, est_T).rmse == pytest.approx(0.013470, abs=6e-7)
    for relation, stats in zip(
        (evo.PoseRelation.translation_part, evo.PoseRelation.rotation_angle_deg), rpe(ref_T, est_T), strict=True
    ):
        assert asdict(stats) == pytest.approx(evo_rpe(relation, ref_T, est_T, 1), abs=1e-9)
