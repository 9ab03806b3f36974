"""What a backend answers, made sure of: a wrong answer is told where it is given, not when a run is evaluated."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from slamgym.eval.trajectories.trajectory import are_rigid
from slamgym.slam.backend import untracked
from slamgym.types import FloatArray, IntArray, SlamEvent, SlamTrajectory, TrackingState, TrackResult

_EXACT = 1e-7
_SINGLE_PRECISION = 1e-3
"""How far a rotation may be off: what floats of 32 bits and some multiplications make of it. It is set right."""


def checked_result(answer: Any) -> TrackResult:
    """The answer to a frame, its values of the right types; raises TypeError or ValueError."""
    if not isinstance(answer, TrackResult):
        raise TypeError(f"expected the backend to answer with a TrackResult, got {answer!r}")
    state, event, points = TrackingState(answer.state), SlamEvent(answer.event), int(answer.tracked_points)
    if state is not TrackingState.OK:
        return untracked(state, event, points)
    if answer.map_id < 0:
        raise ValueError(f"expected the map of a tracked frame as a number of 0 or more, got {answer.map_id}")
    (T_map_cam,) = _rigid(np.asarray(answer.T_map_cam, dtype=np.float64)[None], 1)
    return TrackResult(state, T_map_cam, int(answer.map_id), points, event)


def checked_trajectory(answer: Any) -> SlamTrajectory:
    """The final trajectory, its arrays as `SlamTrajectory` promises them; raises TypeError or ValueError."""
    if not isinstance(answer, SlamTrajectory):
        raise TypeError(f"expected the backend to answer with a SlamTrajectory, got {answer!r}")
    stamps_ns, map_id = _integers("stamps", answer.stamps_ns), _integers("maps", answer.map_id)
    if len(map_id) != len(stamps_ns):
        raise ValueError(f"expected a map for each of {len(stamps_ns)} stamps, got {len(map_id)}")
    if (np.diff(stamps_ns) <= 0).any():
        raise ValueError("expected final poses with increasing stamps, got one that is not above the last")
    T_map_cam = np.asarray(answer.T_map_cam, dtype=np.float64)
    return SlamTrajectory(
        stamps_ns, _rigid(T_map_cam if len(stamps_ns) else np.empty((0, 4, 4)), len(stamps_ns)), map_id
    )


def checked_points(answer: Any) -> FloatArray:
    """Points of the map (N, 3), those that are not finite left out; raises ValueError."""
    points = np.asarray(answer, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"expected the points of the map as an array (N, 3), got shape {points.shape}")
    return points[np.isfinite(points).all(axis=1)]


def _integers(name: str, values: Any) -> IntArray:
    array = np.asarray(values)
    if array.ndim != 1 or (len(array) and not np.issubdtype(array.dtype, np.integer)):
        raise ValueError(f"expected the {name} of final poses as integers (N,), got {array.dtype} {array.shape}")
    return array.astype(np.int64)


def _rigid(T: FloatArray, count: int) -> FloatArray:
    """Poses (N, 4, 4) with rotations as exact as can be."""
    if T.shape != (count, 4, 4):
        raise ValueError(f"expected poses of shape ({count}, 4, 4), got {T.shape}")
    good = np.isfinite(T).all(axis=(1, 2)) & are_rigid(T, _SINGLE_PRECISION)
    if not good.all():
        raise ValueError(f"expected finite rigid transforms, got {T[np.argmin(good)].tolist()}")
    off = ~are_rigid(T, _EXACT)
    if off.any():
        T = T.copy()
        T[off, :3, :3] = Rotation.from_matrix(T[off, :3, :3]).as_matrix()
    return T
