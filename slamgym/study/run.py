"""Runs a study: every run of its plan that has no result yet, on this computer or on a cluster."""

from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path

from slamgym.errors import ConfigError, OutputError
from slamgym.interrupt import deferred_interrupt
from slamgym.study.dask_pool import DaskPool
from slamgym.study.execution import Execution, OnProgress
from slamgym.study.folder import Plan, StudyFolder, check_grown, locked, write_plan
from slamgym.study.growing_table import GrowingTable
from slamgym.study.plan import plan_study
from slamgym.study.planned import PlannedRun
from slamgym.study.pool import LocalPool, Pool, cores
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
    if workers is not None and (workers < 1 or dask is not None):
        raise ConfigError(f"workers: expected at least 1, and none where a cluster has its own, got {workers}")
    runs = plan_study(spec)
    plan = Plan(spec.name, spec.description, factor_names(spec), tuple(run.run_id for run in runs))
    folder = StudyFolder(Path(out).resolve())
    with locked(folder), deferred_interrupt() as interrupted:
        check_grown(folder, plan)
        write_study(spec, folder.study)
        write_plan(folder, plan)
        folder.tidy()
        table = GrowingTable(folder, plan)
        todo = [run for run in runs if run.run_id not in table.done]
        _drop_unneeded_frames(folder, todo)
        if todo:
            most = min(spec.max_workers or len(todo), len(todo))
            with _told_how_to_go_on(table), closing(_pool(folder, min(workers or cores(), most), dask)) as pool:
                Execution(folder, table, todo, pool, most, on_progress).run(interrupted)
        folder.end_frames()
    return open_study(folder.path)


def _pool(folder: StudyFolder, workers: int, dask: str | None) -> Pool:
    return LocalPool(workers) if dask is None else DaskPool(dask, folder.path)


def _drop_unneeded_frames(folder: StudyFolder, todo: Iterable[PlannedRun]) -> None:
    needed = {run.drive.drive_id for run in todo}
    for drive_id in folder.kept_frames() - needed:
        folder.drop_frames(drive_id)


@contextmanager
def _told_how_to_go_on(table: GrowingTable) -> Iterator[None]:
    """The table is as complete as what it tells of, whatever ends the block."""
    try:
        yield
    except OutputError as error:
        done = len(table.folder.finished_runs())
        told = f"{done} of {len(table.plan.run_ids)} runs are done and stay: start it again to go on"
        raise OutputError(f"the study was stopped: {error}; {told}") from None
    finally:
        table.folder.tidy()
        with suppress(OutputError):  # it is made anew from the run folders
            table.save()
