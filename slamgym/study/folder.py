"""The folder of a study: where each thing lies, who may write there, and what a killed study left behind.

study.yaml       the study, as it was resolved
plan.json        name, description, factors, and the ids of all runs in their order
runs/RUN_ID      a run folder for each finished run
drives/DRIVE_ID  what is kept of each drive: facts and views
frames/DRIVE_ID  a drive with its frames, as long as runs need them
runs.parquet     the table of all runs, see `slamgym.study.table`
study.lock       locked by the process that runs the study: its id, host, and since when
damaged/         what could not be read when the study was started again, as after a power cut
"""

import fcntl
import json
import os
import shutil
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from datetime import datetime
from itertools import chain, count
from pathlib import Path

from slamgym.errors import ConfigError, OutputError
from slamgym.files import write_atomically


@dataclass(frozen=True, slots=True)
class Plan:
    """What is known of a study without its file: run_ids, in the order of the plan, drives after drives."""

    name: str
    description: str
    factors: tuple[str, ...]
    run_ids: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class StudyFolder:
    """Where the parts of a study lie below `path`."""

    path: Path

    @property
    def study(self) -> Path:
        return self.path / "study.yaml"

    @property
    def plan(self) -> Path:
        return self.path / "plan.json"

    @property
    def table(self) -> Path:
        return self.path / "runs.parquet"

    @property
    def lock(self) -> Path:
        return self.path / "study.lock"

    def run(self, run_id: str) -> Path:
        return self.path / "runs" / run_id

    def drive(self, drive_id: str) -> Path:
        return self.path / "drives" / drive_id

    def frames(self, drive_id: str) -> Path:
        return self.path / "frames" / drive_id

    def finished_runs(self) -> set[str]:
        """Ids of the runs that have their folder, with results in it."""
        runs = self.path / "runs"
        return {run_id for run_id in self._run_folders() if _has_content(f"{runs}/{run_id}/episode.json")}

    def _run_folders(self) -> set[str]:
        runs = self.path / "runs"
        return {f"{drive_id}/{run}" for drive_id in _folders(runs) for run in _folders(runs / drive_id)}

    def kept_frames(self) -> set[str]:
        """Ids of the drives whose frames are there."""
        return set(_folders(self.path / "frames"))

    def rendered_drives(self) -> set[str]:
        """Ids of the drives whose frames are there, and their facts."""
        return {drive_id for drive_id in self.kept_frames() if self.drive(drive_id).exists()}

    def tidy(self) -> None:
        """Remove what a killed study had begun to write; only for who holds the lock."""
        runs = self.path / "runs"
        places = [self.path / "frames", self.path / "drives", runs, *(runs / name for name in _folders(runs))]
        # A report may be written into the same folder meanwhile.
        own = [self.path.glob(f".{file.name}-*") for file in (self.study, self.plan, self.table)]
        for drafted in chain(*own, *(place.glob(".*-*") for place in places if place.is_dir())):
            shutil.rmtree(drafted, ignore_errors=True)

    def set_damaged_aside(self) -> None:
        """What is in the way of runs and of the table and is none; only for who holds the lock. Raises OutputError."""
        for run_id in self._run_folders() - self.finished_runs():
            self.set_aside(self.run(run_id))
        if self.table.is_dir():
            self.set_aside(self.table)

    def set_aside(self, damaged: Path) -> None:
        """Move something of the study to where nothing looks for it; raises OutputError."""
        place = self.path / "damaged" / damaged.relative_to(self.path)
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            damaged.rename(next(free for free in _numbered(place) if not free.exists()))
        except OSError as error:
            raise OutputError(f"cannot set {damaged} aside: {error.strerror}; remove it") from None

    def end_frames(self) -> None:
        """Nobody needs frames any more."""
        with suppress(OSError):  # not empty, or there never were any
            (self.path / "frames").rmdir()

    def drop_frames(self, drive_id: str) -> None:
        """Remove the frames of a drive; what is half removed is not taken for frames."""
        frames = self.frames(drive_id)
        if frames.exists():
            doomed = frames.with_name(f".{drive_id}-done")
            frames.rename(doomed)
            shutil.rmtree(doomed, ignore_errors=True)


def _folders(folder: Path) -> list[str]:
    """Names of the folders that are complete there; quick for very many."""
    if not folder.is_dir():
        return []
    with os.scandir(folder) as entries:
        return [entry.name for entry in entries if not entry.name.startswith(".") and entry.is_dir()]


def _has_content(path: str) -> bool:
    """Quick for very many."""
    try:
        return os.stat(path).st_size > 0  # noqa: PTH116
    except OSError:
        return False


def _numbered(path: Path) -> Iterator[Path]:
    """The path, then others of like names."""
    return chain([path], (path.with_name(f"{path.name}.{k}") for k in count(2)))


@contextmanager
def locked(folder: StudyFolder) -> Iterator[Callable[[], bool]]:
    """A study's folder, made where there is none, for this process alone; tells whether it is still in its place.

    Raises OutputError when another process has it, when it holds something else, or cannot be written.
    """
    _check_a_studys(folder)
    try:
        folder.path.mkdir(parents=True, exist_ok=True)
        file = folder.lock.open("a+")
    except OSError as error:
        raise OutputError(f"cannot write in {folder.path}: {error.strerror}; name another folder") from None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.seek(0)
            raise OutputError(
                f"{folder.path}: a study runs there already ({file.read().strip()}); wait until it is done, or stop it"
            ) from None
        except OSError as error:
            raise OutputError(f"cannot lock {folder.lock}: {error.strerror}; name another folder") from None
        file.truncate(0)
        since = datetime.now().astimezone().isoformat(" ", "seconds")
        file.write(f"process {os.getpid()} on {socket.gethostname()} since {since}\n")
        file.flush()
        own = os.fstat(file.fileno())

        def in_place() -> bool:
            try:
                return os.path.samestat(folder.lock.stat(), own)
            except OSError:
                return False

        yield in_place


def _check_a_studys(folder: StudyFolder) -> None:
    try:
        there = {entry.name for entry in folder.path.iterdir()} if folder.path.exists() else set()
    except OSError as error:
        raise OutputError(f"{folder.path}: expected a folder, got {error.strerror}; name another") from None
    if there and folder.lock.name not in there and not _has_plan(folder):
        raise OutputError(f"{folder.path}: expected a new or empty folder, or that of this study; name another")


def _has_plan(folder: StudyFolder) -> bool:
    """As the copy of a study's folder without its lock. Not by study.yaml, which may be the user's own file."""
    try:
        return bool(read_plan(folder))
    except ConfigError:
        return False


def read_plan(folder: StudyFolder) -> Plan:
    """The plan of a study's folder; raises ConfigError where there is none."""
    try:
        told = json.loads(folder.plan.read_text())
        return Plan(told["name"], told["description"], tuple(told["factors"]), tuple(told["run_ids"]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise ConfigError(
            f"{folder.path}: expected the folder of a study, got one without a plan ({type(error).__name__}); "
            "name the folder that `slamgym study --out` wrote"
        ) from None


def write_plan(folder: StudyFolder, plan: Plan) -> None:
    """Raises OutputError."""
    write_atomically(folder.plan, json.dumps(asdict(plan)))


def check_grown(folder: StudyFolder, plan: Plan) -> None:
    """Raise OutputError when there is a plan already, one that can be read, and runs of it are not in this one."""
    try:
        before = read_plan(folder)
    except ConfigError:
        return
    planned = set(plan.run_ids)
    if gone := [run_id for run_id in before.run_ids if run_id not in planned]:
        raise OutputError(
            f"{folder.path}: expected the study {before.name!r} that was begun there, or one that has all of its runs; "
            f"{len(gone)} of its {len(before.run_ids)} are not in this one, such as {gone[0]}; name another folder"
        )
