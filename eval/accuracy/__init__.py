"""Accuracy: errors of an estimated trajectory against the truth."""

from slamgym.eval.accuracy.absolute import absolute_errors, ate
from slamgym.eval.accuracy.alignment import ALIGNMENTS, Similarity, align, is_determined
from slamgym.eval.accuracy.all_steps import RpeOverSteps, rpe_all_steps, rpe_pooled
from slamgym.eval.accuracy.drift import SegmentDrift, segment_drift
from slamgym.eval.accuracy.error_stats import ErrorStats, PoseErrorStats
from slamgym.eval.accuracy.free_turn import free_turn
from slamgym.eval.accuracy.pair_selection import PAIRS, UNITS
from slamgym.eval.accuracy.relative import rpe

__all__ = [
    "ALIGNMENTS",
    "PAIRS",
    "UNITS",
    "ErrorStats",
    "PoseErrorStats",
    "RpeOverSteps",
    "SegmentDrift",
    "Similarity",
    "absolute_errors",
    "align",
    "ate",
    "free_turn",
    "is_determined",
    "rpe",
    "rpe_all_steps",
    "rpe_pooled",
    "segment_drift",
]
