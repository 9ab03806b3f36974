import numpy as np
import pytest
from evo.core.trajectory import PosePath3D
from hypothesis import given, settings
from hypothesis import strategies as st

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories import read_tum, sequence_attributes, step_sizes
from slamgym.geometry import inverse, mast_camera_pose, rotation_angle


def driven(poses):
    """Stamps and camera poses of a robot at (second, x, y, heading in degrees)."""
    stamps_ns = np.array([second * 1e9 for second, *_ in poses]).astype(np.int64)
    T = [mast_camera_pose(x, y, np.deg2rad(heading), 1.0) for _, x, y, heading in poses]
    return stamps_ns, np.array(T).reshape(-1, 4, 4)


def test_a_drive_straight_on_then_a_turn_on_the_spot():
    # Steps of 1, 1, 2 s: 1 m, 3 m, then 90 degrees on the spot. Velocities 1, 3, 0 m/s and 0, 0, 45 deg/s count for
    # 0.5, 1.5 and 3 s: they change by 2 and 3 m/s, and by 0 and 45 deg/s, over 1 and 1.5 s.
    got = sequence_attributes(*driven([(0, 0, 0, 0), (1, 1, 0, 0), (2, 4, 0, 0), (4, 4, 0, 90)]))
    assert (got.frames, got.duration_s, got.path_length_m) == pytest.approx((4, 4, 4))
    assert (got.velocity_m_per_frame, got.velocity_m_per_s) == pytest.approx((4 / 3, 1))
    assert (got.angular_velocity_deg_per_frame, got.angular_velocity_deg_per_s) == pytest.approx((30, 22.5))
    assert got.acceleration_m_per_s2 == pytest.approx(5 / 2.5)
    assert got.angular_acceleration_deg_per_s2 == pytest.approx(45 / 2.5)
    assert got.turning_on_spot_share == pytest.approx(2 / 4)


def test_a_circle_at_constant_speed():
    # 1 m/s on a circle of 2 m radius: v^2 / r = 0.5 m/s^2 towards its middle, 0.5 rad/s, nothing on the spot.
    angles = np.arange(0, 2 * np.pi, 0.005)
    poses = [(a * 2.0, 2 * np.cos(a), 2 * np.sin(a), np.rad2deg(a) + 90) for a in angles]
    got = sequence_attributes(*driven(poses))
    assert (got.velocity_m_per_s, got.acceleration_m_per_s2) == pytest.approx((1, 0.5), rel=1e-4)
    assert got.angular_velocity_deg_per_s == pytest.approx(np.rad2deg(0.5), rel=1e-6)
    assert got.angular_acceleration_deg_per_s2 == pytest.approx(0, abs=1e-4)
    assert got.turning_on_spot_share == 0


def test_a_slow_curve_and_a_slow_turn_are_no_turn_on_the_spot():
    # 0.1 m/s is too fast, 9 deg/s too slow, 0.04 m/s with 11 deg/s counts: 1 s of 3.
    got = sequence_attributes(*driven([(0, 0, 0, 0), (1, 0.1, 0, 30), (2, 0.1, 0, 39), (3, 0.14, 0, 50)]))
    assert got.turning_on_spot_share == pytest.approx(1 / 3)


@pytest.mark.parametrize("n", [0, 1])
def test_below_two_frames_nothing_moves(n):
    got = sequence_attributes(*driven([(7, 1, 2, 3)] * n))
    assert got[:3] == (n, 0, 0)
    assert np.isnan(got[3:]).all()


def test_two_frames_have_velocities_but_no_acceleration():
    got = sequence_attributes(*driven([(0, 0, 0, 0), (2, 0, 1, 0)]))
    assert (got.velocity_m_per_s, got.angular_velocity_deg_per_s, got.turning_on_spot_share) == pytest.approx(
        (0.5, 0, 0)
    )
    assert np.isnan([got.acceleration_m_per_s2, got.angular_acceleration_deg_per_s2]).all()


def test_standing_still():
    assert sequence_attributes(*driven([(i, 1, 1, 20) for i in range(5)]))[2:] == pytest.approx((0,) * 8)


def test_poses_that_do_not_fit_are_refused():
    stamps_ns, T = driven([(0, 0, 0, 0), (1, 0, 0, 0)])
    with pytest.raises(TrajectoryError, match="expected 2 poses"):
        sequence_attributes(stamps_ns, T[:1])
    with pytest.raises(TrajectoryError, match="increasing"):
        sequence_attributes(stamps_ns[::-1], T)


@settings(deadline=None)
@given(st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-180, 180)), max_size=12))
def test_steps_are_as_long_and_turn_as_far_as_the_relative_poses(poses):
    _, T = driven([(i, *pose) for i, pose in enumerate(poses)])
    length_m, angle_rad = step_sizes(T)
    assert length_m.shape == angle_rad.shape == (max(len(T) - 1, 0),)
    for i in range(len(T) - 1):
        step = inverse(T[i]) @ T[i + 1]
        assert length_m[i] == pytest.approx(np.linalg.norm(step[:3, 3]), abs=1e-9)
        assert angle_rad[i] == pytest.approx(float(rotation_angle(step)), abs=1e-7)


@pytest.mark.filterwarnings("ignore::slamgym.errors.TrajectoryWarning")
def test_a_real_hand_held_camera_whose_truth_is_noisy_at_its_full_rate(shared_data):
    truth = read_tum(shared_data / "trajectories" / "fr2_desk_groundtruth.txt", repair=True)
    got = sequence_attributes(truth.stamps_ns, truth.T)
    expected = PosePath3D(poses_se3=list(truth.T))
    assert (got.frames, got.path_length_m) == pytest.approx((expected.num_poses, expected.path_length))
    # 211 poses a second; every seventh is about the rate of the camera.
    thinned = sequence_attributes(truth.stamps_ns[::7], truth.T[::7])
    assert 0.9 < thinned.path_length_m / got.path_length_m < 1
    assert thinned.acceleration_m_per_s2 < got.acceleration_m_per_s2 / 10
