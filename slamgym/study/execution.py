"""Hands a study's work to the workers, and takes in what comes of it."""

import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, wait
from dataclasses import dataclass

from slamgym.errors import ConfigError, OutputError, SequenceError, SlamError
from slamgym.study.costs import Costs
from slamgym.study.drive_work import keep_facts
from slamgym.study.folder import StudyFolder
from slamgym.study.growing_table import GrowingTable
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.pool import SCHEDULER_GONE, Pool
from slamgym.study.schedule import Schedule, Work, name_of
from slamgym.study.sources import Sources
from slamgym.study.table import not_run_row, run_row
from slamgym.study.work import Outcome, carry_out, write_crashed

LOOK_S = 0.5
"""Between two looks at Ctrl-C and at the cluster."""


@dataclass(frozen=True, slots=True)
class StudyProgress:
    """Runs of the whole study, those of earlier times included. done: with a result. failed: of these, those that are
    no success. not_run: could not be begun. runs_per_minute: since the beginning. seconds_left: about.
    """

    planned: int
    done: int
    failed: int
    not_run: int
    runs_per_minute: float
    seconds_left: float


OnProgress = Callable[[StudyProgress], None]


class Execution:
    """Hands work to the workers and takes in what comes of it, until every run of `todo` has a row in the table."""

    def __init__(
        self,
        folder: StudyFolder,
        table: GrowingTable,
        todo: list[PlannedRun],
        pool: Pool,
        most_workers: int,
        on_progress: OnProgress | None,
    ) -> None:
        self._folder, self._table, self._pool = folder, table, pool
        self._most_workers, self._on_progress = most_workers, on_progress
        rendered = folder.rendered_drives()
        self._schedule = Schedule(todo, rendered)
        self._runs_left = len(todo)
        self._under_way: dict[Future[Outcome], Work] = {}
        self._deaths: Counter[str] = Counter()
        drives = {run.drive.drive_id: run.drive for run in todo if run.drive.drive_id not in rendered}
        self._costs = Costs(todo)
        self._seconds_left = sum(map(self._costs.of, todo)) + sum(map(self._costs.of, drives.values()))
        self._seconds_done = 0.0
        self._sources = Sources(folder.path / "drives")
        self._begin, self._done_before = time.monotonic(), len(table.done)

    def run(self, interrupted: Callable[[], bool], in_place: Callable[[], bool]) -> None:
        """in_place: whether the folder is still where the workers write. Raises OutputError where it is not, or cannot
        be written, SlamError when the cluster is gone, KeyboardInterrupt.
        """
        self._tell()
        while self._runs_left:
            if not in_place():
                raise OutputError(f"{self._folder.path} was moved or removed; start the study again where it is now")
            self._begin_more()
            if not self._under_way:  # all workers of the cluster are gone; others may come
                time.sleep(LOOK_S)
            for future in wait(self._under_way, LOOK_S, FIRST_COMPLETED).done:
                self._conclude(future, self._under_way.pop(future))
            self._table.save_now_and_then()
            self._tell()
            if interrupted():
                raise KeyboardInterrupt

    def _begin_more(self) -> None:
        workers = min(self._pool.capacity(), self._most_workers)
        while len(self._under_way) < workers and (work := self._schedule.next(workers + 1)):
            self._under_way[self._pool.submit(carry_out, work, self._folder.path, self._costs.limit_s(work))] = work

    def _conclude(self, future: Future[Outcome], work: Work) -> None:
        outcome: Outcome | None
        try:
            outcome = future.result()
        except self._pool.lost:
            outcome = self._after_death(work)
        except CancelledError:
            raise SlamError(SCHEDULER_GONE) from None
        if outcome is None:
            self._schedule.again(work)
        elif outcome.cannot_write:
            raise OutputError(outcome.failure)
        elif isinstance(work, PlannedDrive):
            self._drive_done(work, outcome)
        else:
            self._run_done(work, outcome)

    def _after_death(self, work: Work) -> Outcome | None:
        """What comes of work whose worker died: None when it is to be tried again."""
        self._deaths[name_of(work)] += 1
        if self._deaths[name_of(work)] < self._pool.tries:
            return None
        failure = (
            "its worker process ended whenever it was tried: it crashed, or took all of the memory, or longer than "
            f"{self._costs.limit_s(work):.0f} s"
        )
        if isinstance(work, PlannedDrive):
            return Outcome(failure=failure)
        out = self._folder.run(work.run_id)
        try:
            if not out.exists():  # it may have died just after it was done
                write_crashed(work, self._folder.frames(work.drive.drive_id), out, failure)
            return Outcome(row=run_row(out))
        except (ConfigError, SequenceError, SlamError) as error:
            return Outcome(failure=str(error))

    def _drive_done(self, drive: PlannedDrive, outcome: Outcome) -> None:
        self._count(drive)
        if not outcome.failure:
            self._take_in(drive)
            return
        for run in self._schedule.cannot_render(drive):
            self._count(run)
            self._runs_left -= 1
            self._table.add(not_run_row(run, f"the drive could not be rendered: {outcome.failure}"))

    def _take_in(self, drive: PlannedDrive) -> None:
        """A drive has its facts when its frames are known to be of the same scene as all before."""
        frames = self._folder.frames(drive.drive_id)
        try:
            self._sources.check(frames)
        except OutputError:
            self._folder.drop_frames(drive.drive_id)
            raise
        keep_facts(frames, self._folder.drive(drive.drive_id))
        self._schedule.rendered(drive)

    def _run_done(self, run: PlannedRun, outcome: Outcome) -> None:
        self._count(run)
        self._runs_left -= 1
        self._table.add(outcome.row or not_run_row(run, outcome.failure))
        if self._schedule.concluded(run):
            self._folder.drop_frames(run.drive.drive_id)

    def _count(self, work: Work) -> None:
        seconds = self._costs.of(work)
        self._seconds_left -= seconds
        self._seconds_done += seconds

    def _tell(self) -> None:
        if self._on_progress is None:
            return
        table = self._table
        took_s = time.monotonic() - self._begin
        # Before anything is done as it was thought, then at the rate so far.
        rate = self._seconds_done / took_s if self._seconds_done else max(1.0, len(self._under_way))
        self._on_progress(
            StudyProgress(
                planned=len(table.plan.run_ids),
                done=len(table.done),
                failed=table.failed,
                not_run=table.not_run,
                runs_per_minute=60 * (len(table.done) - self._done_before) / took_s,
                seconds_left=self._seconds_left / rate,
            )
        )
