"""The results of a study on the terminal: a line for each level of its first factors."""

from typing import Any

import numpy as np
import pandas as pd
from rich.table import Table

from slamgym.eval.plots.names import printable, shorten
from slamgym.eval.robustness import average
from slamgym.report.levels import Factor, study_factors, with_levels
from slamgym.study.results import StudyResults
from slamgym.study.table import succeeded, was_run
from slamgym.tables import PERCENT, figures_table
from slamgym.types import FloatArray

FACTORS = 2
LONGEST_LEVEL = 30

COLUMNS: dict[str, tuple[str, str]] = {
    "": ("level", "{}"),
    "runs": ("runs", "{}"),
    "without\nfailure": ("success", PERCENT),
    "median\nATE m": ("ate_rmse_m", "{:.4f}"),
    "com-\nplete": ("completion", PERCENT),
    "status": ("status", "{}"),
}
"""Heading -> key of the row, and its format. A run that failed counts as worse than any other in the median."""


def level_table(done: StudyResults) -> Table:
    """All runs, then those at each level of the first factors; without those that could not be run."""
    runs = done.runs[was_run(done.runs)]
    factors = study_factors(done)[:FACTORS]
    runs = with_levels(runs, factors)
    rows = [_row("all", runs)]
    for factor in factors:
        rows += [_row(_named(factor, level), runs[runs[factor.column] == level]) for level in factor.levels]
    return figures_table(COLUMNS, rows)


def _named(factor: Factor, level: str) -> str:
    told = factor.told(level)
    return told if told.startswith(factor.title) else f"{factor.title} {told}"


def _numbers(runs: pd.DataFrame, name: str) -> FloatArray:
    """A column of results, NaN where no run has one."""
    return runs[name].to_numpy(np.float64) if name in runs else np.full(len(runs), np.nan)


def _row(name: str, runs: pd.DataFrame) -> dict[str, Any]:
    success = succeeded(runs).to_numpy()
    ate, completion = _numbers(runs, "ate_rmse_m"), _numbers(runs, "completion")
    statuses = runs["status"].value_counts()
    return {
        "level": shorten(printable(name), LONGEST_LEVEL),
        "runs": len(runs),
        "success": float(success.mean()) if len(runs) else np.nan,
        "ate_rmse_m": average(ate, ~success | ~np.isfinite(ate), "penalise", penalty=np.inf).value,
        "completion": float(completion.mean()) if len(runs) else np.nan,
        "status": ", ".join(f"{count} {status}" for status, count in statuses.items()),
    }
