"""The runs of a study as the statistics take them: which were judged, which failed, what was varied."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from slamgym.report.levels import Factor, find_factors, with_levels
from slamgym.study.results import StudyResults
from slamgym.study.table import NOT_RUN
from slamgym.types import FloatArray

FAILED = "lost at least once, not tracked to the end, or tracked for less than half of the frames"
"""What a failed run is, in words: not a success of docs/metrics.md."""

_MEDIANS = ("ate_rmse_m", "rpe_trans_rmse_m", "rpe_rot_mean_deg", "completion")


@dataclass(frozen=True, slots=True, eq=False)
class JudgedRuns:
    """The runs that a SLAM was started for.

    table: one row a run: all columns of the study's table, and `failed`, bool; `place`, the path with its dataset, by
    which runs are paired; `error_m`, the ATE, +inf for a failed run and NaN for one that succeeded without a truth; for
    each factor its column of level names. cells: one row for each path at each combination of levels, its repeats
    brought together: `place`, the factors' columns, `dataset`, `path`, `runs`, `failures`, `share` that failed,
    `error_m` (median, failed ones last), and the medians of completion and, of successful runs, of the relative errors.
    """

    table: pd.DataFrame
    cells: pd.DataFrame
    factors: tuple[Factor, ...]

    @property
    def columns(self) -> list[str]:
        return [factor.column for factor in self.factors]

    @property
    def paths(self) -> int:
        return int(self.table["place"].nunique())


def judged_runs(results: StudyResults) -> JudgedRuns:
    """All runs of the study that were not `not_run`."""
    runs = results.runs.reset_index(drop=True)
    if "status" in runs:
        runs = runs[runs["status"] != NOT_RUN]
    factors = find_factors(runs, results.factors)
    table = with_levels(_with_outcome(runs), factors)
    return JudgedRuns(table, _cells(table, factors), factors)


def numbers(table: pd.DataFrame, column: str) -> FloatArray:
    """A column as float64, NaN where it has no number or the table has no such column."""
    if column not in table:
        return np.full(len(table), np.nan)
    return pd.to_numeric(table[column], errors="coerce").to_numpy(np.float64, na_value=np.nan)


def texts(table: pd.DataFrame, column: str) -> "pd.Series[str]":
    """A column as text, "" where it has none or the table has no such column."""
    if column not in table:
        return pd.Series("", index=table.index, dtype=object)
    return table[column].astype(object).where(table[column].notna(), "").astype(str)


def _with_outcome(runs: pd.DataFrame) -> pd.DataFrame:
    failed = ~texts(runs, "success").eq("True").to_numpy(np.bool_)
    ate = numbers(runs, "ate_rmse_m")
    dataset, path = texts(runs, "dataset"), texts(runs, "path")
    # Two datasets may well have sequences of one name.
    alike = len(set(zip(dataset, path, strict=True))) > path.nunique()
    place = dataset + ": " + path if alike else path
    return runs.assign(
        failed=failed, error_m=np.where(failed, np.inf, ate), place=place, dataset=dataset, path=path,
        **{name: numbers(runs, name) for name in _MEDIANS},
    )  # fmt: skip


def _cells(table: pd.DataFrame, factors: tuple[Factor, ...]) -> pd.DataFrame:
    keys = ["place", *(factor.column for factor in factors)]
    relative = ["rpe_trans_rmse_m", "rpe_rot_mean_deg"]
    kept = table[[*keys, "dataset", "path", "failed", "error_m", "completion"]]
    kept = kept.assign(**table[relative].where(~table["failed"]))
    cells = kept.groupby(keys, observed=True, sort=True).agg(
        dataset=("dataset", "first"), path=("path", "first"), runs=("failed", "size"), failures=("failed", "sum"),
        error_m=("error_m", "median"), completion=("completion", "median"),
        **{name: (name, "median") for name in relative},
    )  # fmt: skip
    return cells.assign(share=cells["failures"] / cells["runs"]).reset_index()
