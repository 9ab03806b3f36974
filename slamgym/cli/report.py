"""`slamgym report`: what a study says, and what became of it since another one."""

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from slamgym.cli.terminal import notes, printing, results, say, told_warnings, working
from slamgym.errors import ConfigError
from slamgym.report.comparison import compare_studies
from slamgym.report.content import ReportContent
from slamgym.report.page import check_report_folder, write_report
from slamgym.report.study import study_content
from slamgym.study.results import StudyResults
from slamgym.study.table import open_study

EXIT_REGRESSION = 1


@dataclass(kw_only=True)
class Report:
    """Write the report of a study, also while it runs; with a baseline, the study compared with it on the same paths.

    Example: slamgym report out/new out/before --fail-on-regression
    """

    study: Annotated[tyro.conf.Positional[Path], tyro.conf.arg(metavar="STUDY", help="folder of a study")]
    baseline: Annotated[
        tyro.conf.Positional[Path | None], tyro.conf.arg(metavar="[BASELINE]", help="folder of the study before")
    ] = None
    out: Annotated[
        Path | None, tyro.conf.arg(help="folder to write to; None: the study's, or compare-BASELINE in it")
    ] = None
    fail_on_regression: Annotated[
        bool, tyro.conf.arg(help="exit with 1 when something became worse, with 2 when that cannot be judged")
    ] = False

    def __call__(self) -> None:
        if self.fail_on_regression and self.baseline is None:
            raise ConfigError("--fail-on-regression: expected a baseline to compare with, got none: name its folder")
        with told_warnings():
            study = _opened(self.study)
            if self.baseline is None:
                self._report(study)
            else:
                self._compare(study, _opened(self.baseline))

    def _report(self, study: StudyResults) -> None:
        folder = self.out or self.study
        check_report_folder(folder, study)
        with working("writing the report"):
            content = study_content(study)
            page = write_report(content, study, folder)
        with printing():
            _say(content, page)

    def _compare(self, study: StudyResults, baseline: StudyResults) -> None:
        folder = self.out or self.study / f"compare-{baseline.folder.resolve().name}"
        check_report_folder(folder, study)
        with working("comparing"):
            comparison = compare_studies(study, baseline)
            page = write_report(comparison.content, study, folder)
        with printing():
            _say(comparison.content, page)
        if self.fail_on_regression and comparison.has_regressed:
            sys.exit(EXIT_REGRESSION)
        if self.fail_on_regression and comparison.not_judged:
            raise ConfigError(f"--fail-on-regression: cannot judge: {comparison.not_judged[0]}")


def _opened(folder: Path) -> StudyResults:
    """The study of a folder; raises ConfigError where there is none, or nothing to report of it."""
    if not folder.is_dir():
        raise ConfigError(f"{folder}: expected the folder of a study, got no folder; name what `slamgym study` wrote")
    study = open_study(folder)
    if study.runs.empty:
        raise ConfigError(f"{folder}: expected a study with finished runs, got none of {study.planned}; wait for some")
    if (done := len(study.runs)) < study.planned:
        say(notes, f"slamgym: {folder}: not finished, {done} of {study.planned} runs have a result", style="yellow")
    return study


def _say(content: ReportContent, page: Path) -> None:
    for sentence in (*content.notices, *content.headlines):
        say(results, sentence)
    say(results, f"report: {page}")
