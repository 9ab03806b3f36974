from dataclasses import asdict

import numpy as np
import pytest

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import ALIGNMENTS, PoseErrorStats, absolute_errors, align, ate
from slamgym.geometry import planar_pose


def test_absolute_errors_by_hand():
    ref_T = np.array([planar_pose(0.0, 0.0, 0.0), planar_pose(1.0, 1.0, 3.0), planar_pose(0.0, 0.0, 0.0)])
    est_T = np.array([planar_pose(0.0, 0.0, 0.0), planar_pose(4.0, 5.0, 3.0), planar_pose(0.0, 0.0, 3.5)])
    trans_m, rot_deg = absolute_errors(ref_T, est_T)
    # 3-4-5 triangle; 3.5 radians to the left are 2 pi - 3.5 to the right.
    np.testing.assert_allclose(trans_m, [0.0, 5.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(rot_deg, [0.0, 0.0, np.degrees(2 * np.pi - 3.5)], atol=1e-12)


def test_ate_by_hand(straight):
    ref_T, est_T = straight([0.0, 1.0, 2.0]), straight([1.0, 2.0, 0.0], [0.0, 30.0, -90.0])
    stats = ate(ref_T, est_T, "none")
    # 1, 1 and 2 m off: the mean square is 6 / 3.
    assert stats.trans_m.rmse == pytest.approx(2.0**0.5)
    assert stats.trans_m.median == pytest.approx(1.0)
    assert stats.rot_deg.mean == pytest.approx(40.0)
    assert stats.rot_deg.max == pytest.approx(90.0)


def test_first_pose_puts_the_whole_error_at_the_end(straight):
    # Drift of 0.1 m a frame: 0, 0.1, 0.2 from the first pose on, but -0.1, 0, 0.1 in least squares.
    ref_T, est_T = straight([0.0, 1.0, 2.0]), straight([5.0, 6.1, 7.2])
    assert ate(ref_T, est_T, "first_pose").trans_m.max == pytest.approx(0.2)
    assert ate(ref_T, est_T, "se3").trans_m.max == pytest.approx(0.1)
    assert ate(ref_T, est_T, "sim3").trans_m.max == pytest.approx(0.0, abs=1e-12)
    assert ate(ref_T, est_T, "none").trans_m.max == pytest.approx(5.2)


@pytest.mark.parametrize("alignment", ALIGNMENTS)
def test_ate_is_that_of_the_aligned_poses(alignment, random_pair):
    ref_T, est_T = random_pair(3, 20)
    moved = align(ref_T, est_T, alignment).apply(est_T)
    assert ate(ref_T, est_T, alignment) == PoseErrorStats.of(*absolute_errors(ref_T, moved))


@pytest.mark.parametrize("alignment", ALIGNMENTS)
def test_a_perfect_estimate_has_no_error(alignment, random_pair):
    ref_T, _ = random_pair(3, 20)
    stats = ate(ref_T, ref_T, alignment)
    assert [*asdict(stats.trans_m).values(), *asdict(stats.rot_deg).values()] == pytest.approx([0.0] * 12, abs=1e-12)


def test_nothing_is_tracked():
    nothing = np.empty((0, 4, 4))
    assert np.isnan(ate(nothing, nothing, "none").trans_m.rmse)
    assert [len(errors) for errors in absolute_errors(nothing, nothing)] == [0, 0]


def test_the_alignment_is_told_what_is_missing(random_pair):
    ref_T, est_T = random_pair(0, 5)
    with pytest.raises(TrajectoryError, match="at least 3 poses, got 2: use 'first_pose'"):
        ate(ref_T[:2], est_T[:2])
    with pytest.raises(TrajectoryError, match="finite"):
        absolute_errors(ref_T, est_T * np.nan)
