"""Poses between those of a trajectory: for counting time and distance, never for errors, since they are guesses."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.types import FloatArray, IntArray

MOST_FILLED = 20
"""Times as many poses as the trajectory has; a hole that needs more comes from a wrong stamp."""


def interpolate(trajectory: Trajectory, stamps_ns: IntArray) -> FloatArray:
    """Poses (N, 4, 4) at stamps int64 (N,), positions on the line and rotations by Slerp; those of the first and last
    pose beyond these. Raises TrajectoryError for a trajectory without poses.
    """
    known_ns = trajectory.stamps_ns
    if not len(known_ns):
        raise TrajectoryError("interpolation: expected a trajectory with poses, got none")
    if len(known_ns) == 1:
        return np.tile(trajectory.T[0], (len(stamps_ns), 1, 1))
    # Seconds from the first stamp: floats would round nanoseconds of Unix time.
    known_s, wanted_s = (
        (stamps - known_ns[0]) * 1e-9 for stamps in (known_ns, np.clip(stamps_ns, known_ns[0], known_ns[-1]))
    )
    T = np.tile(np.eye(4), (len(stamps_ns), 1, 1))
    T[:, :3, :3] = Slerp(known_s, Rotation.from_matrix(trajectory.T[:, :3, :3]))(wanted_s).as_matrix()
    for axis in range(3):
        T[:, axis, 3] = np.interp(wanted_s, known_s, trajectory.positions[:, axis])
    return T


def find_holes(trajectory: Trajectory, max_gap_s: float) -> IntArray:
    """Rows of the poses that the next one follows after more than `max_gap_s`, and than three of the usual steps."""
    steps_ns = np.diff(trajectory.stamps_ns)
    usual_ns = np.median(steps_ns) if len(steps_ns) else 0.0
    return np.flatnonzero(steps_ns > max(max_gap_s * 1e9, 3 * usual_ns))


def _evenly(begin: int, end: int, steps: int) -> IntArray:
    """Stamps that part the time between two others into so many steps."""
    return np.asarray(begin + np.arange(1, steps) * (end - begin) // steps, dtype=np.int64)


def fill_holes(trajectory: Trajectory, max_gap_s: float) -> Trajectory:
    """The trajectory with interpolated poses in its holes (`find_holes`), about as far apart as its own are.

    Motion capture loses its markers: of TUM's fr2/desk for 19 of 99 s. Raises TrajectoryError for holes that are too
    long to be such.
    """
    holes = find_holes(trajectory, max_gap_s)
    if not len(holes):
        return trajectory
    stamps_ns = trajectory.stamps_ns
    usual_ns = int(np.median(np.diff(stamps_ns)))
    begins, ends = stamps_ns[holes], stamps_ns[holes + 1]
    if (ends - begins).sum() > MOST_FILLED * len(stamps_ns) * usual_ns:
        longest = int(np.argmax(ends - begins))
        raise TrajectoryError(
            f"the truth has no pose for {(ends - begins)[longest] * 1e-9:.0f} s after the stamp "
            f"{begins[longest] * 1e-9:.3f} s: is a stamp wrong, or are these two sessions? Cut it there"
        )
    inside = [
        _evenly(begin, end, max(round((end - begin) / usual_ns), 1)) for begin, end in zip(begins, ends, strict=True)
    ]
    filled_ns = np.union1d(stamps_ns, np.concatenate(inside))
    return Trajectory(filled_ns, interpolate(trajectory, filled_ns))
