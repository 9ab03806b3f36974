"""Dead reckoning: right without slip, and with slip spread as the formula says."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from slamgym.errors import ConfigError
from slamgym.geometry import inverse, mast_camera_pose
from slamgym.slam.backend import SlamConfig
from slamgym.slam.session import SlamSession
from slamgym.slam.wheel_odometry import WheelOdometry, WheelOdometryOptions
from slamgym.types import Frame, SlamEvent, TrackingState

EXACT = dict.fromkeys(("distance_noise", "drift_noise", "turn_noise", "radius_error", "track_error"), 0.0)
NO_IMAGE = (np.zeros((24, 32, 3), np.uint8), np.zeros((24, 32), np.float32))


def frames(poses):
    return [Frame(k, *NO_IMAGE, T) for k, T in enumerate(poses)]


def straight(steps, start_y=0.0, length=10.0):
    """True poses of a drive along x."""
    return [mast_camera_pose(x, start_y, 0.0, 0.8) for x in np.linspace(0.0, length, steps + 1)]


def turning(steps, start_y=0.0):
    """True poses of a whole turn on the spot, to the left."""
    return [mast_camera_pose(0.0, start_y, yaw, 0.8) for yaw in np.linspace(0.0, 2 * np.pi, steps + 1)]


def last_poses(config, drive, steps, drives=150, **options):
    """Last pose of many drives (N, 4, 4), each from its own place, in the camera's first frame."""
    found = []
    for k in range(drives):
        backend = WheelOdometry(SlamConfig(config.camera, 30.0, options={**EXACT, **options}))
        found.append([backend.track(frame) for frame in frames(drive(steps, float(k)))][-1].T_map_cam)
    return np.array(found)


def turn_rad(T):
    return Rotation.from_matrix(T[..., :3, :3]).as_rotvec()[..., 1]


def wandering(count=30, seed=3):
    """Poses of a hand-held camera, in all six degrees of freedom."""
    rng = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (count, 1, 1))
    poses[:, :3, :3] = Rotation.from_rotvec(0.1 * rng.standard_normal((count, 3)).cumsum(axis=0)).as_matrix()
    poses[:, :3, 3] = 0.05 * rng.standard_normal((count, 3)).cumsum(axis=0)
    return poses


def test_without_slip_it_is_the_truth(config):
    poses = wandering()
    with SlamSession("wheel_odometry", SlamConfig(config.camera, 30.0, options=EXACT)) as session:
        online = [session.track(frame) for frame in frames(poses)]
        final = session.finish()
    assert [r.event for r in online] == [SlamEvent.INITIALIZED] + [SlamEvent.NONE] * 29
    np.testing.assert_array_equal(online[0].T_map_cam, np.eye(4))
    np.testing.assert_allclose([r.T_map_cam for r in online], inverse(poses[0]) @ poses, atol=1e-12)
    np.testing.assert_array_equal(final.T_map_cam, [r.T_map_cam for r in online])


def test_same_drive_same_slip_and_others_differ(config):
    def last(poses, **options):
        backend = WheelOdometry(SlamConfig(config.camera, 30.0, options=options))
        return [backend.track(frame) for frame in frames(poses)][-1].T_map_cam

    with SlamSession("wheel_odometry", config) as session:
        first = [session.track(frame) for frame in frames(straight(5))][-1].T_map_cam
    np.testing.assert_array_equal(first, last(straight(5)))
    assert np.abs(first - last(straight(5, start_y=1.0))).max() > 1e-3
    assert np.abs(first - last(straight(5), seed=1)).max() > 1e-3
    assert np.abs(first - inverse(straight(5)[0]) @ straight(5)[-1]).max() > 1e-3


# The spread of 150 samples is within 23 % of the true one (four standard deviations). Variances that grew with the
# squares of the motions would give half of it for four times the frames.
@pytest.mark.parametrize("steps", [3, 12])
def test_distance_noise_over_ten_metres(config, steps):
    z = last_poses(config, straight, steps, distance_noise=0.05)[:, 2, 3]
    assert z.std() == pytest.approx(0.05 * np.sqrt(10.0), rel=0.23)
    assert z.mean() == pytest.approx(10.0, abs=4 * 0.158 / np.sqrt(150))


@pytest.mark.parametrize("steps", [3, 12])
def test_drift_over_ten_metres(config, steps):
    T = last_poses(config, straight, steps, drift_noise=0.02)
    assert turn_rad(T).std() == pytest.approx(0.02 * np.sqrt(10.0), rel=0.23)
    # The heading is a random walk, so its integral has the variance sigma^2 L^3 / 3.
    assert T[:, 0, 3].std() == pytest.approx(0.02 * np.sqrt(10.0**3 / 3), rel=0.23)


@pytest.mark.parametrize("steps", [3, 12])
def test_turn_noise_over_a_whole_turn(config, steps):
    T = last_poses(config, turning, steps, turn_noise=0.03)
    assert turn_rad(T).std() == pytest.approx(0.03 * np.sqrt(2 * np.pi), rel=0.23)
    np.testing.assert_allclose(T[:, :3, 3], 0.0, atol=1e-12)


@pytest.mark.parametrize("steps", [3, 12])
def test_systematic_errors_stay_the_same_for_a_drive(config, steps):
    z = last_poses(config, straight, steps, radius_error=0.01)[:, 2, 3]
    assert z.std() == pytest.approx(0.1, rel=0.23)
    turn = turn_rad(last_poses(config, turning, steps, track_error=0.01))
    assert turn.std() == pytest.approx(0.01 * 2 * np.pi, rel=0.23)


def test_slip_turns_about_the_vertical_axis_only(config):
    T = last_poses(config, straight, 10, drives=20, drift_noise=0.1, distance_noise=0.1)
    np.testing.assert_allclose(T[:, 1], np.tile([0.0, 1.0, 0.0, 0.0], (20, 1)), atol=1e-12)
    assert np.abs(turn_rad(T)).min() > 1e-4


def test_frames_without_truth_are_not_tracked_and_the_next_one_is(config):
    poses = [*straight(4)]
    poses[2] = np.full((4, 4), np.nan)
    backend = WheelOdometry(SlamConfig(config.camera, 30.0, options=EXACT))
    online = [backend.track(frame) for frame in frames(poses)]
    assert [r.state is TrackingState.OK for r in online] == [True, True, False, True, True]
    assert [r.event for r in online[2:4]] == [SlamEvent.LOST, SlamEvent.RELOCALIZED]
    assert online[4].T_map_cam[2, 3] == pytest.approx(10.0)


def test_negative_noise_is_refused():
    with pytest.raises(ConfigError, match=r"^slam option 'drift_noise': .*greater than or equal to 0.*got -1"):
        WheelOdometryOptions.checked({"drift_noise": -1})
