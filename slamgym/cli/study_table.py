"""The results of a study on the terminal: a line for each level of its first factors."""

from typing import Any

import numpy as np
import pandas as pd
from rich.table import Table

from slamgym.eval.plots.names import printable, shorten
from slamgym.eval.robustness import average
from slamgym.study.results import StudyResults
from slamgym.study.table import NOT_RUN
from slamgym.tables import PERCENT, figures_table

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
    runs = done.runs[done.runs["status"] != NOT_RUN]
    rows = [_row("all", runs)]
    for factor in done.factors[:FACTORS]:
        rows += [_row(f"{factor} {_level(level)}", at) for level, at in runs.groupby(factor, dropna=False)]
    return figures_table(COLUMNS, rows)


def _level(level: Any) -> str:
    return "-" if pd.isna(level) else str(level)


def _row(name: str, runs: pd.DataFrame) -> dict[str, Any]:
    success = runs["success"].astype(bool).to_numpy()
    ate = (runs["ate_rmse_m"] if "ate_rmse_m" in runs else runs["completion"] * np.nan).to_numpy(np.float64)
    statuses = runs["status"].value_counts()
    return {
        "level": shorten(printable(name), LONGEST_LEVEL),
        "runs": len(runs),
        "success": float(success.mean()) if len(runs) else np.nan,
        "ate_rmse_m": average(ate, ~success | ~np.isfinite(ate), "penalise", penalty=np.inf).value,
        "completion": float(runs["completion"].mean()),
        "status": ", ".join(f"{count} {status}" for status, count in statuses.items()),
    }
