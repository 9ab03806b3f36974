import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from slamgym.eval.accuracy import rpe, rpe_all_steps, rpe_pooled
from slamgym.geometry import planar_pose


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


@given(st.integers(0, 2**32 - 1), st.integers(2, 15), st.floats(0.0, 1.0))
@settings(deadline=None, max_examples=40)
def test_it_equals_its_definition(random_pair, seed, n, tracked_share):
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


def test_translation_by_hand(straight):
    # Off by 0, 1, 3 m: one step on by 1 and 2, the RMSE is sqrt(5 / 2); two steps on by 3.
    ref_T, est_T = straight([0, 1, 2]), straight([0, 2, 5])
    assert rpe_all_steps(ref_T, est_T).trans_rmse_m == pytest.approx((2.5**0.5 + 3) / 2)
    assert rpe_pooled(ref_T, est_T).trans_rmse_m == pytest.approx(((1 + 4 + 9) / 3) ** 0.5)


def test_rotation_by_hand(straight):
    # Turned by 0, 10, 30 degrees too far: one step on by 10 and 20, two steps on by 30.
    ref_T, est_T = straight([0, 0, 0]), straight([0, 0, 0], [0.0, 10.0, 30.0])
    assert rpe_all_steps(ref_T, est_T).rot_mean_deg == pytest.approx((15 + 30) / 2)
    assert rpe_pooled(ref_T, est_T).rot_mean_deg == pytest.approx((10 + 20 + 30) / 3)


def test_it_is_the_mean_of_the_steps(random_pair):
    ref_T, est_T = random_pair(5, 30)
    steps = [rpe(ref_T, est_T, d) for d in range(1, 30)]
    all_steps = rpe_all_steps(ref_T, est_T)
    assert all_steps.trans_rmse_m == pytest.approx(np.mean([step.trans_m.rmse for step in steps]))
    assert all_steps.rot_mean_deg == pytest.approx(np.mean([step.rot_deg.mean for step in steps]))


def test_it_does_not_depend_on_the_frame_of_the_map(random_pair):
    ref_T, est_T = random_pair(2, 20)
    moved = planar_pose(3.0, -2.0, 1.0, 5.0) @ est_T
    assert rpe_all_steps(ref_T, moved) == pytest.approx(rpe_all_steps(ref_T, est_T))


@pytest.mark.parametrize("n", [0, 1, 3])
def test_without_any_pair_it_is_nan(n, straight):
    T = straight(np.zeros(n))
    nowhere = np.zeros(n, dtype=bool)
    first_only = np.arange(n) < 1
    for tracked in (nowhere, first_only):
        assert np.isnan([*rpe_all_steps(T, T * np.nan if n > 1 and not tracked.any() else T, tracked)]).all()
        assert np.isnan([*rpe_pooled(T, T, tracked)]).all()
