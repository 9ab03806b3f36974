"""Single pairs that fail now and did not before: what the means over all paths are too coarse to tell."""

import numpy as np
import pandas as pd
from scipy import stats

from slamgym.eval.statistics.multiple import corrected
from slamgym.report.comparison.differences import SIGNIFICANT
from slamgym.types import FloatArray


def broken_pairs(pairs: pd.DataFrame) -> pd.DataFrame:
    """Pairs, rows of `Pairing.pairs`, of which all repeats succeeded before and most fail now, chance or not."""
    before = pairs["successes.baseline"] == pairs["runs.baseline"]
    return pairs[before & (2 * pairs["successes.new"] < pairs["runs.new"])]


def regressed_pairs(pairs: pd.DataFrame) -> pd.DataFrame:
    """Pairs whose repeats fail more often than before by more than chance: `more_failures_p` below SIGNIFICANT."""
    return pairs[more_failures_p(pairs) < SIGNIFICANT]


def more_failures_p(pairs: pd.DataFrame) -> FloatArray:
    """p-value (pairs,) of so many more failures of a pair's repeats, were it to fail as often as before.

    Fisher's exact test, one-sided (R. A. Fisher, "The logic of inductive inference", 1935), corrected for the number of
    pairs by Holm's method. It tells of this pair, whose repeats are drawn, and nothing of other paths. A pair all of
    whose repeats turn is below 0.05 among up to 12 pairs of 5 repeats, or 9,237 of 10; of 3 repeats none ever is.
    """
    new, baseline = (pairs[f"runs.{side}"].to_numpy(np.int64) for side in ("new", "baseline"))
    failed, failed_before = new - pairs["successes.new"], baseline - pairs["successes.baseline"]
    return corrected(stats.hypergeom.sf(failed - 1, new + baseline, failed + failed_before, new))
