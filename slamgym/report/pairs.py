"""Level against level on the same paths."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd

from slamgym.eval.plots import plot_level_pairs
from slamgym.report.content import DataTable, Picture, Section
from slamgym.report.judged import JudgedRuns
from slamgym.report.levels import Factor
from slamgym.report.shares import FEWEST_PATHS, LevelComparison, compare_levels
from slamgym.report.wording import confidence, listed, percent, percent_range, ratio_range, sentence

MOST_LINES = 20_000


def comparisons(judged: JudgedRuns) -> list[LevelComparison]:
    """Each level of each factor against the factor's first one."""
    return [one for factor in judged.factors for one in compare_levels(judged, factor)]


def pairs_section(judged: JudgedRuns, compared: Sequence[LevelComparison]) -> Section:
    """A table of all comparisons, and the ATE of the same paths at all levels of each factor."""
    return Section(
        "levels",
        "Level against level",
        sentences=tuple(sentence(difference_text(one)) for one in compared if len(one.factor.levels) == 2),
        tables=(_table(compared),) if compared else (),
        pictures=tuple(picture for factor in judged.factors if (picture := _picture(judged, factor)) is not None),
    )


def difference_text(one: LevelComparison) -> str:
    """How failures differ between the two levels, in words."""
    level, counts = one.factor.at(one.level), counts_text(one)
    if one.paths < FEWEST_PATHS:
        return f"{counts}: too few paths ({one.paths}) to tell whether that would hold for others"
    size = percent(one.difference.estimate).removesuffix(" %")
    ends = percent_range(one.difference).removesuffix(" %")
    interval = f"difference {size} percentage points, {confidence(one.difference)} {ends}"
    over = ", over all levels of the other factors" if one.others else ""
    but = f"; it depends on the {listed(one.depends_on)}" if one.depends_on else ""
    if not one.differs:
        chance = f"no difference seen that could not be chance with {one.paths:,} paths"
        return f"{counts}{over}: {chance} ({interval}){but}"
    word = "more" if one.difference.estimate > 0 else "fewer"
    return f"{word} failures {level}: {counts}{over} ({interval}){but}"


def counts_text(one: LevelComparison) -> str:
    """How many of the paired runs failed at both levels."""
    level, base = one.factor.at(one.level), one.factor.at(one.base)
    return f"{level}, {one.failed:,} of {one.runs:,} runs failed; {base}, {one.base_failed:,} of {one.base_runs:,}"


def ratio_text(one: LevelComparison) -> str:
    """How the ATE of the successful runs differs between the two levels, in words."""
    level, base = one.factor.at(one.level), one.factor.at(one.base)
    where = f"on the {one.both_paths} paths where both succeeded"
    ratio, interval = f"{one.ratio.estimate:.2f}", f"{confidence(one.ratio)} {ratio_range(one.ratio)}"
    if one.both_paths < FEWEST_PATHS:
        return f"too few paths where runs {level} and {base} both succeeded ({one.both_paths}) to compare their ATE"
    if not one.ratio_differs:
        seen = "no difference seen that could not be chance in the ATE"
        return f"{seen} {level} and {base}, {where} (ratio {ratio}, {interval})"
    return f"the ATE {level} is {ratio} times that {base}, {where} ({interval})"


def furthest(compared: Sequence[LevelComparison]) -> list[LevelComparison]:
    """Of each factor the level furthest from the first that has enough paths to compare the ATE on, or the last."""
    by_factor: dict[Factor, LevelComparison] = {}
    for one in compared:
        if one.both_paths >= FEWEST_PATHS or one.factor not in by_factor:
            by_factor[one.factor] = one
    return list(by_factor.values())


def _table(compared: Sequence[LevelComparison]) -> DataTable:
    return DataTable(
        name="levels",
        title="Each level against the first",
        caption="On the same paths, at the same levels of all other factors. Difference: share of failed runs of the "
        "level minus that of the base, in percentage points. Ratio: ATE of the level over that of the base, geometric "
        "mean over the paths where both succeeded, and so not of the hard ones. The intervals hold at 95 % for all "
        "levels of a factor together, and are not corrected for the number of factors.",
        frame=pd.DataFrame([_row(one) for one in compared]),
        formats={
            "difference (points)": "{:+.1f}", "difference from": "{:+.1f}", "difference to": "{:+.1f}",
            "ATE ratio": "{:.2f}", "ratio from": "{:.2f}", "ratio to": "{:.2f}",
        },
    )  # fmt: skip


def _row(one: LevelComparison) -> dict[str, object]:
    difference, ratio = one.difference, one.ratio
    return {
        "factor": one.factor.label,
        "level": one.level,
        "base": one.base,
        "paths": one.paths,
        "failed": f"{one.failed} of {one.runs}",
        "base failed": f"{one.base_failed} of {one.base_runs}",
        "difference (points)": 100 * difference.estimate,
        "difference from": 100 * difference.low,
        "difference to": 100 * difference.high,
        "paths where both succeeded": one.both_paths,
        "ATE ratio": ratio.estimate,
        "ratio from": ratio.low,
        "ratio to": ratio.high,
    }


def _picture(judged: JudgedRuns, factor: Factor) -> Picture | None:
    keys = ["place", *(column for column in judged.columns if column != factor.column)]
    cells = judged.cells[judged.cells[factor.column].isin(factor.shown)]
    lines = cells.set_index([*keys, factor.column])["error_m"].unstack().reindex(columns=list(factor.shown))
    complete = lines[~lines.isna().any(axis=1)].to_numpy(np.float64)[:MOST_LINES]
    if not len(complete):
        return None
    others = "paths" if len(judged.factors) == 1 else "paths at levels of the other factors"
    return Picture(
        name=f"levels_{factor.slug}",
        title=f"The same paths at each level of {factor.title}",
        caption="A line for each path, at each combination of the other factors: its ATE, the median of its repeats in "
        "which a failed one counts as worse than any other. Failures lie in the band at the top. Levels differ where "
        "the lines lean, not where they spread.",
        draw=partial(plot_level_pairs, complete, factor.shown, by=factor.label, paths=others),
    )
