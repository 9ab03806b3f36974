"""What all errors ask of the poses of truth and estimate, (N, 4, 4), of which row i belongs to row i."""

from typing import cast

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import BoolArray, FloatArray

_RIGID_TOLERANCE = 1e-4  # files hold few digits, and many SLAMs reckon in float32


def check_shapes(ref_T: FloatArray, est_T: FloatArray) -> None:
    if ref_T.shape != est_T.shape or ref_T.shape[1:] != (4, 4):
        raise TrajectoryError(f"expected poses (N, 4, 4) in pairs, got shapes {ref_T.shape} and {est_T.shape}")


def check_poses(ref_T: FloatArray, est_T: FloatArray) -> None:
    """Raise TrajectoryError unless both are finite, rigid poses (N, 4, 4), as many of one as of the other."""
    check_shapes(ref_T, est_T)
    for name, T in (("truth", ref_T), ("estimate", est_T)):
        if not np.isfinite(T).all():
            bad = int(np.argmin(np.isfinite(T).all(axis=(1, 2))))
            raise TrajectoryError(
                f"{name}: expected finite poses, got NaN or infinity in pose {bad}: "
                "leave it out, or mask it as not tracked"
            )
        if not (rigid := _is_rigid(T)).all():
            raise TrajectoryError(
                f"{name}: expected rigid poses, a rotation and a translation, got another matrix in pose "
                f"{np.argmin(rigid)}: is there a scale in it, or a mirror image?"
            )


def _is_rigid(T: FloatArray) -> BoolArray:
    """Whether matrices (N, 4, 4) hold an orthogonal, right-handed matrix above the row 0, 0, 0, 1."""
    R = T[:, :3, :3]
    off = np.abs(R.swapaxes(1, 2) @ R - np.eye(3)).max(axis=(1, 2))
    last_row = (T[:, 3] == [0, 0, 0, 1]).all(axis=1)
    return cast(BoolArray, (off < _RIGID_TOLERANCE) & (np.linalg.det(R) > 0) & last_row)
