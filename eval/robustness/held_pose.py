"""The trajectory of a robot that goes on with the last pose its SLAM gave, and its error over all frames."""

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy import ErrorStats, absolute_errors, align, is_determined
from slamgym.types import BoolArray, FloatArray, IntArray


def hold_last_pose(est_T: FloatArray, tracked: BoolArray, first_T: FloatArray) -> FloatArray:
    """The estimate (N, 4, 4) with a pose at every frame: where there is none, the last one before is held.

    est_T: poses (N, 4, 4), of any value where not `tracked`, bool (N,). Before the first pose the robot is held where
    that is: the map begins there, so the error is how far the robot came before it. When nothing was ever tracked, it
    is held at `first_T` (4, 4), the truth's first pose: the robot that believes it never moved.
    Raises TrajectoryError for shapes that do not fit.
    """
    if tracked.dtype != np.bool_ or est_T.shape != (*tracked.shape, 4, 4):
        got = f"{tracked.dtype} {tracked.shape} and {est_T.shape}"
        raise TrajectoryError(f"held poses: expected `tracked` as bool (N,) and poses (N, 4, 4), got {got}")
    if not tracked.any():
        return np.tile(first_T, (len(est_T), 1, 1))
    return np.asarray(est_T[last_posed(tracked)])


def last_posed(posed: BoolArray) -> IntArray:
    """For each frame (N,) the last one up to it that has a pose, or the first that has one; 0 where none has."""
    frames = np.where(posed, np.arange(len(posed)), np.argmax(posed) if len(posed) else 0)
    return np.asarray(np.maximum.accumulate(frames))


def held_ate(ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray) -> ErrorStats:
    """Absolute trajectory error, metres, over all frames, of the estimate that holds its last pose.

    ref_T: true poses (N, 4, 4); est_T, tracked: see `hold_last_pose`. The estimate is aligned over the tracked frames
    alone, so that no held pose bends it: rigidly, or with fewer than three of them by the first. Never tracked, it is
    the truth's first pose and needs no alignment. NaN without frames. Raises TrajectoryError.
    """
    if ref_T.shape != est_T.shape:
        raise TrajectoryError(f"held poses: expected poses (N, 4, 4) in pairs, got {ref_T.shape} and {est_T.shape}")
    if not len(ref_T):
        return ErrorStats.of(np.empty(0))
    held_T = hold_last_pose(est_T, tracked, ref_T[0])
    if tracked.any():
        alignment = "se3" if is_determined(ref_T[tracked], est_T[tracked], "se3") else "first_pose"
        held_T = align(ref_T[tracked], est_T[tracked], alignment).apply(held_T)
    trans_m, _ = absolute_errors(ref_T, held_T)
    return ErrorStats.of(trans_m)
