"""How accurate are the runs? Sorted bars, cumulative curves, and the gap that parts good runs from failed ones."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import pandas as pd

from slamgym.eval.plots import plot_cumulative, plot_sorted_bars
from slamgym.eval.statistics import FailureThreshold, failure_threshold
from slamgym.report.columns import numbers
from slamgym.report.content import DataTable, Picture, Section
from slamgym.report.judged import FAILED, JudgedRuns
from slamgym.report.levels import Factor
from slamgym.report.pairs import furthest, ratio_text
from slamgym.report.shares import LevelComparison
from slamgym.report.wording import number, sentence
from slamgym.types import FloatArray

MOST_THRESHOLD_VALUES = 1000
MOST_FACTORS = 4


def accuracy_section(judged: JudgedRuns, compared: Sequence[LevelComparison]) -> Section:
    """Sorted bars and cumulative curves, of all runs or by the levels of each factor."""
    pictures = [picture for factor in judged.factors[:MOST_FACTORS] for picture in _by_level(judged, factor)]
    if not judged.factors:
        pictures = _pictures({"all runs": judged.cells["error_m"].to_numpy(np.float64)}, "", "all runs")
    told = tuple(sentence(ratio_text(one)) for one in furthest(compared))
    return Section("accuracy", "How accurate are they?", told, pictures=tuple(pictures))


def _by_level(judged: JudgedRuns, factor: Factor) -> list[Picture]:
    groups = dict(iter(judged.cells.groupby(factor.column, observed=True)["error_m"]))
    values = {factor.told(level): groups[level].to_numpy(np.float64) for level in factor.shown}
    return _pictures(values, factor.slug, factor.title)


def _pictures(values: Mapping[str, FloatArray], slug: str, title: str) -> list[Picture]:
    known = {name: errors[~np.isnan(errors)] for name, errors in values.items()}
    ending = f"_{slug}" if slug else ""
    bars = Picture(
        name=f"sorted_bars{ending}",
        title=f"ATE, sorted: {title}",
        caption="A bar is one case: a path at one combination of levels, the median of its repeats. Hatched: failed, "
        f"that is {FAILED}, in half of the repeats or more.",
        draw=partial(plot_sorted_bars, known, counted="cases"),
    )
    curves = Picture(
        name=f"cumulative{ending}",
        title=f"Share with an ATE up to a limit: {title}",
        caption="How many of all cases, each a path at one combination of levels, have at most that ATE. Failed ones "
        "never do: a curve ends at the share that succeeded. Higher and further left is better.",
        draw=partial(plot_cumulative, known, counted="cases"),
    )
    return [bars, curves]


def run_threshold(judged: JudgedRuns) -> FailureThreshold:
    """The gap in the ATE of all runs that have one, whether they were lost or not; of very many, of some at random."""
    ate = numbers(judged.table, "ate_rmse_m")
    if len(ate) > MOST_THRESHOLD_VALUES:
        ate = np.random.default_rng(0).choice(ate, MOST_THRESHOLD_VALUES, replace=False)
    return failure_threshold(ate)


def threshold_section(judged: JudgedRuns, threshold: FailureThreshold) -> Section:
    """The gap, and whether the runs above it are those that lost tracking."""
    ate = numbers(judged.table, "ate_rmse_m")
    sampled = len(ate) > MOST_THRESHOLD_VALUES
    sample = f" (looked for in {MOST_THRESHOLD_VALUES:,} runs drawn at random)" if sampled else ""
    bars = Picture(
        name="threshold",
        title="Is there a gap between good and failed runs?",
        caption="The ATE of every run that has one, sorted, lost runs included; hatched are runs without an ATE. Where "
        "a gap parts two groups, it is shaded, and the dashed line is the failure threshold.",
        draw=partial(
            plot_sorted_bars, {"all runs": ate}, threshold=threshold.threshold.estimate, gap=threshold.gap,
            failed="without an ATE",
        ),
    )  # fmt: skip
    verdict = sentence(_verdict(threshold) + sample)
    return Section("threshold", "Failure threshold", (verdict,), (_agreement(judged, threshold),), (bars,))


def _verdict(threshold: FailureThreshold) -> str:
    if threshold.outcome != "no gap":
        return threshold.verdict
    # Its p-value alone may be small: by SMALLEST_GAP it also has to be wide.
    return f"the {threshold.below:,} runs with an ATE fall into no two groups with a wide gap between them"


def _agreement(judged: JudgedRuns, threshold: FailureThreshold) -> DataTable:
    ate, lost = numbers(judged.table, "ate_rmse_m"), judged.table["failed"].to_numpy(np.bool_)
    groups = {"no ATE": ~np.isfinite(ate)}
    if threshold.found:
        limit = threshold.threshold.estimate
        groups = {f"ATE up to {number(limit)} m": ate <= limit, f"ATE above {number(limit)} m": ate > limit} | groups
    else:
        groups = {"with an ATE": np.isfinite(ate)} | groups
    rows = [
        {"runs": name, "succeeded": int((chosen & ~lost).sum()), "failed": int((chosen & lost).sum())}
        for name, chosen in groups.items()
    ]
    return DataTable(
        name="threshold",
        title="Do the error and the tracking tell the same?",
        caption=f"Failed: {FAILED}. Runs that failed with a small ATE are those that an ATE alone would praise.",
        frame=pd.DataFrame(rows),
    )
