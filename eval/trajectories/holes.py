"""Times for which a trajectory has no pose."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.types import FloatArray, IntArray


def fill_holes(trajectory: Trajectory, max_gap_s: float) -> Trajectory:
    """The trajectory with poses put into its holes of more than `max_gap_s`, as far apart as its poses at the median.

    For counting time and distance only: positions are interpolated on the line, rotations by Slerp, which is not where
    the camera was. Motion capture loses its markers, of TUM's fr2/desk for 19 of 99 s.
    """
    stamps_ns = trajectory.stamps_ns
    steps_ns = np.diff(stamps_ns)
    (before,) = np.nonzero(steps_ns > max_gap_s * 1e9)
    if not len(before):
        return trajectory
    period_ns = int(np.median(steps_ns))
    inside = [np.arange(stamps_ns[i] + period_ns, stamps_ns[i + 1], period_ns) for i in before]
    filled_ns = np.union1d(stamps_ns, np.concatenate(inside))
    return Trajectory(filled_ns, _interpolated(trajectory, filled_ns))


def _interpolated(trajectory: Trajectory, stamps_ns: IntArray) -> FloatArray:
    # Seconds from the first stamp: floats would round nanoseconds of Unix time.
    known_s, wanted_s = ((stamps - trajectory.stamps_ns[0]) * 1e-9 for stamps in (trajectory.stamps_ns, stamps_ns))
    T = np.tile(np.eye(4), (len(stamps_ns), 1, 1))
    T[:, :3, :3] = Slerp(known_s, Rotation.from_matrix(trajectory.T[:, :3, :3]))(wanted_s).as_matrix()
    for axis in range(3):
        T[:, axis, 3] = np.interp(wanted_s, known_s, trajectory.positions[:, axis])
    return T
