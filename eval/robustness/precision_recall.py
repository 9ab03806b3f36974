"""Precision and recall of estimated poses.

Zhao et al., "SubT-MRS dataset: Pushing SLAM towards all-weather environments", CVPR 2024. There the errors are those of
the velocities; here they may be any error of the estimated poses against their true ones.
"""

from typing import NamedTuple

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError
from slamgym.eval.robustness.error_area import check_errors, threshold_share
from slamgym.types import FloatArray


class PrecisionRecall(NamedTuple):
    """Shares 0..1, or areas under them."""

    precision: float
    recall: float
    f1: float


def precision_recall(errors: FloatArray, n_truth: int, threshold: float) -> PrecisionRecall:
    """Share of the estimated poses that are right, share of the true ones that a right one was found for, and F1.

    errors (M,): of all estimated poses, NaN or infinite for one that has no true pose; right is an error of at most
    `threshold`, in their unit. n_truth: number of true poses. F1 is the harmonic mean of both. 0/0 counts as 0: no
    estimate earns nothing. Raises TrajectoryError for an error below 0 or more errors that are finite than true poses,
    ConfigError for a threshold below 0 or not finite.
    """
    if not 0 <= threshold < np.inf:
        raise ConfigError(f"precision and recall: expected a threshold of 0 or more and finite, got {threshold}")
    check_errors(errors)
    return _from_right(float((errors <= threshold).sum()), errors, n_truth)


def precision_recall_area(errors: FloatArray, n_truth: int, max_threshold: float) -> PrecisionRecall:
    """Areas under precision, recall and F1 over the thresholds 0..max_threshold, divided by max_threshold.

    Exact integrals of the steps, not trapezoids: with M errors all three are multiples of the number of right poses
    (F1 = 2 right / (M + n_truth)), whose mean over the thresholds is the sum of `threshold_share`.
    Raises as `precision_recall`, ConfigError for a max_threshold that is not finite and above 0.
    """
    return _from_right(float(threshold_share(errors, max_threshold).sum()), errors, n_truth)


def _from_right(right: float, errors: FloatArray, n_truth: int) -> PrecisionRecall:
    if (judged := int(np.isfinite(errors).sum())) > n_truth:
        raise TrajectoryError(f"expected at most one error a true pose, got {judged} errors for {n_truth} true poses")
    return PrecisionRecall(
        precision=right / max(len(errors), 1),
        recall=right / max(n_truth, 1),
        f1=2.0 * right / max(len(errors) + n_truth, 1),
    )
