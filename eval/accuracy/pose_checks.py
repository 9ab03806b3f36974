"""What all errors ask of the poses of truth and estimate, (N, 4, 4), of which row i belongs to row i."""

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories.trajectory import are_rigid
from slamgym.types import FloatArray

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
        if not (rigid := are_rigid(T, _RIGID_TOLERANCE)).all():
            raise TrajectoryError(
                f"{name}: expected rigid poses, a rotation and a translation, got another matrix in pose "
                f"{np.argmin(rigid)}: is there a scale in it, or a mirror image?"
            )
