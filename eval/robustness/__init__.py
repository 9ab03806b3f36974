"""Robustness: what accuracy alone hides."""

from slamgym.eval.robustness.evaluated_map import (
    completion,
    estimate_by_frame,
    evaluated_map,
    final_by_frame,
    most_frequent_map,
)
from slamgym.eval.robustness.losses import find_losses, seconds_between, status, success, tracked_frames

__all__ = [
    "completion",
    "estimate_by_frame",
    "evaluated_map",
    "final_by_frame",
    "find_losses",
    "most_frequent_map",
    "seconds_between",
    "status",
    "success",
    "tracked_frames",
]
