"""Relative errors of pairs of frames."""

from dataclasses import dataclass
from typing import Self, cast

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.accuracy.pose_checks import check_poses, check_shapes
from slamgym.geometry import quaternion_xyzw
from slamgym.types import BoolArray, FloatArray, IntArray

Frames = IntArray | slice


@dataclass(frozen=True, slots=True, eq=False)
class PairErrors:
    """What the relative errors need, frames along the last axis, so that a step over all frames is two slices.

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
        """See `rpe` for the arguments. Raises TrajectoryError."""
        check_shapes(ref_T, est_T)
        map_ids = _map_of_each(len(ref_T), tracked, map_ids)
        est_T = np.where((map_ids >= 0)[:, None, None], est_T, np.eye(4))
        check_poses(ref_T, est_T)
        W = ref_T[:, :3, :3] @ est_T[:, :3, :3].swapaxes(1, 2)
        return cls(
            p=np.ascontiguousarray(ref_T[:, :3, 3].T),
            q=np.ascontiguousarray(est_T[:, :3, 3].T),
            W=np.ascontiguousarray(np.moveaxis(W, 0, 2)),
            w=np.ascontiguousarray(quaternion_xyzw(W).T),
            map_ids=map_ids,
        )

    def valid(self, start: Frames, end: Frames) -> BoolArray:
        """Whether both ends of the pairs are tracked in one map (K,)."""
        return cast(BoolArray, (self.map_ids[start] >= 0) & (self.map_ids[start] == self.map_ids[end]))

    def squared(self, start: Frames, end: Frames) -> tuple[FloatArray, FloatArray]:
        """Squared translation errors, m^2 (K,), and rotation errors, radians (K,), of the pairs."""
        q_step, W = self.q[:, end] - self.q[:, start], self.W[:, :, start]
        trans = W[:, 0] * q_step[0] + W[:, 1] * q_step[1] + W[:, 2] * q_step[2]
        trans -= self.p[:, end] - self.p[:, start]
        w_i, w_j = self.w[:, start], self.w[:, end]
        # By the chord, which unlike the arc cosine of the scalar product is exact for small angles; w and -w are one.
        chord_sq = np.minimum(_norm_sq(w_j - w_i), _norm_sq(w_j + w_i))
        return _norm_sq(trans), 4.0 * np.arcsin(0.5 * np.sqrt(chord_sq))

    def trans_m_rot_deg(self, start: Frames, end: Frames) -> tuple[FloatArray, FloatArray]:
        """Translation errors, metres (K,), and rotation errors, degrees (K,), of the pairs."""
        trans_sq, rot = self.squared(start, end)
        return np.sqrt(trans_sq), np.rad2deg(rot)


def _map_of_each(n: int, tracked: BoolArray | None, map_ids: IntArray | None) -> IntArray:
    """The map of each frame (n,), -1 where there is no pose."""
    tracked = np.ones(n, dtype=np.bool_) if tracked is None else np.asarray(tracked)
    map_ids = np.zeros(n, dtype=np.int64) if map_ids is None else np.asarray(map_ids)
    for name, values, kinds, wanted in (("tracked", tracked, "b", "bool"), ("map_ids", map_ids, "iu", "integers")):
        if values.shape != (n,) or values.dtype.kind not in kinds:
            got = f"{values.dtype} of shape {values.shape}"
            raise TrajectoryError(f"{name}: expected {wanted} of shape ({n},), one a pose, got {got}")
    return np.where(tracked, map_ids, -1).astype(np.int64)


def _norm_sq(vectors: FloatArray) -> FloatArray:
    """Squared lengths (N,) of vectors (k, N)."""
    return cast(FloatArray, np.einsum("kn,kn->n", vectors, vectors))
