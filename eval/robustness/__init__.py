"""Robustness: what accuracy alone hides."""

from slamgym.eval.robustness.completion import Completion, Exposure, completion, completion_of, exposure, total_exposure
from slamgym.eval.robustness.correct_rate import (
    correct_poses,
    correct_rate,
    correct_rate_of_tracking,
    relocalization_score,
)
from slamgym.eval.robustness.error_area import error_area
from slamgym.eval.robustness.evaluated_map import (
    MAP_POLICIES,
    MapPolicy,
    estimate_by_frame,
    evaluated_frames,
    final_by_frame,
    frames_by_policy,
    most_frequent_map,
)
from slamgym.eval.robustness.failure_policy import POLICIES, Average, average
from slamgym.eval.robustness.failure_rates import FailureRates, cause_counts, failure_rates, status_counts
from slamgym.eval.robustness.gaps import covered_frames, find_gaps, untracked_runs
from slamgym.eval.robustness.held_pose import held_ate, hold_last_pose, last_posed
from slamgym.eval.robustness.loss_causes import CAUSES, explain
from slamgym.eval.robustness.losses import (
    STATUSES,
    SUCCESS_COMPLETION,
    find_losses,
    is_success,
    status,
    tracked_frames,
    true_poses,
)
from slamgym.eval.robustness.precision_recall import PrecisionRecall, precision_recall, precision_recall_area

__all__ = [
    "CAUSES",
    "MAP_POLICIES",
    "POLICIES",
    "STATUSES",
    "SUCCESS_COMPLETION",
    "Average",
    "Completion",
    "Exposure",
    "FailureRates",
    "MapPolicy",
    "PrecisionRecall",
    "average",
    "cause_counts",
    "completion",
    "completion_of",
    "correct_poses",
    "correct_rate",
    "correct_rate_of_tracking",
    "covered_frames",
    "error_area",
    "estimate_by_frame",
    "evaluated_frames",
    "explain",
    "exposure",
    "failure_rates",
    "final_by_frame",
    "find_gaps",
    "find_losses",
    "frames_by_policy",
    "held_ate",
    "hold_last_pose",
    "is_success",
    "last_posed",
    "most_frequent_map",
    "precision_recall",
    "precision_recall_area",
    "relocalization_score",
    "status",
    "status_counts",
    "total_exposure",
    "tracked_frames",
    "true_poses",
    "untracked_runs",
]
