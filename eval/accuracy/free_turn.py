"""The turn that positions leave open: about the line of a straight drive, any on the spot."""

import numpy as np
from scipy.spatial.transform import Rotation

from slamgym.types import FloatArray

STRAIGHT = 0.1
"""A path is straight when it extends across its main direction at most this share of its length..."""
SETTLED = 10.0
"""...and this many times the error of the positions, which would settle the turn about it to 6 degrees."""
ON_THE_SPOT = 3.0
"""A path stays on the spot when it extends at most this many times the error of the positions."""


def free_turn(ref_T: FloatArray, est_T: FloatArray) -> FloatArray:
    """Rotation (3, 3) that takes the orientations of the aligned estimate (N, 4, 4) closest to the true ones (N, 4, 4)
    about the axes that the positions leave open; the identity where they settle all of it.

    An alignment of positions turns the estimate about a straight path in whatever way fits their noise, which may be
    many degrees. Compare orientations after this turn.
    """
    if len(ref_T) < 2:
        return np.eye(3)
    ref, est = ref_T[:, :3, 3], est_T[:, :3, 3]
    error_m = np.sqrt(np.mean(np.sum((ref - est) ** 2, axis=1)))
    _, extents, axes = np.linalg.svd(ref - ref.mean(axis=0), full_matrices=False)
    extents_m = np.pad(extents, (0, 3 - len(extents))) / np.sqrt(len(ref))
    error_m = max(error_m, 1e-9 * extents_m[0])
    R_ref, R_est = ref_T[:, :3, :3], est_T[:, :3, :3]
    if extents_m[0] <= ON_THE_SPOT * error_m:
        return Rotation.from_matrix(R_ref @ R_est.swapaxes(1, 2)).mean().as_matrix()
    if extents_m[1] <= min(STRAIGHT * extents_m[0], SETTLED * error_m):
        return _turn_about(axes[0], np.einsum("nij,nkj->ik", R_est, R_ref))
    return np.eye(3)


def _turn_about(axis: FloatArray, M: FloatArray) -> FloatArray:
    """The rotation R about a unit vector (3,) that makes trace(R M) largest, by Rodrigues' formula."""
    cross = np.cross(np.eye(3), axis)
    angle = np.arctan2(-np.sum(cross * M), np.trace(M) - axis @ M @ axis)
    return Rotation.from_rotvec(angle * axis).as_matrix()
