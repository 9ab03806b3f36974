"""Two studies on the same paths: what became better, what worse, and whether that is more than chance."""

from dataclasses import dataclass

from slamgym.report.comparison.broken import broken_pairs, regressed_pairs
from slamgym.report.comparison.compared import Compared, pair_names
from slamgym.report.comparison.content import comparison_content
from slamgym.report.comparison.differences import MetricChange, metric_changes
from slamgym.report.comparison.doubts import reasons_not_to_judge
from slamgym.report.comparison.pairing import pair_studies
from slamgym.report.comparison.settings import SettingChange, setting_changes
from slamgym.report.content import ReportContent
from slamgym.study.results import StudyResults

__all__ = ["Comparison", "MetricChange", "SettingChange", "compare_studies"]


@dataclass(frozen=True, slots=True, eq=False)
class Comparison:
    """content: the report. settings: what differs in what was asked for. changes: each metric in both studies.

    broken: names of the paths, with their levels, of which all repeats succeeded before and most fail now; with few
    repeats some of them by chance, so they are told and are no regression. regressed_pairs: names of those whose
    repeats fail more often by more than chance, see `.broken`. not_judged: why it means nothing when nothing regressed:
    what was expected, what came, what to do; empty where it does mean something.
    """

    content: ReportContent
    settings: tuple[SettingChange, ...]
    changes: tuple[MetricChange, ...]
    broken: tuple[str, ...]
    regressed_pairs: tuple[str, ...]
    not_judged: tuple[str, ...]

    @property
    def regressions(self) -> tuple[MetricChange, ...]:
        """The metrics that are worse by more than a tolerance and more than chance, see `.differences`; `str` of one
        says it in a line.
        """
        return tuple(change for change in self.changes if change.is_regression)

    @property
    def has_regressed(self) -> bool:
        """Whether a metric is worse, or single pairs are."""
        return bool(self.regressions or self.regressed_pairs)


def compare_studies(new: StudyResults, baseline: StudyResults) -> Comparison:
    """The new study against the baseline, on the paths and at the levels that both have.

    Raises ConfigError where they have none in common, or where one of them has no finished run.
    """
    pairing = pair_studies(new, baseline)
    settings = setting_changes(pairing.runs["new"], pairing.runs["baseline"])
    pairs = pairing.pairs
    compared = Compared(
        new, baseline, pairing, settings, metric_changes(pairs), broken_pairs(pairs), regressed_pairs(pairs)
    )
    return Comparison(
        content=comparison_content(compared),
        settings=settings,
        changes=compared.changes,
        broken=pair_names(compared.broken, pairing.factors),
        regressed_pairs=pair_names(compared.regressed, pairing.factors),
        not_judged=tuple(reasons_not_to_judge(compared)),
    )
