"""The rigid transform between two sets of points that belong together."""

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import FloatArray


def align_rigid(source: FloatArray, target: FloatArray) -> FloatArray:
    """T_target_source (4, 4) that takes the points `source` (N, 3) closest to `target` (N, 3), in least squares.

    Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991, without
    scale. Points on one line leave the turn about it open; one of the best transforms is returned then.
    Raises TrajectoryError for fewer than 3 points, shapes that differ, or values that are not finite.
    """
    if source.shape != target.shape or source.ndim != 2 or source.shape[1] != 3:
        raise TrajectoryError(f"alignment: expected two arrays (N, 3), got {source.shape} and {target.shape}")
    if len(source) < 3:
        raise TrajectoryError(f"alignment: expected at least 3 pairs of points, got {len(source)}")
    if not (np.isfinite(source).all() and np.isfinite(target).all()):
        raise TrajectoryError("alignment: expected finite points, got NaN or infinity: leave those pairs out")
    mean_source, mean_target = source.mean(axis=0), target.mean(axis=0)
    U, _, Vt = np.linalg.svd((target - mean_target).T @ (source - mean_source))
    # Without the sign the best orthogonal matrix may be a mirror image.
    mirror = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    T_target_source = np.eye(4)
    T_target_source[:3, :3] = U @ mirror @ Vt
    T_target_source[:3, 3] = mean_target - T_target_source[:3, :3] @ mean_source
    return T_target_source
