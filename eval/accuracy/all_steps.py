"""Relative pose error over all steps, where no single step is singled out.

Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012, equation 3. Both functions take poses
(N, 4, 4) in pairs, `ref_T` the truth, `est_T` the estimate, and `tracked` and `map_ids` as `rpe` does; they need O(N^2)
time and O(N) memory, and raise TrajectoryError.
"""

from typing import NamedTuple

import numpy as np

from slamgym.eval.accuracy.pair_errors import PairErrors
from slamgym.types import BoolArray, FloatArray, IntArray


class RpeOverSteps(NamedTuple):
    """Relative pose error over many steps; NaN when there is no pair at all."""

    trans_rmse_m: float
    rot_mean_deg: float


def rpe_all_steps(
    ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None = None, map_ids: IntArray | None = None
) -> RpeOverSteps:
    """Mean over the steps d = 1..N-1 of `rpe`'s translation RMSE and rotation mean; steps without a pair are left out.

    All steps count the same, though long ones have few pairs; `rpe_pooled` weighs all pairs the same.
    """
    count, trans_sq, rot = _sums_by_step(ref_T, est_T, tracked, map_ids)
    some = count > 0
    if not some.any():
        return RpeOverSteps(np.nan, np.nan)
    trans_rmse = np.sqrt(trans_sq[some] / count[some])
    return RpeOverSteps(float(trans_rmse.mean()), float(np.rad2deg(rot[some] / count[some]).mean()))


def rpe_pooled(
    ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None = None, map_ids: IntArray | None = None
) -> RpeOverSteps:
    """Translation RMSE and rotation mean over the pairs of all steps d = 1..N-1 taken together."""
    count, trans_sq, rot = (sums.sum() for sums in _sums_by_step(ref_T, est_T, tracked, map_ids))
    if not count:
        return RpeOverSteps(np.nan, np.nan)
    return RpeOverSteps(float(np.sqrt(trans_sq / count)), float(np.rad2deg(rot / count)))


def _sums_by_step(
    ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None, map_ids: IntArray | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Number of pairs, sum of squared translation errors and sum of rotation errors of every step, each (N - 1,)."""
    errors = PairErrors.of(ref_T, est_T, tracked, map_ids)
    sums = np.zeros((3, max(len(ref_T) - 1, 0)))
    for d in range(1, len(ref_T)):
        start, end = slice(None, -d), slice(d, None)
        valid = errors.valid(start, end).astype(np.float64)
        trans_sq, rot = errors.squared(start, end)
        sums[:, d - 1] = valid.sum(), valid @ trans_sq, valid @ rot
    return sums[0], sums[1], sums[2]
