import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from slamgym.eval.accuracy import absolute_errors, align, free_turn
from slamgym.geometry import planar_pose


def straight(n=50):
    """1 m along x, swaying by 3 degrees."""
    return np.array([planar_pose(0.02 * i, 0.0, np.deg2rad(3 * np.sin(i))) for i in range(n)])


def noisy(T, error_m, seed=0):
    """A copy in another frame, positions off by some `error_m`, orientations right."""
    T = T.copy()
    T[:, :3, 3] += error_m * np.random.default_rng(seed).normal(size=(len(T), 3))
    T_other = planar_pose(2.0, -1.0, 0.8)
    T_other[:3, :3] = Rotation.from_euler("xyz", [0.4, -1.0, 2.0]).as_matrix()
    return T_other @ T


def median_angles(ref_T, est_T):
    """Of the aligned orientations, as they are and after the free turn, degrees."""
    aligned = align(ref_T, est_T).apply(est_T)
    turned = aligned.copy()
    turned[:, :3, :3] = free_turn(ref_T, aligned) @ turned[:, :3, :3]
    return tuple(np.median(absolute_errors(ref_T, T)[1]) for T in (aligned, turned))


@pytest.mark.parametrize("error_m", [0.0, 1e-6, 1e-3])
def test_the_roll_about_a_straight_path_comes_from_the_orientations(error_m):
    as_they_are, turned = median_angles(straight(), noisy(straight(), error_m))
    assert turned < 0.1
    assert error_m == 0.0 or as_they_are > 5.0


@pytest.mark.parametrize("error_m", [0.0, 1e-4])
def test_on_the_spot_all_of_the_turn_does(error_m):
    spot = np.array([planar_pose(1.0, 2.0, 0.1 * i) for i in range(40)])
    assert median_angles(spot, noisy(spot, error_m))[1] < 0.1


def test_a_path_that_bends_settles_the_turn():
    bend = np.array([planar_pose(np.sin(0.1 * i), 1 - np.cos(0.1 * i), 0.1 * i) for i in range(40)])
    est_T = noisy(bend, 1e-3)
    aligned = align(bend, est_T).apply(est_T)
    np.testing.assert_array_equal(free_turn(bend, aligned), np.eye(3))
    # Orientations that are wrong stay wrong.
    other_body = aligned.copy()
    other_body[:, :3, :3] = aligned[:, :3, :3] @ Rotation.from_euler("z", 90, degrees=True).as_matrix()
    np.testing.assert_array_equal(free_turn(bend, other_body), np.eye(3))


def test_large_errors_do_not_free_the_turn_of_a_path_that_bends():
    bend = np.array([planar_pose(np.sin(0.1 * i), 1 - np.cos(0.1 * i), 0.1 * i) for i in range(60)])
    est_T = noisy(bend, 0.1)
    np.testing.assert_array_equal(free_turn(bend, align(bend, est_T).apply(est_T)), np.eye(3))


def test_errors_across_the_path_stay_errors_after_a_turn_about_it():
    """Only the roll is free: a pitch of 8 degrees in all orientations remains."""
    pitched = straight()
    pitched[:, :3, :3] = Rotation.from_euler("y", 8, degrees=True).as_matrix() @ pitched[:, :3, :3]
    assert median_angles(straight(), noisy(pitched, 1e-4))[1] == pytest.approx(8.0, abs=0.3)


@pytest.mark.parametrize("n", [0, 1])
def test_too_few_poses_have_no_free_turn(n):
    np.testing.assert_array_equal(free_turn(straight()[:n], straight()[:n]), np.eye(3))
