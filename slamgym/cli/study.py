"""`slamgym study`: thousands of runs from one file."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta
from math import isfinite
from pathlib import Path
from typing import Annotated

import tyro
from rich.progress import BarColumn, Progress, TextColumn

from slamgym.cli.study_table import level_table
from slamgym.cli.terminal import notes, printing, results, say, show_table, told_warnings, working
from slamgym.computer import cores
from slamgym.report.page import write_report
from slamgym.report.study import study_content
from slamgym.study.estimate import estimate
from slamgym.study.execution import OnProgress, StudyProgress
from slamgym.study.folder import StudyFolder
from slamgym.study.plan import plan_study, run_count
from slamgym.study.results import StudyResults
from slamgym.study.run import check_workers, run_study
from slamgym.study.spec import StudySpec, read_study
from slamgym.study.table import was_run

PLAIN_S = 30.0
"""Between two lines about the progress where there is no terminal."""
LINES_OF_REASONS = 5


@dataclass(kw_only=True)
class Study:
    """Run what a study file describes, all that is not done yet, and write the report.

    Stop it whenever you like: the same line goes on where it was.

    Example: slamgym study quick --out out/quick
    """

    study: Annotated[
        tyro.conf.Positional[str], tyro.conf.arg(metavar="STUDY", help="a file, or a shipped study's name")
    ]
    out: Path
    """Folder of the study: a new or empty one, or its own, to go on."""
    size: Annotated[str | None, tyro.conf.arg(help="one of the file's sizes; None: the first")] = None
    workers: Annotated[int | None, tyro.conf.arg(help="processes on this computer; None: one a core")] = None
    dask: Annotated[str | None, tyro.conf.arg(metavar="ADDRESS", help="scheduler of a Dask cluster to run on")] = None
    sequences: Annotated[
        tuple[Path, ...], tyro.conf.arg(metavar="DIR...", help="folders of recorded sequences, added to the paths")
    ] = ()
    dry_run: Annotated[bool, tyro.conf.arg(help="only say what would be run, and about how long")] = False

    def __call__(self) -> None:
        check_workers(self.workers, self.dask)
        with told_warnings():
            spec = read_study(self.study, self.size, self.sequences)
        if self.dry_run:
            self._say_what_would_be_run(spec)
            return
        done = self._run(spec)
        with working("writing the report"):
            report = write_report(study_content(done), done, self.out)
        with printing():
            show_table(level_table(done))
            for line in _remarks(done):
                say(results, line)
            say(results, f"report: {report}")

    def _say_what_would_be_run(self, spec: StudySpec) -> None:
        workers = min(self.workers or cores(), spec.max_workers or cores())
        about = estimate(plan_study(spec))
        frames = f"about {about.frames_rendered:,} frames to render; {about.runs} runs over about {about.frames_fed:,}"
        disk = f"about {about.disk_bytes(workers) / 1e9:.1f} GB of disk"
        with printing():
            say(results, f"{spec.name}: {about.drives} drives, {frames} frames")
            say(results, f"about {_duration(about.seconds(workers))} with {workers} workers, {disk}")

    def _run(self, spec: StudySpec) -> StudyResults:
        try:
            with _shown_progress() as show:
                return run_study(spec, self.out, self.workers, self.dask, show)
        except KeyboardInterrupt:
            done = len(StudyFolder(self.out).finished_runs())
            say(notes, f"interrupted; {done} of {run_count(spec)} runs are done and stay: the same line goes on")
            raise


@contextmanager
def _shown_progress() -> Iterator[OnProgress]:
    """A bar on a terminal; elsewhere a line now and then."""
    if not notes.is_terminal:
        yield _plain_lines()
        return
    columns = BarColumn(), TextColumn("{task.description}", markup=False)
    bar = Progress(*columns, console=notes, transient=True, refresh_per_second=2)
    with bar:
        task = bar.add_task("starting", total=None)

        def show(progress: StudyProgress) -> None:
            bar.update(task, description=_told(progress), completed=progress.done, total=progress.planned)

        yield show


def _plain_lines() -> OnProgress:
    next_s = time.monotonic() + PLAIN_S

    def show(progress: StudyProgress) -> None:
        nonlocal next_s
        if time.monotonic() >= next_s:
            next_s = time.monotonic() + PLAIN_S
            say(notes, _told(progress))

    return show


def _told(progress: StudyProgress) -> str:
    counts = [f"{progress.done} of {progress.planned} runs", f"{progress.failed} failed"]
    if progress.not_run:
        counts.append(f"{progress.not_run} could not be run")
    if progress.runs_per_minute:
        counts.append(f"{progress.runs_per_minute:.1f} a minute")
    return f"{', '.join(counts)}, about {_duration(progress.seconds_left)} left"


def _duration(seconds: float) -> str:
    return str(timedelta(seconds=round(seconds))) if isfinite(seconds) else "?"


def _remarks(done: StudyResults) -> Iterator[str]:
    reasons = done.runs["failure"][~was_run(done.runs)].value_counts()
    for failure, count in reasons.head(LINES_OF_REASONS).items():
        yield f"{count} runs could not be run, and are tried again by the same line: {failure}"
    if more := reasons.iloc[LINES_OF_REASONS:].sum():
        yield f"and {more} more runs could not be run, see the report"
