"""What all errors ask of the poses of truth and estimate, (N, 4, 4) in pairs."""

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import FloatArray


def check_shapes(ref_T: FloatArray, est_T: FloatArray) -> None:
    if ref_T.shape != est_T.shape or ref_T.shape[1:] != (4, 4):
        raise TrajectoryError(f"expected poses (N, 4, 4) in pairs, got shapes {ref_T.shape} and {est_T.shape}")


def check_finite(ref_T: FloatArray, est_T: FloatArray) -> None:
    if not (np.isfinite(ref_T).all() and np.isfinite(est_T).all()):
        raise TrajectoryError("expected finite poses, got NaN or infinity: leave them out, or mask them as not tracked")
