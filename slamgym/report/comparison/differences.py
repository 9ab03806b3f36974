"""How far two studies differ in each metric, and which differences are regressions.

The rule: a metric has regressed when its change is (1) for the worse by more than the metric's tolerance, (2) with the
whole 95 % interval on the worse side, and (3) hardly chance: the p-value of all judged metrics together, corrected by
Holm's method, is below 0.05.

Paths are what is independent of each other: repeats and levels of one path are brought together before anything is
estimated or tested, so that more repeats make a path's value more exact and never count as more paths.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from slamgym.eval.statistics import Interval, bootstrap_interval
from slamgym.eval.statistics.clustered import clustered_difference
from slamgym.eval.statistics.multiple import corrected
from slamgym.eval.statistics.sign_flip import sign_flip_p
from slamgym.report.comparison.metrics import ATE, METRICS, SHARES, Metric
from slamgym.types import FloatArray

SIGNIFICANT = 0.05


@dataclass(frozen=True, slots=True)
class MetricChange:
    """One metric in both studies, over the paths where both have it; for ATE those where both succeeded.

    new, baseline: means over these paths, geometric ones where the change is a ratio. change: new - baseline, or
    new / baseline. p: of `sign_flip_p`, for judged metrics corrected by Holm's method; NaN without paths.
    """

    metric: Metric
    paths: int
    new: float
    baseline: float
    change: Interval
    p: float

    @property
    def verdict(self) -> str:
        """The words "worse" and "better" as the rule above has them, "alike" within the tolerance, else "not clear"."""
        neutral = 0.0 if self.metric.change == "difference" else 1.0
        ends = self.metric.worse_sign * (np.array([self.change.low, self.change.high]) - neutral)
        estimate = self.metric.worse_sign * (self.change.estimate - neutral)
        tolerance = self.metric.tolerance or 0.0
        if self.p < SIGNIFICANT and estimate > tolerance and ends.min() > 0:
            return "worse"
        if self.p < SIGNIFICANT and estimate < -tolerance and ends.max() < 0:
            return "better"
        return "alike" if np.abs(ends).max() <= tolerance else "not clear"

    @property
    def is_regression(self) -> bool:
        return self.metric.tolerance is not None and self.verdict == "worse"

    @property
    def change_text(self) -> str:
        """The change with its interval in words, shares and ratios in percent."""
        if not self.paths:
            return "cannot be told"
        unit = self.metric.unit_text
        ends = np.array([self.change.estimate, self.change.low, self.change.high])
        changes = ends - 1 if self.metric.change == "ratio" else ends
        estimate, low, high = map(_signed, 100 * changes if unit else changes)
        return f"{estimate} {unit}".rstrip() + f" ({100 * self.change.confidence:g} % interval {low} to {high})"

    def __str__(self) -> str:
        values = f"{self.baseline:.3g} -> {self.new:.3g}"
        p = "p < 0.001" if self.p < 0.001 else f"p = {self.p:.2g}"
        return f"{self.metric.label}: {values}, {self.change_text}, {self.paths} paths, {p}"


def metric_changes(pairs: pd.DataFrame) -> tuple[MetricChange, ...]:
    """Each metric over the pairs, rows of `Pairing.pairs`; the p-values of those that are judged are corrected."""
    changes = [metric_change(pairs, metric) for metric in METRICS]
    judged = [k for k, change in enumerate(changes) if change.metric.tolerance is not None]
    p_values = np.array([change.p for change in changes])
    p_values[judged] = corrected(p_values[judged])
    return tuple(replace(one, p=float(p)) for one, p in zip(changes, p_values, strict=True))


def paths_needed(changes: Sequence[MetricChange]) -> int:
    """So many paths it takes until any difference can be told from chance, however large it is."""
    tests = max(sum(change.metric.tolerance is not None and change.paths > 0 for change in changes), 1)
    return int(np.floor(1 + np.log2(tests / SIGNIFICANT))) + 1


def outcome_counts(pairs: pd.DataFrame) -> dict[str, int]:
    """Pairs that the new study wins, loses and ties, by the median ATE, where a failure loses against a success."""
    new, baseline = (pairs[f"{ATE.name}.{side}"].to_numpy(np.float64) for side in ("new", "baseline"))
    wins, losses = int((new < baseline).sum()), int((new > baseline).sum())
    return {"wins": wins, "losses": losses, "ties": len(pairs) - wins - losses}


def pair_changes(pairs: pd.DataFrame, metric: Metric) -> "pd.Series[float]":
    """The metric's change of each pair: new - baseline, or the logarithm of new / baseline; NaN where one has none."""
    new, baseline = (pairs[f"{metric.name}.{side}"].to_numpy(np.float64) for side in ("new", "baseline"))
    with np.errstate(divide="ignore", invalid="ignore"):
        change = new - baseline if metric.change == "difference" else np.log(new / baseline)
    return pd.Series(np.where(np.isfinite(change), change, np.nan), index=pairs.index)


def path_changes(pairs: pd.DataFrame, metric: Metric) -> "pd.Series[float]":
    """`pair_changes`, the mean of each path; paths without any are left out."""
    return pair_changes(pairs, metric).groupby(pairs["place"]).mean().dropna()


def metric_change(pairs: pd.DataFrame, metric: Metric) -> MetricChange:
    """One metric over the pairs, its p not corrected."""
    both = pairs[pair_changes(pairs, metric).notna()]
    if both.empty:
        return MetricChange(metric, 0, np.nan, np.nan, Interval(np.nan, np.nan, np.nan), np.nan)
    by_path = np.asarray(path_changes(both, metric), dtype=np.float64)
    new, baseline = (_mean(both, f"{metric.name}.{side}", metric) for side in ("new", "baseline"))
    return MetricChange(metric, len(by_path), new, baseline, _interval(by_path, metric), sign_flip_p(by_path))


def _mean(pairs: pd.DataFrame, column: str, metric: Metric) -> float:
    """Over the paths, of their means over their pairs."""
    values = np.log(pairs[column]) if metric.change == "ratio" else pairs[column]
    mean = float(values.groupby(pairs["place"]).mean().mean())
    return float(np.exp(mean)) if metric.change == "ratio" else mean


def _interval(by_path: FloatArray, metric: Metric) -> Interval:
    """Of the mean over the paths, each of them once: the same weights as the estimate and the p-value have."""
    if metric.name in SHARES:
        return clustered_difference(by_path, np.arange(len(by_path)))
    interval = bootstrap_interval(by_path, "mean")
    return interval.exp() if metric.change == "ratio" else interval


def _signed(value: float) -> str:
    return "unknown" if np.isnan(value) else "unbounded" if np.isinf(value) else f"{value:+.3g}"
