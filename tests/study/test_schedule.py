import random

import pytest

from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.schedule import Schedule


def planned(drives, runs_each, sequence=None):
    """Runs of some drives, drive after drive."""
    return [
        PlannedRun(f"{drive.drive_id}/r{k}", drive, {}, k, {})
        for drive in (PlannedDrive(f"d{number}", "d", "p", {}, sequence=sequence) for number in range(drives))
        for k in range(1, runs_each + 1)
    ]


def name(work):
    return work.drive_id if isinstance(work, PlannedDrive) else work.run_id


def test_each_drive_is_rendered_once_and_its_runs_come_before_another_drive():
    schedule = Schedule(planned(2, 2), ready=())
    order = []
    while work := schedule.next(3):
        order.append(name(work))
        if isinstance(work, PlannedDrive):
            schedule.rendered(work)
        else:
            schedule.concluded(work)
    assert order == ["d0", "d0/r1", "d0/r2", "d1", "d1/r1", "d1/r2"]


def test_no_more_drives_than_there_is_room_for():
    schedule = Schedule(planned(4, 1), ready=())
    first, second = schedule.next(2), schedule.next(2)
    assert [name(first), name(second), schedule.next(2)] == ["d0", "d1", None]
    schedule.rendered(first)
    run = schedule.next(2)
    assert (run.run_id, schedule.next(2)) == ("d0/r1", None)
    assert schedule.concluded(run)
    assert name(schedule.next(2)) == "d2"


def test_recorded_sequences_take_no_room():
    schedule = Schedule(planned(4, 1, sequence="somewhere"), ready=())
    assert [name(schedule.next(1)) for _ in range(4)] == ["d0", "d1", "d2", "d3"]


def test_frames_that_are_there_are_not_rendered_again():
    schedule = Schedule(planned(2, 1), ready={"d1"})
    assert [name(schedule.next(2)) for _ in range(2)] == ["d1/r1", "d0"]


def test_frames_go_with_the_last_run_of_their_drive():
    schedule = Schedule(planned(1, 3), ready={"d0"})
    runs = [schedule.next(1) for _ in range(3)]
    assert [schedule.concluded(run) for run in runs] == [False, False, True]


def test_what_came_to_nothing_is_done_again_first():
    schedule = Schedule(planned(2, 2), ready={"d0"})
    run = schedule.next(2)
    schedule.again(run)
    assert schedule.next(2) is run
    last = schedule.next(2)
    drive = schedule.next(2)
    schedule.again(last)
    schedule.again(drive)
    assert [name(schedule.next(2)) for _ in range(2)] == ["d0/r2", "d1"]


def test_runs_of_a_drive_that_cannot_be_rendered():
    schedule = Schedule(planned(2, 2), ready=())
    drive = schedule.next(1)
    assert [run.run_id for run in schedule.cannot_render(drive)] == ["d0/r1", "d0/r2"]
    assert name(schedule.next(1)) == "d1"


@pytest.mark.parametrize("seed", range(20))
def test_everything_is_done_whatever_comes_in_between(seed):
    """Random workers, deaths and orders: every run is concluded once, and never too many drives are kept."""
    rng = random.Random(seed)
    runs = planned(rng.randint(1, 6), rng.randint(1, 5))
    schedule, workers = Schedule(runs, ready={"d0"} if rng.random() < 0.5 else ()), rng.randint(1, 4)
    under_way, kept, done = [], {"d0"} if schedule._ready else set(), []
    while len(done) < len(runs):
        while len(under_way) < workers and (work := schedule.next(workers + 1)):
            under_way.append(work)
            if isinstance(work, PlannedDrive):
                kept.add(work.drive_id)
        assert under_way
        assert len(kept) <= workers + 1
        work = under_way.pop(rng.randrange(len(under_way)))
        if rng.random() < 0.2:
            schedule.again(work)
            if isinstance(work, PlannedDrive):
                kept.discard(work.drive_id)
        elif isinstance(work, PlannedDrive):
            schedule.rendered(work)
        else:
            done.append(work.run_id)
            if schedule.concluded(work):
                kept.discard(work.drive.drive_id)
    assert sorted(done) == sorted(run.run_id for run in runs)
    assert schedule.next(workers + 1) is None
    assert not kept
