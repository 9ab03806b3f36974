"""Failures of two levels on the same paths, and the curve of failures over a factor, as a report tells them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from slamgym.eval.statistics import (
    FailureCurve,
    Interval,
    bootstrap_interval,
    clustered_difference,
    clustered_share,
    failure_curve,
)
from slamgym.report.judged import JudgedRuns
from slamgym.report.levels import Factor

FEWEST_PATHS = 6
"""Fewer paths tell nothing that holds for others."""
MOST_CURVE_RUNS = 6000
"""Of more runs a curve is fitted to so many, of paths drawn at random: no person sees the difference."""
_MOST_BOOTSTRAP = 2000
_NOTHING = Interval(np.nan, np.nan, np.nan)


@dataclass(frozen=True, slots=True)
class LevelComparison:
    """A level of a factor against the one it is compared with (`base`), on the same paths and at the same levels of all
    other factors; what has no partner is left out.

    runs, failed: of the level; base_runs, base_failed: of the base. pairs: of conditions, over `paths` paths.
    difference: share of failed runs of the level minus that of the base. ratio: ATE of the level over that of the base,
    geometric mean over `both_paths` paths where both succeeded, the ends NaN of fewer than FEWEST_PATHS. corrected_for:
    number of comparisons within the factor that the intervals hold for together (Bonferroni). others: whether other
    factors were varied. depends_on: titles of those between whose first and last level the difference changes, for all
    of them together at 95 %.
    """

    factor: Factor
    base: str
    level: str
    paths: int
    pairs: int
    runs: int
    failed: int
    base_runs: int
    base_failed: int
    difference: Interval
    ratio: Interval
    both_paths: int
    corrected_for: int
    others: bool
    depends_on: tuple[str, ...]

    @property
    def differs(self) -> bool:
        """Whether the interval of the difference in failures holds no 0."""
        return bool(self.difference.low > 0 or self.difference.high < 0)

    @property
    def ratio_differs(self) -> bool:
        return bool(self.ratio.low > 1 or self.ratio.high < 1)


def compare_levels(judged: JudgedRuns, factor: Factor) -> list[LevelComparison]:
    """Each of the `shown` levels against the first one."""
    others = [other for other in judged.factors if other is not factor]
    base, *rest = factor.shown
    cells = judged.cells.set_index(["place", *(other.column for other in others)])
    by_level = {level: cells[cells[factor.column] == level] for level in factor.shown}
    compared = [_compare(factor, others, base, level, by_level[base], by_level[level], len(rest)) for level in rest]
    return [comparison for comparison in compared if comparison is not None]


def _compare(
    factor: Factor,
    others: Sequence[Factor],
    base: str,
    level: str,
    at_base: pd.DataFrame,
    at_level: pd.DataFrame,
    tests: int,
) -> LevelComparison | None:
    pairs = at_base.merge(at_level, left_index=True, right_index=True, suffixes=("_base", ""))
    if not len(pairs):
        return None
    place = pairs.index.get_level_values("place")
    confidence = 1 - 0.05 / tests
    ratio, both_paths = _ratio(pairs, place, confidence)
    differences = pairs["share"] - pairs["share_base"]
    return LevelComparison(
        factor, base, level,
        paths=place.nunique(),
        pairs=len(pairs),
        runs=int(pairs["runs"].sum()),
        failed=int(pairs["failures"].sum()),
        base_runs=int(pairs["runs_base"].sum()),
        base_failed=int(pairs["failures_base"].sum()),
        difference=clustered_difference(differences, place, confidence),
        ratio=ratio,
        both_paths=both_paths,
        corrected_for=tests,
        others=bool(others),
        depends_on=tuple(other.title for other in others if _depends(differences, other, 1 - 0.05 / len(others))),
    )  # fmt: skip


def _depends(differences: "pd.Series[float]", other: Factor, confidence: float) -> bool:
    """Whether the differences on the same paths change from the first to the last level of another factor."""
    by_level = differences.groupby(["place", other.column], observed=True).mean().unstack()
    if not {other.levels[0], other.levels[-1]} <= set(by_level.columns):
        return False
    # Half of it, as a difference of two differences goes from -2 to 2.
    change = ((by_level[other.levels[-1]] - by_level[other.levels[0]]) / 2).dropna()
    if len(change) < FEWEST_PATHS:
        return False
    return 0 not in clustered_difference(change, change.index, confidence)


def _ratio(pairs: pd.DataFrame, place: "pd.Index[str]", confidence: float) -> tuple[Interval, int]:
    """The geometric mean over the paths of the ratio of the errors, where both are numbers, and how many paths."""
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = pd.Series(np.log(pairs["error_m"].to_numpy() / pairs["error_m_base"].to_numpy()), index=place)
    by_path = logs[np.isfinite(logs)].groupby(level=0).mean().to_numpy()
    if not len(by_path):
        return _NOTHING, 0
    if len(by_path) < FEWEST_PATHS:  # an interval of so few would span orders of magnitude
        return Interval(float(np.exp(by_path.mean())), np.nan, np.nan, confidence), len(by_path)
    # More paths than that do not change the interval so that a person would see it.
    chosen = by_path if len(by_path) <= _MOST_BOOTSTRAP else _drawn(by_path, _MOST_BOOTSTRAP)
    return bootstrap_interval(chosen, "mean", confidence).exp(), len(by_path)


@dataclass(frozen=True, slots=True)
class Trend:
    """How failures go with a numeric factor.

    share_at: share of failed runs at each level that there were runs at, in order. fits: whether the curve is inside of
    the interval of the share at every level; the intervals hold together at 95 % (Bonferroni).
    levels_differ: where the curve tells nothing, whether some level differs from the first on the same paths.
    """

    factor: Factor
    curve: FailureCurve
    rising: bool
    paths: int
    share_at: Mapping[str, float]
    fits: bool
    levels_differ: bool = False

    @property
    def levels(self) -> tuple[str, ...]:
        """Those that there were runs at, in order."""
        return tuple(self.share_at)

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the greatest of these levels, in the factor's unit."""
        first, last = (self.factor.levels.index(self.levels[k]) for k in (0, -1))
        return float(self.factor.values[first]), float(self.factor.values[last])

    @property
    def changes(self) -> bool:
        """Whether the data refuse that failures do not change with the factor."""
        middle = self.curve.midpoint
        return bool(self.paths >= FEWEST_PATHS and middle.is_bounded and np.isfinite(middle.estimate))

    @property
    def is_seen(self) -> bool:
        """Whether failures rise with the factor, or fall, as the curve does."""
        return self.changes and self.fits

    @property
    def midpoint(self) -> Interval:
        """That of the curve as far as levels were tried: what lies beyond them is infinite."""
        middle, (first, last) = self.curve.midpoint, self.ends
        low, high = middle.low if middle.low >= first else -np.inf, middle.high if middle.high <= last else np.inf
        return Interval(middle.estimate, low, high, middle.confidence)

    @property
    def midpoint_is_known(self) -> bool:
        """Whether half of the runs fail between the levels tried, and one end of the interval at least is, too."""
        middle, (first, last) = self.midpoint, self.ends
        is_open = np.isinf([middle.low, middle.high]).all()
        return bool(self.is_seen and first <= middle.estimate <= last and not is_open)


def failure_trend(judged: JudgedRuns, factor: Factor, table: pd.DataFrame | None = None) -> Trend:
    """The curve over a numeric factor, of all runs at all levels of the others, or of the rows in `table`.

    Failures are taken to rise with the factor, or to fall where the runs do so.
    """
    rows = _some_paths(judged.table if table is None else table)
    codes, failed = rows[factor.column].cat.codes.to_numpy(), rows["failed"].to_numpy(np.bool_)
    x, place = factor.values[codes], rows["place"].to_numpy(str)
    rising = bool(np.sum((x - x.mean()) * failed) >= 0)
    curve = failure_curve(x, failed, groups=place, rising=rising)
    tried = np.unique(codes)
    shares = [clustered_share(failed[codes == k], place[codes == k], 1 - 0.05 / len(tried)) for k in tried]
    return Trend(
        factor, curve, rising,
        paths=rows["place"].nunique(),
        share_at={factor.levels[k]: share.estimate for k, share in zip(tried, shares, strict=True)},
        # A step may take any share at its own level, as the runs have it.
        fits=bool(np.isinf(curve.slope)) or all(map(_holds, shares, curve.probability(factor.values[tried]))),
    )  # fmt: skip


def _holds(share: Interval, probability: float) -> bool:
    """Whether the interval holds it, but for rounding: both may be 0 or 1."""
    return bool(share.low - 1e-9 <= probability <= share.high + 1e-9)


def _some_paths(table: pd.DataFrame) -> pd.DataFrame:
    """The table, or about MOST_CURVE_RUNS of its runs: of paths drawn at random, but of FEWEST_PATHS or more."""
    share = MOST_CURVE_RUNS / max(len(table), 1)
    if share >= 1:
        return table
    places = table["place"].unique()
    kept = table[table["place"].isin(_drawn(places, max(round(share * len(places)), FEWEST_PATHS)))]
    return kept.iloc[np.sort(_drawn(np.arange(len(kept)), 2 * MOST_CURVE_RUNS))]


def _drawn(values: NDArray[Any], n: int) -> NDArray[Any]:
    return np.random.default_rng(0).choice(values, min(n, len(values)), replace=False)
