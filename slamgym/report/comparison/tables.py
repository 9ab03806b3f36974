"""The tables of a comparison."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from slamgym.report.comparison.compared import Compared
from slamgym.report.comparison.differences import MetricChange, metric_change, outcome_counts, pair_changes
from slamgym.report.comparison.metrics import ATE, SUCCESS
from slamgym.report.comparison.pairing import Pairing, level_order
from slamgym.report.content import DataTable
from slamgym.report.levels import title_and_unit

MOST_PAIRS = 30
MOST_LEVELS = 20


def metrics_table(changes: Sequence[MetricChange]) -> DataTable:
    """A row for each metric, with its verdict."""
    return DataTable(
        name="compared_metrics",
        title="Every metric",
        caption="Over the paths where both studies have it; for ATE, those where more than half of the repeats "
        "succeeded in both, and so not the hard ones. Means over the paths; geometric ones of ATE and time, whose "
        "change is a ratio. Repeats and levels of a path are brought together first. p: chance of such a difference "
        "where there is none, those of judged metrics corrected for their number (Holm).",
        frame=pd.DataFrame([_metric_row(change) for change in changes]),
        formats={"new": "{:.4g}", "baseline": "{:.4g}", "p": "{:.2g}"},
    )


def _metric_row(change: MetricChange) -> dict[str, Any]:
    judged = change.metric.tolerance is not None
    return {
        "metric": change.metric.label,
        "paths": change.paths,
        "new": change.new,
        "baseline": change.baseline,
        "change": change.change_text,
        "p": change.p,
        "verdict": "regression"
        if change.is_regression
        else change.verdict
        if judged
        else f"{change.verdict}, not judged",
    }


def levels_table(pairs: pd.DataFrame, factor: str) -> DataTable:
    """A row for each level of the factor."""
    title, unit = title_and_unit(factor)
    label = f"{title} ({unit})" if unit else title
    levels = level_order(pairs[factor])[:MOST_LEVELS]
    return DataTable(
        name=f"compared_{factor.replace('.', '_')}",
        title=f"By {title}",
        caption="Better, worse, equal: pairs, by the ATE, where a failure is worse than any success. Old: the "
        "baseline.",
        frame=pd.DataFrame([{label: level, **_level_row(pairs[pairs[factor] == level])} for level in levels]),
        formats={"success, new": "{:.1%}", "success, old": "{:.1%}"},
    )


def _level_row(pairs: pd.DataFrame) -> dict[str, Any]:
    success, ate = metric_change(pairs, SUCCESS), metric_change(pairs, ATE)
    counts = outcome_counts(pairs)
    return {
        "paths": success.paths,
        "success, new": success.new,
        "success, old": success.baseline,
        "success, change": success.change_text,
        "ATE, change": ate.change_text,
        "better": counts["wins"],
        "worse": counts["losses"],
        "equal": counts["ties"],
    }


def pairs_tables(compared: Compared) -> tuple[DataTable, ...]:
    """The pairs that changed most, and those that are broken; an empty table is left out."""
    pairs = compared.pairing.pairs
    changed = pairs.assign(
        success_change=pair_changes(pairs, SUCCESS).abs(), ate_change=pair_changes(pairs, ATE).abs().fillna(0.0)
    )
    changed = changed[(changed["success_change"] > 0) | (changed["ate_change"] > 0)]
    most = changed.sort_values(["success_change", "ate_change"], ascending=False, kind="stable").head(MOST_PAIRS)
    tables = [
        _pairs_table("compared_most_changed", "What changed most", most, compared.pairing,
                     "By the change of the success rate, then by that of the ATE."),
        _pairs_table("compared_regressed", "Fail more often", compared.regressed, compared.pairing,
                     "Their repeats fail more often than before, by more than chance explains."),
        _pairs_table("compared_broken", "Broken", compared.broken, compared.pairing,
                     "All repeats succeeded before, and most fail now. With few repeats, some of them by chance."),
    ]  # fmt: skip
    return tuple(table for table in tables if len(table.frame))


def _pairs_table(name: str, title: str, pairs: pd.DataFrame, pairing: Pairing, caption: str) -> DataTable:
    frame = pairs.reset_index(drop=True)
    columns: dict[str, Any] = {"path": frame["place"]}
    columns |= {title_and_unit(factor)[0]: frame[factor] for factor in pairing.factors}
    for word, side in (("new", "new"), ("old", "baseline")):
        successes, runs = frame[f"successes.{side}"].astype(str), frame[f"runs.{side}"].astype(str)
        columns |= {f"ok, {word}": successes + " of " + runs, f"ATE, {word} (m)": frame[f"{ATE.name}.{side}"]}
    table = pd.DataFrame(columns | {"ATE ratio": np.exp(pair_changes(frame, ATE))})
    formats = {"ATE, new (m)": "{:.4f}", "ATE, old (m)": "{:.4f}", "ATE ratio": "{:.2f}"}
    legend = "ok: repeats that succeeded; old: the baseline; ratio: new to old."
    return DataTable(name=name, title=title, caption=f"{caption} {legend}", frame=table, formats=formats)
