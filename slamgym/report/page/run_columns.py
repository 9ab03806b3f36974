"""The table of all runs as the page's script reads it: by columns, words once, so that 100,000 rows are a few MB."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from slamgym.eval.plots import printable
from slamgym.report.causes import PREFIX, told
from slamgym.report.levels import level_name, title_and_unit
from slamgym.report.page.tables import NOTHING, shown_value
from slamgym.study.results import StudyResults
from slamgym.study.table import NOT_RUN, succeeded, was_run
from slamgym.types import IntArray

FIGURES = {
    "completion": ("completion (%)", 1),
    "loss_count": ("losses", 0),
    "ate_rmse_m": ("ATE (m)", 4),
}
"""Column of the runs' table -> its heading here, and the decimals of its values."""

MORE_FIGURES = {
    "rpe_second_trans_rmse_m": ("RPE over 1 s (m)", 4),
    "time_to_first_loss_s": ("first loss (s)", 1),
    "loops_closed": ("loops closed", 0),
}
"""Those for which there may be no room on the screen, at the table's right end."""

OUTCOMES = {
    "lost": "failed: lost at the end",
    "init_failed": "failed: never tracked",
    "crashed": "failed: crashed",
    "timeout": "failed: timeout",
    NOT_RUN: "not run",
}
"""Status -> the outcome in words, for those that need no other column."""


class RunColumn(NamedTuple):
    """One column. words: all that it says, in the order to sort by, None for figures. values: of each run the number of
    its word, or its figure; None where there is none. decimals: of figures. filtered: whether one may pick a word.
    """

    heading: str
    values: list[Any]
    words: list[str] | None = None
    decimals: int = 0
    filtered: bool = False

    def shown(self, row: int) -> str:
        """What the table says of the run in this row, as text."""
        value = self.values[row]
        if value is None:
            return NOTHING
        return f"{value:.{self.decimals}f}" if self.words is None else self.words[value]


def runs_data(runs: pd.DataFrame, columns: Sequence[RunColumn]) -> dict[str, Any]:
    """What the page's script needs for the table: in JSON types, every text printable.

    "drive" and "rest" make a run's id, with a slash between; "kind" is how each is to be repeated, see `run_kinds`.
    """
    ids = [str(run_id).partition("/") for run_id in runs["run_id"]]
    return {
        "drive": _words_of("drive", [drive for drive, _, _ in ids])._asdict(),
        "rest": _words_of("rest", [rest for _, _, rest in ids])._asdict(),
        "kind": _words_of("kind", run_kinds(runs))._asdict(),
        "columns": [column._asdict() for column in columns],
        "nothing": NOTHING,
    }


def run_columns(results: StudyResults) -> list[RunColumn]:
    """What the table shows of each run: what it came to before what was varied, whatever the number of factors."""
    runs = results.runs
    varied = {name for name in ("dataset", "repeat") if name in runs and runs[name].nunique() > 1}
    return [
        _words_of("path", runs["path"]),
        _words_of("outcome", outcomes(runs), filtered=True),
        *_figures(runs, FIGURES),
        _words_of("causes of losses", loss_causes(runs)),
        *(_levels_of(name, runs[name]) for name in results.factors if name in runs),
        *(_words_of(name, runs[name]) for name in ("repeat",) if name in varied),
        *(_words_of(name, runs[name], filtered=True) for name in ("dataset",) if name in varied),
        *_figures(runs, MORE_FIGURES),
    ]


def run_kinds(runs: pd.DataFrame) -> list[str]:
    """Of each run "drive", "sequence" where its images were recorded by somebody, "none" where it has no folder."""
    recorded = runs["sequence"].notna() if "sequence" in runs else pd.Series(False, runs.index)
    return list(np.select([~was_run(runs), recorded], ["none", "sequence"], "drive"))


def outcomes(runs: pd.DataFrame) -> list[str]:
    """How each run ended, in words: a colour alone would not do."""
    status = runs["status"].astype(str)
    losses = pd.to_numeric(runs["loss_count"], errors="coerce") if "loss_count" in runs else pd.Series(0, runs.index)
    words = status.map(OUTCOMES).fillna("failed: " + status)
    words[status == "ok"] = "failed: tracked too little"
    words[(status == "ok") & (losses > 0)] = "failed: lost for a time"
    words[succeeded(runs)] = "success"
    return list(words)


def loss_causes(runs: pd.DataFrame) -> list[str | None]:
    """The causes of each run's losses, the most frequent first; None for a run without."""
    names = [name for name in runs if str(name).startswith(PREFIX)]
    counts = runs[names].apply(pd.to_numeric, errors="coerce").fillna(0).to_numpy(dtype=np.int64)
    words = [told(str(name)) for name in names]
    texts: list[str | None] = [None] * len(runs)
    for row in np.flatnonzero(counts.any(axis=1)):
        order = [k for k in np.argsort(-counts[row], kind="stable") if counts[row, k]]
        texts[row] = ", ".join(words[k] if counts[row, k] == 1 else f"{words[k]} ({counts[row, k]})" for k in order)
    return texts


def _words_of(heading: str, values: "Sequence[Any] | pd.Series[Any]", *, filtered: bool = False) -> RunColumn:
    """A column of words, which may be numbers; None where there is none."""
    codes, found = pd.factorize(pd.Series(values, dtype=object), use_na_sentinel=True)
    return _column(heading, codes, [shown_value(value) for value in found], filtered=filtered)


def _levels_of(factor: str, values: "pd.Series[Any]") -> RunColumn:
    """A factor's levels: to leave a parameter at its default is one, too."""
    title, unit = title_and_unit(factor)
    codes, found = pd.factorize(values, use_na_sentinel=False)
    return _column(f"{title} ({unit})" if unit else title, codes, [level_name(value) for value in found], filtered=True)


def _column(heading: str, codes: IntArray, found: list[str], *, filtered: bool) -> RunColumn:
    """codes: of each run the number of its word in `found`, -1 for none. Words that look the same are one."""
    words = sorted(set(found), key=_sort_key)
    place = {word: number for number, word in enumerate(words)}
    values = [None if code < 0 else place[found[code]] for code in codes.tolist()]
    return RunColumn(printable(heading), values, words, filtered=filtered)


def _sort_key(word: str) -> tuple[int, float, str]:
    """Numbers before words."""
    try:
        return 0, float(word), word
    except ValueError:
        return 1, 0.0, word


def _figures(runs: pd.DataFrame, shown: Mapping[str, tuple[str, int]]) -> list[RunColumn]:
    return [_figure(runs[name], name, *style) for name, style in shown.items() if name in runs]


def _figure(values: "pd.Series[Any]", name: str, heading: str, decimals: int) -> RunColumn:
    numbers = pd.to_numeric(values, errors="coerce").to_numpy(dtype=np.float64)
    if name == "completion":
        # Rounded down: "100.0" is all.
        numbers = np.floor(1e3 * numbers + 1e-9) / 10
    known = np.isfinite(numbers)
    rounded = np.round(numbers, decimals).tolist()
    return RunColumn(heading, [v if ok else None for v, ok in zip(rounded, known, strict=True)], None, decimals)
