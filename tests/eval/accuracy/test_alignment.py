import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.accuracy import ALIGNMENTS, align
from slamgym.geometry import from_quaternion, planar_pose

# A path with a corner, so that no other transform takes it onto itself.
CORNER = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]]


def at(positions):
    """Poses without rotation at these positions."""
    return from_quaternion(positions, np.tile([0.0, 0.0, 0.0, 1.0], (len(positions), 1)))


def squared_distances(ref_T, est_T):
    return np.sum((ref_T[:, :3, 3] - est_T[:, :3, 3]) ** 2)


def test_rigid_alignment_by_hand():
    # The estimate is the path turned by -90 degrees, (x, y) -> (y, -x), and moved by (5, 0, 1).
    est_T = at([[5.0, 0.0, 1.0], [5.0, -1.0, 1.0], [5.0, -2.0, 1.0], [6.0, -2.0, 1.0]])
    similarity = align(at(CORNER), est_T, "se3")
    # Back: (x, y) -> (-y, x) takes the start (5, 0) to (0, 5), so 5 is left to subtract from y, and 1 from z.
    expected = [[0, -1, 0, 0], [1, 0, 0, -5], [0, 0, 1, -1], [0, 0, 0, 1]]
    np.testing.assert_allclose(similarity.T, expected, atol=1e-12)
    assert similarity.scale == 1.0


def test_similarity_by_hand():
    similarity = align(at(CORNER), at([[0.5 * x, 0.5 * y, 7.0] for x, y, _ in CORNER]), "sim3")
    assert similarity.scale == pytest.approx(2.0)
    # The height of 7 is doubled before it is taken back.
    np.testing.assert_allclose(similarity.T, at([[0.0, 0.0, -14.0]])[0], atol=1e-12)


def test_first_pose_by_hand():
    ref_T = np.array([planar_pose(1.0, 2.0, np.pi / 2), planar_pose(1.0, 3.0, 0.0)])
    est_T = np.array([planar_pose(0.0, 0.0, 0.0), planar_pose(3.0, 0.0, 0.0)])
    moved = align(ref_T, est_T, "first_pose").apply(est_T)
    # The first pose now looks along y, so that 3 m ahead of it are 3 m along y.
    np.testing.assert_allclose(moved, [ref_T[0], planar_pose(1.0, 5.0, np.pi / 2)], atol=1e-12)


def test_one_pose_is_enough_for_the_first_pose():
    ref_T, est_T = planar_pose(1.0, 2.0, 0.3)[None], planar_pose(4.0, 0.0, -2.0)[None]
    np.testing.assert_allclose(align(ref_T, est_T, "first_pose").apply(est_T), ref_T, atol=1e-12)


def test_none_changes_nothing(random_pair):
    ref_T, est_T = random_pair(0, 5)
    np.testing.assert_array_equal(align(ref_T, est_T, "none").apply(est_T), est_T)


@pytest.mark.parametrize("alignment", ["se3", "sim3"])
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(3, 25), noise=st.sampled_from([1e-6, 0.1, 3.0]))
@settings(deadline=None, max_examples=30)
def test_no_transform_nearby_is_better(random_pair, alignment, seed, n, noise):
    ref_T, est_T = random_pair(seed, n, noise)
    best = align(ref_T, est_T, alignment)
    moved = best.apply(est_T)
    least = squared_distances(ref_T, moved)
    rng = np.random.default_rng(seed)
    for size in (1e-3, 0.1):
        nudge = from_quaternion(size * rng.normal(size=(1, 3)), [[*(size * rng.normal(size=3)), 1.0]])[0]
        other = nudge @ moved
        if alignment == "sim3":
            other[:, :3, 3] *= 1.0 + size * rng.normal()
        assert squared_distances(ref_T, other) >= least


@given(seed=st.integers(0, 2**32 - 1), scale=st.floats(0.01, 100.0))
@settings(deadline=None, max_examples=30)
def test_a_similarity_is_found_again(random_pair, seed, scale):
    ref_T, est_T = random_pair(seed, 10, 0.0)
    est_T[:, :3, 3] *= scale
    similarity = align(ref_T, est_T, "sim3")
    assert similarity.scale == pytest.approx(1.0 / scale)
    np.testing.assert_allclose(similarity.apply(est_T), ref_T, atol=1e-9)


@pytest.mark.parametrize("direction", [[1.0, 0.0, 0.0], [0.3, -0.5, 0.8], [0.0, 0.0, 0.0]])
def test_positions_on_a_line_or_in_one_place(direction):
    ref_T = at(np.linspace(0.0, 5.0, 6)[:, None] * np.array(direction))
    est_T = planar_pose(1.0, 2.0, 2.0, 3.0) @ ref_T
    similarity = align(ref_T, est_T)
    np.testing.assert_allclose(similarity.apply(est_T)[:, :3, 3], ref_T[:, :3, 3], atol=1e-12)
    assert np.linalg.det(similarity.T[:3, :3]) == pytest.approx(1.0)


def test_alignment_never_mirrors():
    positions = np.random.default_rng(0).normal(size=(10, 3))
    T = align(at(positions), at(positions * [1.0, 1.0, -1.0])).T
    assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


def test_no_scale_is_corrected_unasked():
    positions = np.random.default_rng(0).normal(size=(10, 3))
    similarity = align(at(positions), at(2.0 * positions))
    assert similarity.scale == 1.0
    # All rotations are the identity, and stay it: nothing of the scale goes into them.
    np.testing.assert_allclose(similarity.T[:3, :3], np.eye(3), atol=1e-12)


def test_a_scale_leaves_rotations_alone(random_pair):
    ref_T, est_T = random_pair(0, 10)
    est_T[:, :3, 3] *= 3.0
    moved = align(ref_T, est_T, "sim3").apply(est_T)
    np.testing.assert_allclose(np.linalg.det(moved[:, :3, :3]), 1.0)
    np.testing.assert_array_equal(moved[:, 3], est_T[:, 3])


@pytest.mark.parametrize("far", [0.0, 1e4])
def test_a_scale_needs_positions_that_move(far):
    still = at(np.tile([far, 0.1, 0.3], (4, 1)))
    still[1, :3, 3] *= 1.0 + 4e-16  # rounding is no motion
    with pytest.raises(TrajectoryError, match="all of the estimate in one place"):
        align(at(CORNER), still, "sim3")
    with pytest.raises(TrajectoryError, match="all of the truth in one place"):
        align(still, at(CORNER), "sim3")


@pytest.mark.parametrize("n", [0, 1, 2])
@pytest.mark.parametrize("alignment", ["se3", "sim3"])
def test_too_few_poses(alignment, n):
    with pytest.raises(TrajectoryError, match=f"at least 3 poses, got {n}"):
        align(at(CORNER)[:n], at(CORNER)[:n], alignment)


def test_first_pose_of_none():
    with pytest.raises(TrajectoryError, match="at least 1 pose, got none"):
        align(np.empty((0, 4, 4)), np.empty((0, 4, 4)), "first_pose")


@pytest.mark.parametrize("alignment", ALIGNMENTS)
def test_poses_that_are_none(alignment):
    ref_T = at(CORNER)
    with pytest.raises(TrajectoryError, match="estimate: expected finite poses, got NaN or infinity in pose 2"):
        align(ref_T, np.where(np.arange(4)[:, None, None] == 2, np.nan, ref_T), alignment)
    with pytest.raises(TrajectoryError, match=r"got shapes \(4, 4, 4\) and \(3, 4, 4\)"):
        align(ref_T, ref_T[:3], alignment)
    for wrong in (np.diag([2.0, 2.0, 2.0, 1.0]), np.diag([1.0, 1.0, -1.0, 1.0]), np.diag([1.0, 1.0, 1.0, 0.0])):
        with pytest.raises(TrajectoryError, match=r"truth: expected rigid poses, .*, got another matrix in pose 0"):
            align(ref_T @ wrong, ref_T, alignment)


def test_poses_of_few_digits_are_accepted():
    T = planar_pose(1.0, 2.0, 0.7)[None]
    assert align(T.round(5), T.astype(np.float32), "first_pose").scale == 1.0


def test_an_unknown_alignment():
    with pytest.raises(ConfigError, match="did you mean 'sim3'"):
        align(at(CORNER), at(CORNER), "sim")


def test_a_turned_frame_is_taken_back():
    turn = Rotation.from_euler("xyz", [0.4, -1.0, 2.0]).as_quat()
    T_world_map = from_quaternion([[1.0, 2.0, 3.0]], [turn])[0]
    ref_T = T_world_map @ at(CORNER)
    np.testing.assert_allclose(align(ref_T, at(CORNER)).T, T_world_map, atol=1e-12)
