"""The comparison of two studies as a report: what differs between them, then what came of it."""

from collections.abc import Iterator
from functools import partial

import numpy as np
import pandas as pd

from slamgym.eval.plots.paired import plot_differences, plot_paired
from slamgym.report.comparison.compared import Compared
from slamgym.report.comparison.differences import SIGNIFICANT, path_changes
from slamgym.report.comparison.headlines import comparison_facts, headlines
from slamgym.report.comparison.metrics import ATE, METRICS, SUCCESS, TIME
from slamgym.report.comparison.pairing import Pairing
from slamgym.report.comparison.tables import levels_table, metrics_table, pairs_tables
from slamgym.report.content import Picture, ReportContent, Section
from slamgym.report.wording import listed, sentence


def comparison_content(compared: Compared) -> ReportContent:
    """Facts, headlines and sections."""
    new, baseline = compared.new, compared.baseline
    return ReportContent(
        title=f"{new.name} against {baseline.name}"
        if new.name != baseline.name
        else f"{new.name}: two studies compared",
        description="Two studies, run by run on the same paths: what is better, what is worse, and what may be chance.",
        facts=comparison_facts(compared),
        headlines=tuple(sentence(text) for text in headlines(compared)),
        sections=(
            _metrics_section(compared),
            _pictures_section(compared.pairing.pairs),
            *_levels_sections(compared.pairing),
            Section("changed", "Paths to look at", tables=pairs_tables(compared)),
        ),
    )


def _metrics_section(compared: Compared) -> Section:
    table = metrics_table(compared.changes)
    return Section("metrics", "What changed", (sentence(_rule()), *_time_note(compared)), (table,))


def _rule() -> str:
    tolerances = [f"{metric.name_text} {metric.tolerance_text}" for metric in METRICS if metric.tolerance is not None]
    return (
        f"a metric has regressed when it is worse by more than its tolerance ({listed(tolerances)}), its whole interval"
        f" is on the worse side, and its corrected p is below {SIGNIFICANT}; a single pair has when its repeats fail"
        f" more often, with a p below {SIGNIFICANT} by Fisher's exact test, corrected for the number of pairs (Holm)"
    )


def _time_note(compared: Compared) -> tuple[str, ...]:
    return (
        ("Time for a frame compares the computers, and what else they had to do, as much as the SLAMs.",)
        if any(change.paths and change.metric is TIME for change in compared.changes)
        else ()
    )


def _pictures_section(pairs: pd.DataFrame) -> Section:
    errors = [pairs[f"{ATE.name}.{side}"].to_numpy(np.float64) for side in ("baseline", "new")]
    success = path_changes(pairs, SUCCESS).to_numpy(np.float64)
    ratio = np.exp(path_changes(pairs, ATE).to_numpy(np.float64))
    scatter = Picture(
        name="compared_pairs",
        title="ATE of each pair",
        caption="A point is a path at one combination of levels, the median of its repeats. Above the diagonal the new "
        "study is worse. Crosses in the grey bands failed in half of the repeats or more.",
        draw=partial(plot_paired, *errors),
    )
    shares = Picture(
        name="compared_success",
        title="Success rate of each path",
        caption="The new success rate minus the baseline's, sorted. Hatched bars are paths that fail more often now.",
        draw=partial(plot_differences, 100 * success, quantity="change of success (points)", worse="below"),
    )
    ratios = Picture(
        name="compared_ate",
        title="ATE of each path",
        caption="The new ATE over the baseline's where both succeeded, sorted; 2 is twice the error. Hatched: worse.",
        draw=partial(plot_differences, ratio, quantity="ATE, new / baseline", worse="above", ratio=True),
    )
    return Section("pairs", "Path by path", pictures=(scatter, shares, *([ratios] if len(ratio) else [])))


def _levels_sections(pairing: Pairing) -> Iterator[Section]:
    tables = [levels_table(pairing.pairs, factor) for factor in pairing.factors]
    if tables:
        told = (
            "Each level over all levels of the other factors. These figures are not judged: with many levels some "
            "differ by chance."
        )
        yield Section("levels", "By level", (told,), tuple(tables))
