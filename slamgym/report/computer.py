"""What does the computer do to the results? Time for a frame, lateness, frames dropped."""

import numpy as np
import pandas as pd

from slamgym.report.columns import numbers
from slamgym.report.content import DataTable, Section
from slamgym.report.judged import JudgedRuns

ASKED_BY = frozenset({"slam_sync", "busy_processes", "slam"})
"""Factors that make the time for a frame a question of the study."""

TIMES = {
    "time for a frame (ms)": "timing.track_ms_median",
    "its 95 % quantile (ms)": "timing.track_ms_p95",
    "late by (ms)": "timing.late_ms_median",
    "late by at most (ms)": "timing.late_ms_max",
}
"""Heading -> column, of which the median over the runs is shown."""

COUNTS = {"frames fed": "frames_fed", "frames dropped": "frames_dropped", "frames not waited for": "lockstep_overruns"}
"""Heading -> column, of which the sum over the runs is shown."""


def computer_section(judged: JudgedRuns) -> Section | None:
    """Times by level of each factor, in a study that varies how frames are fed, the load or the SLAM; else None."""
    if not any(ASKED_BY & set(factor.names) for factor in judged.factors):
        return None
    rows = [
        {"factor": factor.label, "level": str(level), **_row(runs)}
        for factor in judged.factors
        for level, runs in judged.table.groupby(factor.column, observed=True)
    ]
    table = DataTable(
        name="computer",
        title="Time for a frame, and frames that came late",
        caption="Times are medians over all runs, failed ones included. In real time, frames that come while the SLAM "
        "is busy are dropped in a replay. 'Not waited for': frames after which lock-step went on though the SLAM's "
        "threads still worked. Other computers give other figures.",
        frame=pd.DataFrame(rows),
        formats=dict.fromkeys(TIMES, "{:.1f}"),
    )
    return Section("computer", "What the computer does", tables=(table,))


def _row(runs: pd.DataFrame) -> dict[str, float]:
    times = {heading: _median(runs, column) for heading, column in TIMES.items()}
    counts = {heading: int(np.nansum(numbers(runs, column))) for heading, column in COUNTS.items()}
    return {"runs": len(runs), "failed": int(runs["failed"].sum())} | times | counts


def _median(runs: pd.DataFrame, column: str) -> float:
    values = numbers(runs, column)
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else np.nan
