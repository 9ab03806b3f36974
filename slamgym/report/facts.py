"""What was run: paths, levels, repeats, versions, and what counts as a failure."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd
import yaml

from slamgym.eval.plots import printable
from slamgym.report.columns import numbers, texts
from slamgym.report.judged import FAILED, JudgedRuns, shared_houses
from slamgym.report.levels import SI_UNITS, level_name, title_and_unit
from slamgym.report.wording import count, listed, number
from slamgym.study.folder import StudyFolder
from slamgym.study.results import StudyResults
from slamgym.study.table import was_run
from slamgym.types import FloatArray

MOST_REASONS = 3
MOST_LEVELS = 12


def study_facts(results: StudyResults, judged: JudgedRuns) -> dict[str, Any]:
    """Label -> what was run, in words."""
    runs, table = results.runs, judged.table
    facts = {
        "Runs": _runs_text(results),
        "Not run": "; ".join(_reasons(runs)),
        "Paths": _paths_text(judged),
        **{f"Varied: {_label(name)}": _levels_text(runs[name]) for name in results.factors if name in runs},
        "Fixed": _fixed_text(results),
        "Repeats": _range_text(numbers(runs, "repeat")),
        "Shown to the SLAM": _driven_text(table),
        "Round trips": _round_trips_text(table),
        "SLAM": listed(_distinct(table, "slam")),
        "Versions": ", ".join(_versions(table)),
        "Run": _when_text(table),
        "Computer": listed(_distinct(table, "timing.computer")),
        "A failed run": f"{FAILED}; a run that could not be started does not count",
    }
    return {label: text for label, text in facts.items() if text}


def _runs_text(results: StudyResults) -> str:
    done = len(results.runs)
    missing = "" if done >= results.planned else f" of {results.planned:,} planned; the study is not finished"
    return f"{count(done, 'run')}{missing}"


def _reasons(runs: pd.DataFrame) -> Iterator[str]:
    """How many runs could not be run, and the reasons, the most frequent first."""
    not_run = runs[~was_run(runs)]
    counts = texts(not_run, "failure").value_counts()
    for reason, n in counts.head(MOST_REASONS).items():
        yield f"{count(int(n), 'run')}: {printable(str(reason)) or 'no reason given'}"
    if others := int(counts.iloc[MOST_REASONS:].sum()):
        yield f"{count(others, 'run')}: other reasons"


def _paths_text(judged: JudgedRuns) -> str:
    table = judged.table
    if not len(table):
        return ""
    by_dataset = table.groupby("dataset", sort=False)["place"].nunique()
    total = count(int(by_dataset.sum()), "path")
    inside = f" in {count(houses, 'house')}" if (houses := shared_houses(judged)) else ""
    if len(by_dataset) == 1:
        return f"{total} of {printable(str(by_dataset.index[0]))}{inside}"
    of_each = listed([f"{n:,} of {printable(str(name))}" for name, n in by_dataset.items()])
    return f"{total}: {of_each}{inside}"


def _label(name: str) -> str:
    title, unit = title_and_unit(name)
    return f"{title} ({unit})" if unit else title


def _levels_text(column: "pd.Series[Any]") -> str:
    levels = list(dict.fromkeys(level_name(value) for value in column.drop_duplicates().astype(object)))
    more = f" and {len(levels) - MOST_LEVELS} more" if len(levels) > MOST_LEVELS else ""
    return ", ".join(levels[:MOST_LEVELS]) + more


def _fixed_text(results: StudyResults) -> str:
    """What the study file fixes for all runs; nothing where there is no file."""
    try:
        fixed = yaml.safe_load((StudyFolder(results.folder).study).read_text(encoding="utf-8"))["fixed"]
    except (OSError, ValueError, LookupError, TypeError, yaml.YAMLError):
        return ""
    return ", ".join(_with_unit(name, value) for name, value in fixed.items())


def _with_unit(name: str, value: Any) -> str:
    title, unit = title_and_unit(name)
    return f"{title} {level_name(value)}{f' {unit}' if unit in SI_UNITS else ''}"


def _range_text(repeats: FloatArray) -> str:
    """The number of repeats, told where there are several."""
    known = repeats[np.isfinite(repeats)]
    return f"{known.max():.0f}" if len(known) and known.max() > 1 else ""


def _driven_text(table: pd.DataFrame) -> str:
    frames, seconds, metres = (np.nansum(values) for values in (numbers(table, "frames_fed"), *driven(table)))
    if not frames > 0:
        return ""
    distance = f"{metres / 1000:,.1f} km" if metres >= 1000 else f"{number(metres)} m"
    return f"{distance} in {_time_text(seconds)}, {frames:,.0f} frames fed"


def _time_text(seconds: float) -> str:
    if seconds >= 7200:
        return f"{seconds / 3600:,.1f} h"
    return f"{number(seconds / 60)} min" if seconds >= 120 else f"{number(seconds)} s"


def driven(table: pd.DataFrame) -> tuple[FloatArray, FloatArray]:
    """Duration (s) and distance (m) that the SLAM of each run was shown; of recorded sequences from their frames."""
    frames, fps = numbers(table, "frames_fed"), numbers(table, "fps")
    steps = np.maximum(frames - 1, 0)
    by_frames_s = steps * (1 + np.nan_to_num(numbers(table, "stride"))) / fps
    by_frames_m = steps * numbers(table, "velocity_m_per_frame")
    seconds, metres = numbers(table, "duration_s"), numbers(table, "distance_m")
    return np.where(np.isnan(seconds), by_frames_s, seconds), np.where(np.isnan(metres), by_frames_m, metres)


def _round_trips_text(table: pd.DataFrame) -> str:
    """How many drives come back to their start, and in how many runs a loop was seen to close there."""
    tours, agents = texts(table, "run.reset_options.tour"), texts(table, "agent")
    back = table[tours.isin(("round_trip", "lap")) | agents.isin(("patrol", "lap"))]
    if not len(back):
        return ""
    drives = back["drive_id"].nunique() if "drive_id" in back else back["place"].nunique()
    able = back[texts(back, "loop_closure") != "False"]
    closed = int((numbers(able, "loops_closed") > 0).sum())
    loops = f"; with loop closing on, a loop was seen to close in {closed:,} of {count(len(able), 'run')}"
    return f"{count(drives, 'drive')} back to the start{loops if len(able) else ''}"


def _when_text(table: pd.DataFrame) -> str:
    """The days, in UTC, on which the first and the last run ended."""
    days = sorted(ended[:10] for ended in _distinct(table, "timing.ended"))
    return " to ".join(dict.fromkeys((days[0], days[-1]))) if days else ""


def _distinct(table: pd.DataFrame, column: str) -> list[str]:
    return [printable(text) for text in texts(table, column).drop_duplicates() if text]


def _versions(table: pd.DataFrame) -> Iterator[str]:
    """The versions that all runs share or that they differ in; hashes of houses say nothing to a person."""
    for column in table.columns:
        if str(column).startswith("run.versions.") and "sha256" not in str(column):
            yield f"{str(column).removeprefix('run.versions.')} {' / '.join(_distinct(table, column)) or '-'}"
