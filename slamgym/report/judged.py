"""The runs of a study as the statistics take them: which were judged, which failed, what was varied."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from slamgym.report.columns import numbers, places, texts
from slamgym.report.levels import Factor, study_factors, with_columns, with_levels
from slamgym.report.wording import count
from slamgym.study.results import StudyResults
from slamgym.study.table import succeeded, was_run

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


def of_complete_paths(judged: JudgedRuns) -> JudgedRuns:
    """Its runs on the paths that have all conditions that any path has: on these alone can levels be compared.

    While a study runs, hard paths may have been driven at other levels than easy ones, which looks like a trend. Where
    no path has them all, those with the most conditions that the same paths have.
    """
    cells = judged.cells
    if not judged.factors or not len(cells):
        return judged
    conditions = cells.groupby(judged.columns, observed=True).ngroup()
    of_path = conditions.groupby(cells["place"]).agg(frozenset)
    common = of_path.value_counts()
    if len(common) == 1:
        return judged
    most = max(common.index, key=lambda among: (len(among), common[among]))
    places = of_path.index[[among == most for among in of_path]]
    table, kept = judged.table, cells[cells["place"].isin(places)]
    return JudgedRuns(table[table["place"].isin(places)], kept, judged.factors)


def left_out_text(judged: JudgedRuns) -> str:
    """How many paths are not among those of `of_complete_paths`, in words; "" where all are."""
    missing = judged.paths - of_complete_paths(judged).paths
    if not missing:
        return ""
    lack = "lacks" if missing == 1 else "lack"
    return (
        f"{missing:,} of {count(judged.paths, 'path')} {lack} runs under some conditions; trends, the table at a "
        "glance and correlations leave out such paths"
    )


def shared_houses(judged: JudgedRuns) -> int:
    """In how many houses the paths are, where several are in one, which tell less of other houses; else 0."""
    scenes = texts(judged.table, "scene")
    houses = int(scenes.nunique())
    return 0 if scenes.eq("").any() or houses >= judged.paths else houses


def judged_runs(results: StudyResults) -> JudgedRuns:
    """All runs of the study that were not `not_run`."""
    planned = results.runs.reset_index(drop=True)
    runs = planned[was_run(planned)]
    factors = study_factors(results)
    table = with_levels(_with_outcome(runs), factors)
    return JudgedRuns(table, _cells(table, factors), factors)


def _with_outcome(runs: pd.DataFrame) -> pd.DataFrame:
    failed = ~succeeded(runs).to_numpy(np.bool_)
    ate = numbers(runs, "ate_rmse_m")
    columns = {"failed": failed, "error_m": np.where(failed, np.inf, ate), "place": places([runs])[0]}
    named = {name: texts(runs, name) for name in ("dataset", "path")}
    return with_columns(runs, columns | named | {name: numbers(runs, name) for name in _MEDIANS})


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
