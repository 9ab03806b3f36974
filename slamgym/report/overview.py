"""Accuracy and robustness side by side: all runs, the levels of each factor, the datasets, the paths."""

from typing import Any

import numpy as np
import pandas as pd

from slamgym.eval.plots import printable
from slamgym.eval.robustness import average
from slamgym.eval.statistics import Interval, clustered_share
from slamgym.report.columns import numbers
from slamgym.report.content import DataTable, Section
from slamgym.report.facts import driven
from slamgym.report.judged import JudgedRuns, of_complete_paths
from slamgym.types import BoolArray, FloatArray

FAILED_LAST = "median ATE, failed last (m)"
SUCCESSFUL = "median ATE, successful (m)"
FORMATS = {
    "failed share": "{:.1%}", "95 % from": "{:.1%}", "95 % to": "{:.1%}", FAILED_LAST: "{:.4f}", SUCCESSFUL: "{:.4f}",
    "median RPE, successful (m)": "{:.4f}", "median RPE, successful (deg)": "{:.2f}",
    "mean completion": "{:.1%}", "losses/min": "{:.2f}", "losses/m": "{:.3f}",
}  # fmt: skip
POLICY = (
    "'Failed last': the median over all runs, in which a failed one counts as worse than any other; a dash says that "
    "half of the runs or more failed. 'Successful' leaves failed runs out, which flatters: read it beside the "
    "completion, which is a mean over all runs."
)
MOST_PATHS = 60
MOST_ROWS = 300


def overview_section(judged: JudgedRuns) -> Section:
    """One table: all runs, then each level of each factor."""
    rows = [{"factor": "all runs", "level": "", **figures(judged.table)}]
    complete = of_complete_paths(judged)
    for factor in judged.factors:
        groups = complete.table.groupby(factor.column, observed=True)
        rows += [{"factor": factor.label, "level": str(level), **figures(group)} for level, group in groups]
    table = DataTable(
        name="overview",
        title="All runs, and the levels of each factor",
        caption="Each level over all levels of the other factors. The interval of the failed share takes into account "
        f"that runs of one path fail together. {POLICY}{_left_out(judged, complete)}",
        frame=pd.DataFrame(rows[:MOST_ROWS]),
        formats=FORMATS,
    )
    return Section("overview", "At a glance", tables=(table,))


def _left_out(judged: JudgedRuns, complete: JudgedRuns) -> str:
    kept, paths = complete.paths, judged.paths
    return f" Levels are of the {kept:,} of {paths:,} paths with runs under all conditions." if kept < paths else ""


def paths_section(judged: JudgedRuns) -> Section:
    """The datasets, where there are several, at the levels of each factor; and the paths, the hardest first."""
    tables = [_hardest_paths(judged)]
    if judged.table["dataset"].nunique() > 1:
        tables.insert(0, _datasets(judged))
    return Section("paths", "Datasets and paths" if len(tables) > 1 else "Paths", tables=tuple(tables))


def _datasets(judged: JudgedRuns) -> DataTable:
    rows = list[dict[str, Any]]()
    for dataset, runs in judged.table.groupby("dataset", sort=False):
        name = printable(str(dataset))
        rows.append({"dataset": name, "factor": "all runs", "level": "", **figures(runs)})
        for factor in judged.factors:
            for level, group in runs.groupby(factor.column, observed=True):
                rows.append({"dataset": name, "factor": factor.label, "level": str(level), **figures(group)})
    return DataTable(
        name="datasets",
        title="Datasets",
        caption=f"Each dataset at each level, over all levels of the other factors. {POLICY}",
        frame=pd.DataFrame(rows[:MOST_ROWS]),
        formats=FORMATS,
    )


def _hardest_paths(judged: JudgedRuns) -> DataTable:
    failures = judged.table.groupby("place")["failed"].mean().sort_values(ascending=False, kind="stable")
    chosen = judged.table[judged.table["place"].isin(failures.index[:MOST_PATHS])]
    by_place = dict(iter(chosen.groupby("place")))
    hardest = failures.index[:MOST_PATHS]
    rows = [{"path": printable(place), **_without_interval(figures(by_place[place]))} for place in hardest]
    every = f"The {MOST_PATHS} of {len(failures):,} paths with most failures"
    which = every if len(failures) > MOST_PATHS else "All paths"
    return DataTable(
        name="paths",
        title="Which paths are hard",
        caption=f"{which}, the hardest first, over all levels. {POLICY}",
        frame=pd.DataFrame(rows),
        formats=FORMATS,
    )


def _without_interval(row: dict[str, Any]) -> dict[str, Any]:
    """One path tells nothing of others."""
    return {key: value for key, value in row.items() if key not in ("paths", "95 % from", "95 % to")}


def figures(runs: pd.DataFrame) -> dict[str, Any]:
    """The figures of a group of runs, heading -> value; NaN where they cannot be told. Runs: one or more."""
    failed, error_m = runs["failed"].to_numpy(np.bool_), runs["error_m"].to_numpy(np.float64)
    share = clustered_share(failed, runs["place"].to_numpy(str))
    return {
        "paths": runs["place"].nunique(),
        "runs": len(runs),
        "failed": int(failed.sum()),
        **_interval_columns("failed share", share),
        FAILED_LAST: _median(error_m, failed, "penalise"),
        SUCCESSFUL: _median(error_m, failed, "drop"),
        "mean completion": _mean(numbers(runs, "completion")),
        **_loss_rates(runs),
        "median RPE, successful (m)": _median(numbers(runs, "rpe_trans_rmse_m"), failed, "drop"),
        "median RPE, successful (deg)": _median(numbers(runs, "rpe_rot_mean_deg"), failed, "drop"),
    }


def _interval_columns(name: str, interval: Interval) -> dict[str, float]:
    return {name: interval.estimate, "95 % from": interval.low, "95 % to": interval.high}


def _median(values: FloatArray, failed: BoolArray, policy: str) -> float:
    """Of the runs that failed or have a value: one that succeeded without a truth has none."""
    known = failed | np.isfinite(values)
    penalty = np.inf if policy == "penalise" else None
    return average(values[known], failed[known], policy, penalty=penalty).value


def _mean(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else np.nan


def _loss_rates(runs: pd.DataFrame) -> dict[str, float]:
    """All losses over all time and distance of the runs that know of both."""
    losses, (seconds, metres) = numbers(runs, "loss_count"), driven(runs)
    return {"losses/min": 60 * _rate(losses, seconds), "losses/m": _rate(losses, metres)}


def _rate(losses: FloatArray, over: FloatArray) -> float:
    known = np.isfinite(losses) & np.isfinite(over)
    total = float(over[known].sum())
    return float(losses[known].sum()) / total if total > 0 else np.nan
