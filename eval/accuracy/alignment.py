"""The transform that takes an estimate into the frame of the truth."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, unknown_word
from slamgym.eval.accuracy.pose_checks import check_poses
from slamgym.geometry import inverse
from slamgym.types import FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Similarity:
    """A scaling of positions by `scale`, then the rigid transform T (4, 4)."""

    scale: float
    T: FloatArray

    def apply(self, T: FloatArray) -> FloatArray:
        """Poses (N, 4, 4): positions scaled, then moved; rotations turned."""
        R = self.T[:3, :3]
        moved = np.empty(T.shape)
        moved[:, :3, :3] = R @ T[:, :3, :3]
        moved[:, :3, 3] = T[:, :3, 3] @ (self.scale * R).T + self.T[:3, 3]
        moved[:, 3] = T[:, 3]
        return moved


def align(ref_T: FloatArray, est_T: FloatArray, alignment: str = "se3") -> Similarity:
    """What takes the poses `est_T` (N, 4, 4) into the frame of `ref_T` (N, 4, 4), row i on row i.

    - "se3": the rigid transform that brings the positions closest, in least squares.
    - "sim3": the same with a scale. Only for a SLAM that cannot know the scale: with depth it hides an error.
    - "first_pose": the estimate's first pose onto the true one; needs one pose.
    - "none": as they are.

    Positions on one line leave the turn about it open; one of the best transforms is returned then, and what it does to
    rotations means nothing: see `free_turn`. "se3" and "sim3" after Umeyama, "Least-squares estimation of
    transformation parameters between two point patterns", PAMI 1991.

    Raises ConfigError for an unknown alignment; TrajectoryError for fewer than 3 poses ("se3", "sim3") or none
    ("first_pose"), positions all in one place ("sim3"), and arrays that are not finite rigid poses in pairs.
    """
    if alignment not in _ALIGNMENTS:
        raise ConfigError(unknown_word("alignment", alignment, ALIGNMENTS))
    check_poses(ref_T, est_T)
    return _ALIGNMENTS[alignment](ref_T, est_T)


def is_determined(ref_T: FloatArray, est_T: FloatArray, alignment: str) -> bool:
    """Whether there are poses enough, and for "sim3" ones that move, for `align` not to be refused; poses as there."""
    if len(ref_T) < _POSES_NEEDED[alignment]:
        return False
    return alignment != "sim3" or not (_in_one_place(ref_T[:, :3, 3]) or _in_one_place(est_T[:, :3, 3]))


def _se3(ref_T: FloatArray, est_T: FloatArray) -> Similarity:
    return _umeyama(est_T[:, :3, 3], ref_T[:, :3, 3], with_scale=False)


def _sim3(ref_T: FloatArray, est_T: FloatArray) -> Similarity:
    return _umeyama(est_T[:, :3, 3], ref_T[:, :3, 3], with_scale=True)


def _first_pose(ref_T: FloatArray, est_T: FloatArray) -> Similarity:
    if not len(ref_T):
        raise TrajectoryError("first_pose: expected at least 1 pose, got none: is any frame tracked?")
    return Similarity(1.0, ref_T[0] @ inverse(est_T[0]))


def _none(ref_T: FloatArray, est_T: FloatArray) -> Similarity:  # noqa: ARG001
    return Similarity(1.0, np.eye(4))


_ALIGNMENTS: dict[str, Callable[[FloatArray, FloatArray], Similarity]] = {
    "se3": _se3,
    "sim3": _sim3,
    "first_pose": _first_pose,
    "none": _none,
}

ALIGNMENTS = tuple(_ALIGNMENTS)
_POSES_NEEDED = {"se3": 3, "sim3": 3, "first_pose": 1, "none": 0}


def _umeyama(source: FloatArray, target: FloatArray, *, with_scale: bool) -> Similarity:
    """The transform that takes the points `source` (N, 3) closest to `target` (N, 3), in least squares."""
    if len(source) < _POSES_NEEDED["se3"]:
        raise TrajectoryError(f"alignment: expected at least 3 poses, got {len(source)}: use 'first_pose' or 'none'")
    if with_scale:
        _check_moving(source, target)
    mean_source, mean_target = source.mean(axis=0), target.mean(axis=0)
    source, target = source - mean_source, target - mean_target
    U, D, Vt = np.linalg.svd(target.T @ source)
    # Without the sign the best orthogonal matrix may be a mirror image.
    S = np.array([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    R = U * S @ Vt
    scale = float(D @ S / np.sum(source**2)) if with_scale else 1.0
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = mean_target - scale * R @ mean_source
    return Similarity(scale, T)


def _check_moving(source: FloatArray, target: FloatArray) -> None:
    for name, positions in (("estimate", source), ("truth", target)):
        if _in_one_place(positions):
            raise TrajectoryError(f"sim3: expected positions that move, got all of the {name} in one place: use 'se3'")


def _in_one_place(positions: FloatArray) -> bool:
    """Whether positions (N, 3) differ by no more than rounding."""
    rounding = 8 * np.finfo(np.float64).eps * np.abs(positions).max()
    return bool(np.ptp(positions, axis=0).max() <= rounding)
