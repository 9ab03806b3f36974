"""Absolute trajectory error.

Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
"""

import numpy as np

from slamgym.errors import TrajectoryError, unknown_word
from slamgym.eval.accuracy.alignment import align_rigid
from slamgym.eval.accuracy.error_stats import ErrorStats
from slamgym.eval.accuracy.pose_pairs import check_finite, check_shapes
from slamgym.types import FloatArray

ALIGNMENTS = ("rigid", "none")


def ate(ref_T: FloatArray, est_T: FloatArray, alignment: str = "rigid") -> ErrorStats:
    """Absolute trajectory error: distances, metres, between positions after the estimate is aligned to the truth.

    alignment: "rigid" (needs 3 poses) or "none". Raises TrajectoryError.
    """
    if alignment not in ALIGNMENTS:
        raise TrajectoryError(unknown_word("alignment", alignment, ALIGNMENTS))
    check_shapes(ref_T, est_T)
    check_finite(ref_T, est_T)
    ref, est = ref_T[:, :3, 3], est_T[:, :3, 3]
    if alignment == "rigid":
        T_ref_est = align_rigid(est, ref)
        est = est @ T_ref_est[:3, :3].T + T_ref_est[:3, 3]
    return ErrorStats.of(np.linalg.norm(ref - est, axis=1))
