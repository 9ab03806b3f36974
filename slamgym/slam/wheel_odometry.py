"""Dead reckoning: what a robot has without a camera, the baseline that a visual SLAM has to beat.

The odometry motion model of Thrun, Burgard and Fox, "Probabilistic Robotics" (2005), section 5.4: a turn, a
translation, a turn, each with noise that grows with the motion. The model's variances grow with the squares of the
motion in a step, so that many small steps would be better than a few large ones; here they grow with the motion itself,
as those of a random walk, which makes the slip the same at all frame rates. Errors of the wheels' radius and distance,
the systematic part (Borenstein and Feng, "Measurement and correction of systematic odometry errors in mobile robots",
IEEE T-RA 1996), stay the same for a whole drive.
"""

import numpy as np
from pydantic import Field
from scipy.spatial.transform import RigidTransform, Rotation

from slamgym.geometry import inverse
from slamgym.slam.backend import SlamConfig, SlamOptions
from slamgym.slam.groundtruth import GroundTruth
from slamgym.types import FloatArray


class WheelOdometryOptions(SlamOptions):
    """Standard deviations of a small indoor robot's slip; all zero: the true motion."""

    distance_noise: float = Field(0.02, ge=0, description="random error of the distance, metres a square root of metre")
    drift_noise: float = Field(0.02, ge=0, description="random turn while driving, radians a square root of metre")
    turn_noise: float = Field(0.03, ge=0, description="random error of a turn, radians a square root of radian")
    radius_error: float = Field(0.01, ge=0, description="systematic error of the distance, as a share of it")
    track_error: float = Field(0.01, ge=0, description="systematic error of the turn, as a share of it")
    seed: int = Field(0, ge=0, description="another number gives the same drives other slips")


class WheelOdometry(GroundTruth):
    """Adds up the true motion between fed frames, with slip. It is never lost, and never finds back.

    It needs the true poses: a frame without one is not tracked. Turns are about the camera's vertical axis, optical y.
    The random numbers depend on `seed` and the first true pose: the same drive always slips the same way.
    """

    Options = WheelOdometryOptions

    def __init__(self, config: SlamConfig) -> None:
        super().__init__(config)
        self._options = WheelOdometryOptions.checked(config.options)
        self._slip: Slip | None = None
        self._T_world_last: FloatArray = np.eye(4)
        self._T_map_last: FloatArray = np.eye(4)

    def locate(self, T_world_cam: FloatArray) -> FloatArray:
        if self._slip is None:
            self._slip = Slip(self._options, T_world_cam)
        else:
            self._T_map_last = self._T_map_last @ self._slip.disturb(inverse(self._T_world_last) @ T_world_cam)
        self._T_world_last = T_world_cam
        return self._T_map_last


class Slip:
    """The slip of one drive, which begins at a true pose (4, 4)."""

    def __init__(self, options: WheelOdometryOptions, T_world_start: FloatArray) -> None:
        self._options = options
        # To the micrometre: the last bits of a pose may differ from machine to machine.
        start = np.rint(T_world_start * 1e6).astype(np.int64, order="C").view(np.uint32)
        self._rng = np.random.default_rng([options.seed, *start.ravel().tolist()])
        errors = np.array([options.radius_error, options.track_error])
        self._radius_error, self._track_error = errors * self._rng.standard_normal(2)

    def disturb(self, T_last_cam: FloatArray) -> FloatArray:
        """The motion (4, 4) from the last frame to the next one as the wheels tell it, half of the slip on each end."""
        options = self._options
        distance = float(np.linalg.norm(T_last_cam[:3, 3]))
        turn = float(Rotation.from_matrix(T_last_cam[:3, :3]).as_rotvec()[1])
        distance_sigma = options.distance_noise * np.sqrt(distance)
        turn_sigma = np.hypot(options.drift_noise * np.sqrt(distance), options.turn_noise * np.sqrt(abs(turn)))
        noise = self._rng.standard_normal(2) * [distance_sigma, turn_sigma]
        stretched = T_last_cam.copy()
        stretched[:3, 3] *= 1 + self._radius_error + (noise[0] / distance if distance > 0 else 0.0)
        half_turn = _turn(0.5 * (self._track_error * turn + noise[1]))
        return half_turn @ stretched @ half_turn


def _turn(angle: float) -> FloatArray:
    """A turn (4, 4) about the optical y axis, radians."""
    return RigidTransform.from_rotation(Rotation.from_rotvec([0.0, angle, 0.0])).as_matrix()
