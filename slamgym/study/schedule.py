"""Which piece of a study's work comes next: pure bookkeeping, nothing is run here."""

from collections import Counter, deque
from collections.abc import Collection, Iterable

from slamgym.study.planned import PlannedDrive, PlannedRun

Work = PlannedDrive | PlannedRun
"""The drive is to be rendered; the run's SLAM is to be fed."""


def name_of(work: Work) -> str:
    return work.drive_id if isinstance(work, PlannedDrive) else work.run_id


class Schedule:
    """Runs whose drive is ready come first; a drive is rendered once, however many runs it has.

    ready: ids of drives whose frames are there already.
    """

    def __init__(self, runs: Iterable[PlannedRun], ready: Collection[str]) -> None:
        runs = list(runs)
        drives = {run.drive.drive_id: run.drive for run in runs}
        self._waiting: dict[str, deque[PlannedRun]] = {drive_id: deque() for drive_id in drives}
        for run in runs:
            self._waiting[run.drive.drive_id].append(run)
        self._left = Counter(run.drive.drive_id for run in runs)
        """Runs of each drive that are waiting or under way."""
        self._to_render = deque(drive for drive_id, drive in drives.items() if drive_id not in ready)
        self._ready = {drive_id: None for drive_id in drives if drive_id in ready}
        """Drives with runs that wait, in the order in which they became ready."""
        self._kept = {drive_id for drive_id in self._ready if drives[drive_id].sequence is None}

    def next(self, most_drives: int) -> Work | None:
        """What to do now; None when there is nothing to do until something else is done.

        most_drives: how many may be on the disk at a time; a recorded sequence takes no room.
        """
        for drive_id in self._ready:
            run = self._waiting[drive_id].popleft()
            if not self._waiting[drive_id]:
                del self._ready[drive_id]
            return run
        if self._to_render and (self._to_render[0].sequence or len(self._kept) < most_drives):
            drive = self._to_render.popleft()
            if drive.sequence is None:
                self._kept.add(drive.drive_id)
            return drive
        return None

    def again(self, work: Work) -> None:
        """What was under way came to nothing and is to be done again, first of all."""
        if isinstance(work, PlannedDrive):
            self._to_render.appendleft(work)
            self._kept.discard(work.drive_id)
        else:
            self._waiting[work.drive.drive_id].appendleft(work)
            self._ready[work.drive.drive_id] = None

    def rendered(self, drive: PlannedDrive) -> None:
        """The drive is there: its runs can begin."""
        self._ready[drive.drive_id] = None

    def cannot_render(self, drive: PlannedDrive) -> list[PlannedRun]:
        """The drive will never be there; its runs, which are given up."""
        self._kept.discard(drive.drive_id)
        del self._left[drive.drive_id]
        return list(self._waiting.pop(drive.drive_id))

    def concluded(self, run: PlannedRun) -> bool:
        """The run is done: whether it was the last one of its drive, whose frames nobody needs any more."""
        drive_id = run.drive.drive_id
        self._left[drive_id] -= 1
        if self._left[drive_id]:
            return False
        self._kept.discard(drive_id)
        return True
