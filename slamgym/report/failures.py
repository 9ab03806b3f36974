"""When do runs fail? Curves over each numeric factor, and heat maps over each two of them."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from slamgym.eval.plots import FailureCounts, plot_failure_curve, plot_failure_curves, plot_heat_map
from slamgym.eval.statistics import Interval
from slamgym.report.content import DataTable, Picture, Section
from slamgym.report.judged import JudgedRuns, left_out_text, of_complete_paths
from slamgym.report.levels import Factor
from slamgym.report.shares import FEWEST_PATHS, Trend, compare_levels, failure_trend
from slamgym.report.wording import confidence, number, number_range, percent, sentence
from slamgym.types import IntArray

FEWEST_LEVELS = 3
MOST_SERIES = 5
MOST_PICTURES = 6
_UNKNOWN = Interval(np.nan, np.nan, np.nan)


def trends(judged: JudgedRuns) -> list[Trend]:
    """The curve of failures over each numeric factor of three levels or more, of the paths with all conditions."""
    complete = of_complete_paths(judged)
    found = [failure_trend(complete, factor) for factor in judged.factors if _has_curve(complete, factor)]
    return [trend if trend.changes else replace(trend, levels_differ=_levels_differ(judged, trend)) for trend in found]


def _has_curve(judged: JudgedRuns, factor: Factor) -> bool:
    return factor.is_numeric and judged.table[factor.column].nunique() >= FEWEST_LEVELS


def _levels_differ(judged: JudgedRuns, trend: Trend) -> bool:
    return any(one.differs and one.paths >= FEWEST_PATHS for one in compare_levels(judged, trend.factor))


def failures_section(judged: JudgedRuns, seen: Sequence[Trend]) -> Section:
    """Curves, curves by the level of another factor, heat maps, and a table of where half of the runs fail."""
    complete = of_complete_paths(judged)
    by_level = list(_trends_by_level(complete))
    rows = [_midpoint_row(trend, "all levels") for trend in seen]
    rows += [_midpoint_row(trend, other.told(level)) for other, level, trend in by_level]
    tables = (_midpoints(rows),) if rows else ()
    pictures = [*(_curve(complete, trend) for trend in seen), *_curves(complete, by_level), *_heat_maps(complete)]
    told = [trend_text(trend, len(judged.factors) > 1) for trend in seen]
    left_out = left_out_text(judged) if tables or pictures else ""
    return Section(
        "failures",
        "When do runs fail?",
        sentences=tuple(sentence(text) for text in (*told, left_out) if text),
        tables=tables,
        pictures=tuple(pictures),
    )


def trend_text(trend: Trend, others: bool) -> str:
    """What the runs say of failures over the factor; others: whether there are more factors."""
    factor, title, middle = trend.factor, trend.factor.title, trend.midpoint
    every = {level: f"{percent(share)} at {factor.told(level)}" for level, share in trend.share_at.items()}
    ends = f"{every[trend.levels[0]]}, {every[trend.levels[-1]]}"
    shown = ", ".join(text for level, text in every.items() if level in factor.shown)
    together = ", all levels of the other factors together" if others else ""
    if trend.paths < FEWEST_PATHS:
        return f"too few paths ({trend.paths}) to tell a trend with the {title}: {ends}{together}"
    if trend.changes and not trend.fits:
        return f"failures do not simply rise or fall with the {title}: {shown}{together}"
    if trend.levels_differ:
        return f"failures differ between levels of the {title}, but do not surely rise or fall: {shown}{together}"
    if not trend.is_seen:
        return f"failures show no certain trend with the {title}: {ends}{together}"
    if not trend.midpoint_is_known:
        return f"failures {'rise' if trend.rising else 'fall'} with the {title}: {ends}{together}{_half_text(trend)}"
    side, where = "above" if trend.rising else "below", factor.told(number(middle.estimate))
    return f"half of the runs fail {side} {where} ({confidence(middle)} {number_range(middle)}){together}: {ends}"


def _half_text(trend: Trend) -> str:
    """What is known of where half of the runs fail without a guess beyond the levels that were tried."""
    if max(trend.share_at.values()) < 0.5:
        return "; fewer than half fail at every level tried"
    if min(trend.share_at.values()) > 0.5:
        return "; more than half fail at every level tried"
    return "; the paths are too few to tell where half of the runs fail"


def _trends_by_level(judged: JudgedRuns) -> Iterator[tuple[Factor, str, Trend]]:
    """The curve over each numeric factor at each level of each factor of few levels."""
    for factor in (factor for factor in judged.factors if _has_curve(judged, factor)):
        for other in judged.factors:
            if other is not factor and len(other.levels) <= MOST_SERIES:
                for level, runs in judged.table.groupby(other.column, observed=True):
                    yield other, str(level), failure_trend(judged, factor, runs)


def _midpoint_row(trend: Trend, of: str) -> dict[str, Any]:
    known = trend.midpoint if trend.midpoint_is_known else _UNKNOWN
    return {
        "factor": trend.factor.label,
        "runs at": of,
        "runs": trend.curve.runs,
        "failed": trend.curve.failures,
        "half fail at": known.estimate,
        "95 % from": known.low,
        "95 % to": known.high,
    }


def _midpoints(rows: list[dict[str, Any]]) -> DataTable:
    return DataTable(
        name="midpoints",
        title="Where half of the runs fail",
        caption="From a logistic curve over the factor, in the factor's unit; the interval takes into account that "
        "runs of one path fail together. A dash: the runs show no certain trend, or the value lies beyond the levels "
        "that were tried.",
        frame=pd.DataFrame(rows),
        formats={"half fail at": "{:.3g}", "95 % from": "{:.3g}", "95 % to": "{:.3g}"},
    )


def _counts(table: pd.DataFrame, factor: Factor) -> tuple[IntArray, IntArray]:
    """Failed runs and all runs at each level (L,)."""
    by_level = table.groupby(factor.column, observed=False)["failed"].agg(["sum", "count"])
    return by_level["sum"].to_numpy(np.int64), by_level["count"].to_numpy(np.int64)


def _curve(judged: JudgedRuns, trend: Trend) -> Picture:
    factor = trend.factor
    return Picture(
        name=_name("failure_curve", factor),
        title=f"Failures over the {factor.title}",
        caption="Points: the share of runs that failed at each level, with the interval that independent runs would "
        "have. Line: the curve fitted to them. Where it crosses 50 %, half of the runs fail; the band is the interval "
        "of that point, for paths like these.",
        draw=partial(plot_failure_curve, *_series(judged.table, trend), factor=factor.label),
    )


def _curves(judged: JudgedRuns, by_level: Sequence[tuple[Factor, str, Trend]]) -> list[Picture]:
    pairs = dict.fromkeys((trend.factor, other) for other, _, trend in by_level)
    return [_curves_of(judged, factor, other, by_level) for factor, other in list(pairs)[:MOST_PICTURES]]


def _curves_of(
    judged: JudgedRuns, factor: Factor, other: Factor, by_level: Sequence[tuple[Factor, str, Trend]]
) -> Picture:
    series = {
        other.told(level): _series(judged.table[judged.table[other.column] == level], trend)
        for one, level, trend in by_level
        if one is other and trend.factor is factor
    }
    return Picture(
        name=_name("failure_curves", factor, other),
        title=f"Failures over the {factor.title}, by {other.title}",
        caption="A curve for each level; a thin upright line marks where half of its runs fail. Where there is no "
        "certain trend, the observed shares are joined instead.",
        draw=partial(plot_failure_curves, series, factor=factor.label, by=other.label),
    )


def _series(table: pd.DataFrame, trend: Trend) -> FailureCounts:
    failed, runs = _counts(table, trend.factor)
    driven = runs > 0
    return FailureCounts(
        trend.factor.values[driven], failed[driven], runs[driven], trend.curve if trend.is_seen else None
    )


def _heat_maps(judged: JudgedRuns) -> list[Picture]:
    numeric = [factor for factor in judged.factors if factor.is_numeric]
    return [_heat_map(judged, x, y) for x, y in list(combinations(numeric, 2))[:MOST_PICTURES]]


def _heat_map(judged: JudgedRuns, x: Factor, y: Factor) -> Picture:
    cells = judged.table.groupby([y.column, x.column], observed=False)["failed"].agg(["sum", "count"])
    shape = len(y.levels), len(x.levels)
    failed, runs = (cells[name].to_numpy(np.int64).reshape(shape) for name in ("sum", "count"))
    return Picture(
        name=_name("heat_map", x, y),
        title=f"Failures over {x.title} and {y.title}",
        caption="Each cell holds the runs that failed of those at its two levels: the darker, the more of them.",
        draw=partial(plot_heat_map, failed, runs, x.levels, y.levels, x_factor=x.label, y_factor=y.label),
    )


def _name(kind: str, *factors: Factor) -> str:
    return "_".join([kind, *(factor.slug for factor in factors)])
