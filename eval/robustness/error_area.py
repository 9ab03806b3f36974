"""Area under the cumulative error curve over sequences: one number that a failed sequence always lowers."""

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.types import FloatArray


def error_area(errors: FloatArray, max_error: float) -> float:
    """Area under the curve "share of all sequences with an error of at most x" for x in 0..max_error, over max_error.

    errors (S,), such as the ATE of each sequence, NaN or infinite for one that failed. Between 0 (all failed, or worse
    than max_error) and 1 (all perfect); NaN without sequences. Exact: the mean of `threshold_share`.
    The ranking of the ETH3D SLAM benchmark: Schoeps et al., "BAD SLAM: Bundle adjusted direct RGB-D SLAM", CVPR 2019.
    Raises TrajectoryError for an error below 0, ConfigError for a max_error that is not finite and above 0.
    """
    share = threshold_share(errors, max_error)
    return float(share.mean()) if len(share) else np.nan


def threshold_share(errors: FloatArray, max_error: float) -> FloatArray:
    """Share of the thresholds in 0..max_error that each error (S,) stays within: max(0, 1 - error / max_error).

    0 for errors that are NaN or infinite. Raises as `error_area`.
    """
    if not 0 < max_error < np.inf:
        raise ConfigError(f"area under errors: expected a largest error above 0 and finite, got {max_error}")
    check_errors(errors)
    return np.asarray(np.maximum(1.0 - np.where(np.isfinite(errors), errors, np.inf) / max_error, 0.0))


def check_errors(errors: FloatArray) -> None:
    """Raise TrajectoryError unless `errors` is (S,) and none is below 0."""
    if errors.ndim != 1:
        raise TrajectoryError(f"expected errors of shape (S,), got {errors.shape}")
    if (errors < 0).any():
        raise TrajectoryError(
            f"expected errors of 0 or more, got {errors[errors < 0].min()}: give distances, not differences"
        )
