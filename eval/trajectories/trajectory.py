"""A trajectory: poses over time."""

from dataclasses import dataclass

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import FloatArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses over time: stamps_ns int64 (N,), strictly increasing; T float64 (N, 4, 4), T_world_cam or T_map_cam.

    Raises TrajectoryError when the shapes do not fit, a value is not finite, or the stamps do not increase.
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
        if not np.isfinite(self.T).all():
            bad = int(np.flatnonzero(~np.isfinite(self.T).all(axis=(1, 2)))[0])
            raise TrajectoryError(f"expected finite poses, got NaN or infinity in pose {bad}: leave it out")
        if (steps := np.diff(self.stamps_ns) <= 0).any():
            bad = int(np.argmax(steps)) + 1
            raise TrajectoryError(f"expected strictly increasing stamps, got {self.stamps_ns[bad]} ns at pose {bad}")

    def __len__(self) -> int:
        return len(self.stamps_ns)

    @property
    def positions(self) -> FloatArray:
        """Positions (N, 3), metres."""
        return self.T[:, :3, 3]
