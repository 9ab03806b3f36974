"""A trajectory: poses over time."""

from dataclasses import dataclass

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import BoolArray, FloatArray, IntArray

_ROTATION_TOLERANCE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses over time: stamps_ns int64 (N,), strictly increasing; T float64 (N, 4, 4), T_world_cam or T_map_cam.

    Raises TrajectoryError when the shapes do not fit, a value is not finite, a pose is not rigid (its rotation off by
    more than 1e-6), or the stamps do not increase.
    """

    stamps_ns: IntArray
    T: FloatArray

    def __post_init__(self) -> None:
        n = len(self.stamps_ns)
        if self.stamps_ns.dtype != np.int64 or self.stamps_ns.ndim != 1:
            got = f"{self.stamps_ns.dtype} of shape {self.stamps_ns.shape}"
            raise TrajectoryError(f"expected stamps as int64 nanoseconds of shape (N,), got {got}")
        if self.T.shape != (n, 4, 4):
            raise TrajectoryError(f"expected {n} poses of shape ({n}, 4, 4), one a stamp, got shape {self.T.shape}")
        if (bad := ~np.isfinite(self.T).all(axis=(1, 2))).any():
            raise TrajectoryError(f"expected finite poses, got NaN or infinity in pose {np.argmax(bad)}: leave it out")
        if (bad := ~are_rigid(self.T, _ROTATION_TOLERANCE)).any():
            raise TrajectoryError(
                f"expected rigid transforms, got pose {np.argmax(bad)} with another rotation part or last row: "
                "is it scaled, mirrored or transposed?"
            )
        if (bad := self.stamps_ns[1:] <= self.stamps_ns[:-1]).any():
            k = int(np.argmax(bad)) + 1
            raise TrajectoryError(f"expected strictly increasing stamps, got {self.stamps_ns[k]} ns at pose {k}")

    def __len__(self) -> int:
        return len(self.stamps_ns)

    @property
    def positions(self) -> FloatArray:
        """Positions (N, 3), metres."""
        return self.T[:, :3, 3]


def are_rigid(T: FloatArray, tolerance: float) -> BoolArray:
    """Which of T (N, 4, 4) are rigid: (N,), last row 0 0 0 1, the rotation's rows x, y, z of length 1, x at a right
    angle to y, and z = x cross y, each within `tolerance` (a mirrored one has z = -x cross y).
    """
    x, y, z = T[:, 0, :3], T[:, 1, :3], T[:, 2, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        off = np.column_stack(
            [_dot(x, x) - 1, _dot(y, y) - 1, _dot(x, y), np.cross(x, y) - z, T[:, 3] - [0.0, 0.0, 0.0, 1.0]]
        )
        return np.asarray((np.abs(off) <= tolerance).all(axis=1))


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ni,ni->n", a, b))
