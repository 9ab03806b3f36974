"""The content of a study's report: what was run, what it says, and the figures and tables behind it."""

from slamgym.eval.plots import printable
from slamgym.report.accuracy import accuracy_section, run_threshold, threshold_section
from slamgym.report.causes import causes_section
from slamgym.report.computer import computer_section
from slamgym.report.content import ReportContent, Section
from slamgym.report.correlations import correlations_section
from slamgym.report.facts import study_facts
from slamgym.report.failures import failures_section, trends
from slamgym.report.headlines import headlines, notices
from slamgym.report.judged import judged_runs
from slamgym.report.overview import overview_section, paths_section
from slamgym.report.pairs import comparisons, pairs_section
from slamgym.study.results import StudyResults


def study_content(results: StudyResults) -> ReportContent:
    """Facts, headlines and sections of a study, finished or not, with any factors, also of one run or none at all."""
    judged = judged_runs(results)
    seen, compared = trends(judged), comparisons(judged)
    threshold = run_threshold(judged) if len(judged.table) else None
    sections: list[Section | None] = []
    if threshold is not None:
        sections = [
            overview_section(judged),
            failures_section(judged, seen),
            pairs_section(judged, compared),
            accuracy_section(judged, compared),
            paths_section(judged),
            threshold_section(judged, threshold),
            correlations_section(judged),
            causes_section(judged),
            computer_section(judged),
        ]
    return ReportContent(
        title=printable(results.name),
        description=results.description,
        facts=study_facts(results, judged),
        headlines=headlines(judged, seen, compared, threshold),
        notices=notices(results, judged),
        sections=tuple(section for section in sections if section is not None and _has_content(section)),
    )


def _has_content(section: Section) -> bool:
    return bool(section.sentences or section.tables or section.pictures)
