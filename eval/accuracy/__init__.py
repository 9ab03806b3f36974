"""Accuracy: errors of an estimated trajectory against the truth."""

from slamgym.eval.accuracy.absolute import ate
from slamgym.eval.accuracy.alignment import align_rigid
from slamgym.eval.accuracy.error_stats import ErrorStats
from slamgym.eval.accuracy.relative import RpeStats, rpe, rpe_all_steps, rpe_pooled

__all__ = ["ErrorStats", "RpeStats", "align_rigid", "ate", "rpe", "rpe_all_steps", "rpe_pooled"]
