"""Absolute trajectory error.

Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
"""

import numpy as np

from slamgym.eval.accuracy.alignment import align
from slamgym.eval.accuracy.error_stats import PoseErrorStats
from slamgym.eval.accuracy.pose_checks import check_poses
from slamgym.geometry import rotation_angle
from slamgym.types import FloatArray


def absolute_errors(ref_T: FloatArray, est_T: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distances, metres (N,), and angles, degrees (N,), between the poses (N, 4, 4) of truth and estimate as they are.

    Raises TrajectoryError.
    """
    check_poses(ref_T, est_T)
    return _distances_and_angles(ref_T, est_T)


def ate(ref_T: FloatArray, est_T: FloatArray, alignment: str = "se3") -> PoseErrorStats:
    """Statistics of the absolute errors after the estimate (N, 4, 4) is aligned to the truth (N, 4, 4); see `align`.

    All NaN for no pose at all with alignment "none". Raises what `align` raises.
    """
    similarity = align(ref_T, est_T, alignment)
    return PoseErrorStats.of(*_distances_and_angles(ref_T, similarity.apply(est_T)))


def _distances_and_angles(ref_T: FloatArray, est_T: FloatArray) -> tuple[FloatArray, FloatArray]:
    trans = np.linalg.norm(ref_T[:, :3, 3] - est_T[:, :3, 3], axis=1)
    relative = ref_T[:, :3, :3].swapaxes(1, 2) @ est_T[:, :3, :3]
    return trans, np.rad2deg(rotation_angle(relative))
