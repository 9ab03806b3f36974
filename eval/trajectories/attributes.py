"""How a sequence moves: what makes it hard for a SLAM, told from the true poses alone.

Prokhorov et al., "Measuring robustness of Visual SLAM", MVA 2019, tabulates the mean velocities per frame and second.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.types import FloatArray, IntArray

SPOT_TURN_DEG_PER_S = 10.0
"""A camera turns on the spot when it turns faster than this..."""
SPOT_SPEED_M_PER_S = 0.05
"""...while it moves slower than this."""


class SequenceAttributes(NamedTuple):
    """Motion of one sequence; see `sequence_attributes`."""

    frames: int
    duration_s: float
    path_length_m: float
    velocity_m_per_frame: float
    velocity_m_per_s: float
    angular_velocity_deg_per_frame: float
    angular_velocity_deg_per_s: float
    acceleration_m_per_s2: float
    angular_acceleration_deg_per_s2: float
    turning_on_spot_share: float


def sequence_attributes(stamps_ns: IntArray, T_world_cam: FloatArray) -> SequenceAttributes:
    """Motion of the true poses (N, 4, 4) at the stamps int64 (N,), nanoseconds.

    - `velocity_*`, `angular_velocity_*`: length of the path, and the angles turned, divided by the number of steps from
      frame to frame, and by the duration.
    - `acceleration_*`: the velocity of a step, as a vector in the world, counts for the middle of the step; the mean
      over time of |difference of two consecutive velocities| / time between the two middles. `angular_acceleration_*`:
      the same of the rotation vectors in the world.
    - `turning_on_spot_share`: share of the time in steps that turn faster than SPOT_TURN_DEG_PER_S and move slower
      than SPOT_SPEED_M_PER_S.

    Noise of the truth adds to all of them, the more the higher its rate: give poses at the rate of the camera, and
    compare sequences at one rate only. (TUM's fr2/desk turns 24 deg/s in its truth of 211 Hz, 11 deg/s at 30 Hz.)
    Below two frames duration and length are 0 and the means NaN, below three frames the accelerations.
    Raises TrajectoryError for shapes that do not fit, values that are not finite and stamps that do not increase.
    """
    Trajectory(stamps_ns, T_world_cam)
    moves, turns = _step_vectors(T_world_cam)
    turns = np.rad2deg(turns)
    step_s = np.diff(stamps_ns) * 1e-9
    duration_s, length_m, angle_deg = float(step_s.sum()), _length(moves).sum(), _length(turns).sum()
    velocity, turn_rate = moves / step_s[:, None], turns / step_s[:, None]
    on_spot = (_length(turn_rate) > SPOT_TURN_DEG_PER_S) & (_length(velocity) < SPOT_SPEED_M_PER_S)
    return SequenceAttributes(
        frames=len(stamps_ns),
        duration_s=duration_s,
        path_length_m=float(length_m),
        velocity_m_per_frame=_ratio(length_m, len(step_s)),
        velocity_m_per_s=_ratio(length_m, duration_s),
        angular_velocity_deg_per_frame=_ratio(angle_deg, len(step_s)),
        angular_velocity_deg_per_s=_ratio(angle_deg, duration_s),
        acceleration_m_per_s2=_mean_change_rate(velocity, step_s),
        angular_acceleration_deg_per_s2=_mean_change_rate(turn_rate, step_s),
        turning_on_spot_share=_ratio(step_s[on_spot].sum(), duration_s),
    )


def step_sizes(T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lengths in metres and angles in radians, each (max(N - 1, 0),), of the steps from pose to pose (N, 4, 4)."""
    moves, turns = _step_vectors(T)
    return _length(moves), _length(turns)


def _step_vectors(T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Translations, metres, and rotation vectors, radians, from pose to pose in the world, (N - 1, 3) each."""
    if len(T) < 2:
        return np.empty((0, 3)), np.empty((0, 3))
    R = T[:, :3, :3]
    return np.diff(T[:, :3, 3], axis=0), Rotation.from_matrix(R[1:] @ R[:-1].swapaxes(1, 2)).as_rotvec()


def _mean_change_rate(velocity: FloatArray, step_s: FloatArray) -> float:
    between_middles_s = (step_s[:-1] + step_s[1:]) / 2
    return _ratio(_length(np.diff(velocity, axis=0)).sum(), between_middles_s.sum())


def _length(vectors: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(vectors, axis=1))


def _ratio(part: float, whole: float) -> float:
    return float(part / whole) if whole > 0 else np.nan
