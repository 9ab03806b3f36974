"""Statistics over many runs: intervals, correlations, failure curves, comparisons of two systems.

Not imported by the rest of the package, since statsmodels takes a second to import.
"""

from slamgym.eval.statistics.clustered import clustered_difference, clustered_share
from slamgym.eval.statistics.correlation import correlations
from slamgym.eval.statistics.failure_curve import FailureCurve, failure_curve
from slamgym.eval.statistics.failure_threshold import FailureThreshold, failure_threshold
from slamgym.eval.statistics.intervals import Interval, bootstrap_interval, median_interval, proportion_interval
from slamgym.eval.statistics.paired import PairedComparison, compare_pairs
from slamgym.eval.statistics.repeats import median_over_repeats

__all__ = [
    "FailureCurve",
    "FailureThreshold",
    "Interval",
    "PairedComparison",
    "bootstrap_interval",
    "clustered_difference",
    "clustered_share",
    "compare_pairs",
    "correlations",
    "failure_curve",
    "failure_threshold",
    "median_interval",
    "median_over_repeats",
    "proportion_interval",
]
