"""Why was tracking lost? The causes of all losses, level by level."""

from functools import partial

import numpy as np
import pandas as pd

from slamgym.eval.plots import plot_stacked_bars, printable
from slamgym.report.columns import numbers
from slamgym.report.content import DataTable, Picture, Section
from slamgym.report.judged import JudgedRuns
from slamgym.report.levels import Factor
from slamgym.report.wording import count, listed, percent, sentence

PREFIX = "loss_causes."
WORDS = {
    "dark": "darkness",
    "frame_gap": "gap between frames",
    "no_depth": "lack of depth",
    "fading": "fading points",
    "crashed": "crash of the SLAM",
    "timeout": "time-out of the SLAM",
}
"""Cause -> its noun, where that is another word."""

MOST_CAUSES = 8
MOST_FACTORS = 4


def cause_counts_of(table: pd.DataFrame) -> "pd.Series[float]":
    """Cause -> number of losses in the runs of the table, the most frequent first; causes without a loss left out."""
    columns = [column for column in map(str, table.columns) if column.startswith(PREFIX)]
    counts = {told(column): float(np.nansum(numbers(table, column))) for column in columns}
    series = pd.Series(counts, dtype=np.float64)
    return series[series > 0].sort_values(ascending=False, kind="stable")


def told(column: str) -> str:
    """A cause in words: "few keypoints"."""
    cause = column.removeprefix(PREFIX)
    return WORDS.get(cause, printable(cause.replace("_", " ")))


def causes_text(judged: JudgedRuns) -> str:
    """The most frequent cause, in words; without a loss, that."""
    counts = cause_counts_of(judged.table)
    if not len(counts):
        return (
            "no loss was told a cause" if np.nansum(numbers(judged.table, "loss_count")) else "tracking was never lost"
        )
    total, unknown = int(counts.sum()), int(counts.get("unknown", 0))
    counts = counts.drop("unknown", errors="ignore")
    if not len(counts):
        return f"no cause stood out in any of the {total:,} losses"
    most, aside = int(counts.iloc[0]), f"; in {unknown:,} nothing stood out" if unknown else ""
    first = [str(cause) for cause, n in counts.items() if n == most]
    if len(first) > 1:
        return f"the most frequent causes of losses are {listed(first)}: {most:,} each of {total:,}"
    share = f"{most:,} of {total:,} ({percent(most / total)})"
    return f"the most frequent cause of losses is {first[0]}: {share}{_on_paths(judged, first[0])}{aside}"


def _on_paths(judged: JudgedRuns, cause: str) -> str:
    """Many losses of few paths tell of these paths rather than of the cause."""
    has_it = np.zeros(len(judged.table), dtype=np.bool_)
    for column in (str(name) for name in judged.table.columns if str(name).startswith(PREFIX)):
        if told(column) == cause:
            has_it |= numbers(judged.table, column) > 0
    return f", on {judged.table.loc[has_it, 'place'].nunique():,} of {count(judged.paths, 'path')}"


def causes_section(judged: JudgedRuns) -> Section | None:
    """A table of causes by level, and stacked bars; None where nothing was lost."""
    counts = cause_counts_of(judged.table)
    if not len(counts):
        return None
    pictures = [_picture(judged, factor, list(counts.index)) for factor in judged.factors[:MOST_FACTORS]]
    return Section(
        "causes",
        "Why was tracking lost?",
        sentences=(
            sentence(causes_text(judged)),
            "A cause is what stood out in what the SLAM was given when the loss began; a rule that holds is no proof.",
        ),
        tables=(_table(judged, counts),),
        pictures=tuple(pictures) or (_picture(judged, None, list(counts.index)),),
    )


def _table(judged: JudgedRuns, counts: "pd.Series[float]") -> DataTable:
    shares = (counts / counts.sum()).to_numpy()
    frame = pd.DataFrame({"cause": counts.index, "losses": counts.to_numpy(int), "share": shares})
    for factor in judged.factors:
        for level in factor.shown:
            here = cause_counts_of(judged.table[judged.table[factor.column] == level]).reindex(counts.index)
            frame[factor.told(level)] = here.fillna(0).to_numpy(int)
    return DataTable(
        name="causes",
        title="Causes of losses",
        caption="How many losses of all runs each cause had, and at each level, over all levels of the other factors. "
        "A run can be lost several times.",
        frame=frame,
        formats={"share": "{:.1%}"},
    )


def _picture(judged: JudgedRuns, factor: Factor | None, causes: list[str]) -> Picture:
    levels = factor.shown if factor else ("all runs",)
    groups = [judged.table[judged.table[factor.column] == level] if factor else judged.table for level in levels]
    parts = pd.DataFrame([cause_counts_of(runs) / len(runs) for runs in groups]).reindex(columns=causes).fillna(0.0)
    shown = {cause: parts[cause].to_numpy(np.float64) for cause in causes[:MOST_CAUSES]}
    if len(causes) > MOST_CAUSES:
        shown["other causes"] = parts[causes[MOST_CAUSES:]].sum(axis=1).to_numpy(np.float64)
    return Picture(
        name=f"causes_{factor.slug}" if factor else "causes",
        title=f"Causes of losses by {factor.title}" if factor else "Causes of losses",
        caption="The length of a bar is the number of losses a run, made up of their causes.",
        draw=partial(plot_stacked_bars, shown, levels, by=factor.label if factor else ""),
    )
