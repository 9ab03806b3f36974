"""About how long each piece of a study's work takes: for the time that is left, and to tell what hangs."""

from collections.abc import Iterable
from itertools import groupby

from slamgym.errors import SequenceError
from slamgym.params import SlamParams
from slamgym.study.estimate import estimate
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.schedule import Work, name_of

UNKNOWN_S = 60.0
"""For what cannot be estimated, since the drive is not readable."""
SLOWER_THAN_THOUGHT, ALLOWANCE_S = 10.0, 600.0
"""Work is taken for hanging after so many times what it was thought to take, and so much more."""


class Costs:
    """Expected seconds of each drive and run; each run's are the mean of those over the same drive."""

    def __init__(self, runs: Iterable[PlannedRun]) -> None:
        self._seconds: dict[str, float] = {}
        for drive_id, over in groupby(runs, lambda run: run.drive.drive_id):
            same_drive = list(over)
            render_s, slam_s = _estimated(same_drive)
            self._seconds[drive_id] = render_s
            self._seconds |= dict.fromkeys((run.run_id for run in same_drive), slam_s)

    def of(self, work: Work) -> float:
        return self._seconds[name_of(work)]

    def limit_s(self, work: Work) -> float:
        """Time after which it will never end."""
        allowed_s = 0.0 if isinstance(work, PlannedDrive) else _allowed_s(work)
        return SLOWER_THAN_THOUGHT * self.of(work) + ALLOWANCE_S + allowed_s


def _allowed_s(run: PlannedRun) -> float:
    """What the SLAM may take by its own limits, which find one that hangs: to load and to end, and for each frame."""
    params = SlamParams.checked(run.slam)
    try:
        frames_fed = estimate([run]).frames_fed
    except SequenceError:
        frames_fed = 0
    return 2 * params.slam_finish_timeout_s + frames_fed * params.slam_timeout_s


def _estimated(runs: list[PlannedRun]) -> tuple[float, float]:
    """To render the drive that the runs have in common, and the mean run."""
    try:
        about = estimate(runs)
    except SequenceError:
        return UNKNOWN_S, UNKNOWN_S
    return about.render_s, about.slam_s / len(runs)
