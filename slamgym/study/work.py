"""One piece of a study's work, as a worker does it: whatever happens, what comes back is plain data."""

import math
import signal
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from slamgym.errors import OutputError, SlamgymError
from slamgym.files import draft
from slamgym.run_record import write_record
from slamgym.study.drive_work import load_drive, record_planned_drive
from slamgym.study.folder import StudyFolder
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.schedule import Work
from slamgym.study.slam_work import config_of, run_planned, write_planned
from slamgym.study.table import run_row

CRASHED = {
    "status": "crashed",
    "success": False,
    "end": "slam_gone",
    "completion": 0.0,
    "frames_fed": 0,
    "frames_tracked": 0,
    "loss_count": 0,
    "losses": [],
    "loss_causes": {},
}
"""The results of a run that ended its worker process whenever it was tried."""


class Outcome(NamedTuple):
    """row: of a run that has its folder now. failure: why the work cannot be done. cannot_write: nor can any other."""

    row: dict[str, Any] | None = None
    failure: str = ""
    cannot_write: bool = False


def carry_out(work: Work, folder: Path, limit_s: float) -> Outcome:
    """Render the drive, or run the SLAM, into the study's folder; what is there already is not done again.

    The process is ended by SIGALRM when it takes longer than `limit_s`: it may hang where nothing else ends it.
    """
    place = StudyFolder(folder)
    with _time_limit(limit_s), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a thousand runs nobody reads them
        try:
            return _record(work, place) if isinstance(work, PlannedDrive) else _run(work, place)
        except OutputError as error:
            return Outcome(failure=str(error), cannot_write=True)
        except SlamgymError as error:
            return Outcome(failure=str(error))
        except Exception as error:  # a failed run is a result, whatever it failed with
            return Outcome(failure=f"{type(error).__name__}: {error}".splitlines()[0])


def _record(drive: PlannedDrive, folder: StudyFolder) -> Outcome:
    frames = folder.frames(drive.drive_id)
    if not frames.exists():
        record_planned_drive(drive, frames)
    return Outcome()


def _run(run: PlannedRun, folder: StudyFolder) -> Outcome:
    out = folder.run(run.run_id)
    try:
        if not out.exists():
            run_planned(run, folder.frames(run.drive.drive_id), out)
    except OutputError:
        if not out.exists():  # a cluster may have done it twice
            raise
    return Outcome(row=run_row(out))


def write_crashed(run: PlannedRun, drive_folder: Path, out: Path, failure: str) -> None:
    """The folder of a run that ended its worker whenever it was tried, as far as it is known, so that it can be
    repeated.

    Raises what `run_planned` raises.
    """
    config = config_of(run, load_drive(drive_folder))
    with draft(out) as place:
        place.mkdir()
        write_record(place, config, {**CRASHED, "failure": failure})
        write_planned(place, run)


@contextmanager
def _time_limit(limit_s: float) -> Iterator[None]:
    signal.alarm(math.ceil(limit_s))
    try:
        yield
    finally:
        signal.alarm(0)
