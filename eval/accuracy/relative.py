"""Relative pose error.

Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012. All functions take poses (N, 4, 4) in
pairs: `ref_T` the truth, `est_T` the estimate at the same frame.
"""

from dataclasses import dataclass
from typing import NamedTuple, Self, cast

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy.error_stats import ErrorStats
from slamgym.eval.accuracy.pose_pairs import check_finite, check_shapes
from slamgym.geometry import quaternion_xyzw
from slamgym.types import BoolArray, FloatArray, IntArray


class RpeStats(NamedTuple):
    """Statistics of relative pose errors: of the translation in metres, of the rotation angle in degrees."""

    trans_m: ErrorStats
    rot_deg: ErrorStats


class RpeOverSteps(NamedTuple):
    """Relative pose error over many steps; NaN when there is no pair at all."""

    trans_rmse_m: float
    rot_mean_deg: float


def rpe(
    ref_T: FloatArray,
    est_T: FloatArray,
    delta: int = 1,
    tracked: BoolArray | None = None,
    map_ids: IntArray | None = None,
) -> RpeStats:
    """Relative pose error over all pairs `delta` frames apart with both ends tracked in one map.

    tracked: bool (N,), where `est_T` holds a pose; everywhere when left out. map_ids: int64 (N,), the map of each pose;
    one map when left out. Frames without a pose keep their place: `delta` counts them. Raises TrajectoryError.
    """
    if delta < 1:
        raise TrajectoryError(f"RPE: expected a step of at least 1 frame, got {delta}")
    pairs = _PosePairs.of(ref_T, est_T, tracked, map_ids)
    valid = pairs.valid(delta)
    trans_sq, rot = (errors[valid] for errors in pairs.errors(delta))
    return RpeStats(ErrorStats.of(np.sqrt(trans_sq)), ErrorStats.of(np.rad2deg(rot)))


def rpe_all_steps(
    ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None = None, map_ids: IntArray | None = None
) -> RpeOverSteps:
    """Mean over the steps d = 1..N-1 of `rpe`'s translation RMSE and rotation mean; steps without a pair are left out.

    All steps count the same, though long ones have few pairs; `rpe_pooled` weighs all pairs the same. O(N^2) time.
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
    """Translation RMSE and rotation mean over the pairs of all steps d = 1..N-1 taken together. O(N^2) time."""
    count, trans_sq, rot = (sums.sum() for sums in _sums_by_step(ref_T, est_T, tracked, map_ids))
    if not count:
        return RpeOverSteps(np.nan, np.nan)
    return RpeOverSteps(float(np.sqrt(trans_sq / count)), float(np.rad2deg(rot / count)))


def _sums_by_step(
    ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None, map_ids: IntArray | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Number of pairs, sum of squared translation errors and sum of rotation errors of every step, each (N - 1,)."""
    pairs = _PosePairs.of(ref_T, est_T, tracked, map_ids)
    sums = np.zeros((3, max(len(ref_T) - 1, 0)))
    for d in range(1, len(ref_T)):
        valid = pairs.valid(d).astype(np.float64)
        trans_sq, rot = pairs.errors(d)
        sums[:, d - 1] = valid.sum(), valid @ trans_sq, valid @ rot
    return sums[0], sums[1], sums[2]


@dataclass(frozen=True, slots=True, eq=False)
class _PosePairs:
    """What the relative errors need, frames along the last axis so that a step is a slice.

    With P the truth, Q the estimate and W = R_P R_Q^T, the relative pose error (P_i^-1 P_j)^-1 (Q_i^-1 Q_j) has a
    translation as long as W_i (q_j - q_i) - (p_j - p_i), and turns by the angle between W_i and W_j.
    """

    p: FloatArray
    q: FloatArray
    W: FloatArray
    w: FloatArray  # W as quaternions (4, N)
    map_ids: IntArray  # -1 where there is no pose

    @classmethod
    def of(cls, ref_T: FloatArray, est_T: FloatArray, tracked: BoolArray | None, map_ids: IntArray | None) -> Self:
        check_shapes(ref_T, est_T)
        tracked = np.ones(len(ref_T), dtype=np.bool_) if tracked is None else tracked
        map_ids = np.zeros(len(ref_T), dtype=np.int64) if map_ids is None else map_ids
        map_ids = np.where(tracked, map_ids, -1)
        est_T = np.where((map_ids >= 0)[:, None, None], est_T, np.eye(4))
        check_finite(ref_T, est_T)
        W = np.tile(np.eye(4), (len(ref_T), 1, 1))
        W[:, :3, :3] = ref_T[:, :3, :3] @ est_T[:, :3, :3].swapaxes(1, 2)
        return cls(
            p=np.ascontiguousarray(ref_T[:, :3, 3].T),
            q=np.ascontiguousarray(est_T[:, :3, 3].T),
            W=np.ascontiguousarray(np.moveaxis(W[:, :3, :3], 0, 2)),
            w=np.ascontiguousarray(quaternion_xyzw(W).T),
            map_ids=map_ids,
        )

    def valid(self, d: int) -> BoolArray:
        """Whether both ends of the pairs (i, i + d) are tracked in one map (N - d,)."""
        start = self.map_ids[:-d]
        return cast(BoolArray, (start >= 0) & (start == self.map_ids[d:]))

    def errors(self, d: int) -> tuple[FloatArray, FloatArray]:
        """Squared translation errors, m^2, and rotation errors, radians, of the pairs (i, i + d), each (N - d,)."""
        q_step = self.q[:, d:] - self.q[:, :-d]
        W = self.W[:, :, :-d]
        trans = W[:, 0] * q_step[0] + W[:, 1] * q_step[1] + W[:, 2] * q_step[2] - (self.p[:, d:] - self.p[:, :-d])
        w_i, w_j = self.w[:, :-d], self.w[:, d:]
        # By the chord, which unlike the arc cosine of the scalar product is exact for small angles; w and -w are one.
        chord_sq = np.minimum(_norm_sq(w_j - w_i), _norm_sq(w_j + w_i))
        return _norm_sq(trans), 4.0 * np.arcsin(0.5 * np.sqrt(chord_sq))


def _norm_sq(vectors: FloatArray) -> FloatArray:
    """Squared lengths (N,) of vectors (k, N)."""
    return cast(FloatArray, np.einsum("kn,kn->n", vectors, vectors))
