"""Runs a study: every run of its plan that has no result yet, on this computer or on a cluster."""

from collections.abc import Callable, Collection, Iterator
from contextlib import closing, contextmanager, nullcontext, suppress
from pathlib import Path

from slamgym.computer import cores
from slamgym.errors import ConfigError, OutputError
from slamgym.interrupt import deferred_interrupt
from slamgym.study.dask_pool import DaskPool
from slamgym.study.drive_work import is_drive
from slamgym.study.execution import Execution, OnProgress
from slamgym.study.folder import Plan, StudyFolder, check_grown, locked, write_plan
from slamgym.study.growing_table import GrowingTable
from slamgym.study.plan import plan_study
from slamgym.study.pool import LocalPool, Pool
from slamgym.study.results import StudyResults
from slamgym.study.spec import StudySpec, factor_names, write_study
from slamgym.study.table import open_study


def run_study(
    spec: StudySpec,
    out: Path,
    workers: int | None = None,
    dask: str | None = None,
    on_progress: OnProgress | None = None,
) -> StudyResults:
    """Run what is missing of the study in the folder `out`, and return all results.

    workers: processes on this computer, by default one a core. dask: address of a cluster's scheduler, whose workers
    are used instead. on_progress: called now and then. A run that cannot be begun, or that ends its worker process
    twice, is a result as well. Everything finished is on the disk: after a Ctrl-C, an error or the end of this process
    the same call goes on.

    Raises OutputError when the folder cannot be written, holds something else or is in use, ConfigError for the study
    or the cluster, KeyboardInterrupt on Ctrl-C.
    """
    check_workers(workers, dask)
    runs = plan_study(spec)
    plan = Plan(spec.name, spec.description, factor_names(spec), tuple(run.run_id for run in runs))
    folder = StudyFolder(Path(out).resolve())
    with locked(folder) as in_place, deferred_interrupt() as interrupted:
        check_grown(folder, plan)
        folder.tidy()
        table = GrowingTable(folder, plan)
        todo = [run for run in runs if run.run_id not in table.done]
        most = min(spec.max_workers or len(todo), len(todo))
        # The workers first: where there are none, the folder stays as it was.
        with closing(_pool(folder, min(workers or cores(), most), dask)) if todo else nullcontext() as pool:
            write_study(spec, folder.study)
            write_plan(folder, plan)
            table.save()
            _drop_frames_but(folder, {run.drive.drive_id for run in todo})
            if pool is not None:
                with _told_how_to_go_on(table, in_place):
                    Execution(folder, table, todo, pool, most, on_progress).run(interrupted, in_place)
        folder.end_frames()
    return open_study(folder.path)


def check_workers(workers: int | None, dask: str | None) -> None:
    """Raise ConfigError unless it is told either how many processes or which cluster, or neither."""
    if workers is not None and dask is not None:
        raise ConfigError(
            f"workers: expected none where a cluster has its own, got {workers}; leave one of the two out"
        )
    if workers is not None and workers < 1:
        raise ConfigError(f"workers: expected at least 1, got {workers}; leave it out for one a core")


def _pool(folder: StudyFolder, workers: int, dask: str | None) -> Pool:
    return LocalPool(workers) if dask is None else DaskPool(dask, folder.path)


def _drop_frames_but(folder: StudyFolder, needed: Collection[str]) -> None:
    """Frames that are damaged are recorded anew."""
    for drive_id in folder.kept_frames():
        if drive_id not in needed or not is_drive(folder.frames(drive_id)):
            folder.drop_frames(drive_id)


@contextmanager
def _told_how_to_go_on(table: GrowingTable, in_place: Callable[[], bool]) -> Iterator[None]:
    """The table is as complete as what it tells of, whatever ends the block, as long as the folder is in its place."""
    try:
        yield
    except OutputError as error:
        if not in_place():
            raise
        done = len(table.folder.finished_runs())
        told = f"{done} of {len(table.plan.run_ids)} runs are done and stay: start it again to go on"
        raise OutputError(f"the study was stopped: {error}; {told}") from None
    finally:
        if in_place():
            table.folder.tidy()
            with suppress(OutputError):  # it is made anew from the run folders
                table.save()
