import time
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from slamgym.computer import computer_name
from slamgym.eval.robustness import find_losses
from slamgym.slam.record import SlamRun, run_sequence
from slamgym.slam.session import Limits, SlamSession
from slamgym.types import TrackingState

OK, LOST, NOT_YET = TrackingState.OK, TrackingState.LOST, TrackingState.NOT_INITIALIZED


def record_of(backend, config, frames, sync="free", **options):
    with SlamSession(backend, replace(config, options=options), sync) as session:
        return run_sequence(SlamRun(session), frames)


@pytest.fixture
def frames(frame):
    """A function that gives `count` frames, `step_s` apart."""
    return lambda count, step_s=0.1: [replace(frame(k), stamp_ns=round(k * step_s * 1e9)) for k in range(count)]


def test_a_loss_has_a_context_and_others_have_none(faulty, config, frames):
    record = record_of(faulty("LostForThree"), config, frames(12), fault_frame=6)
    assert record.states.tolist() == [OK] * 5 + [LOST] * 3 + [OK] * 4
    assert list(record.contexts) == [5]
    (loss,) = find_losses(record)
    # The frame's number is its place along x, in metres, and its grey value.
    assert loss.context.speed_mps == pytest.approx(10.0)
    assert loss.context.brightness == 5.0
    assert (loss.start_frame, loss.end_frame, loss.outcome) == (5, 7, "relocalized")


def test_frames_before_the_first_tracked_one_are_no_loss(faulty, config, frames):
    record = record_of(faulty("LostForThree"), config, frames(6), fault_frame=1)
    assert record.states.tolist() == [LOST] * 3 + [OK] * 3
    assert record.contexts == {}


def test_frames_after_a_crash_count_as_not_tracked_and_the_cause_is_told(faulty, config, frames):
    record = record_of(faulty("Segfaults"), config, frames(8))
    assert record.states.tolist() == [OK] * 2 + [LOST] * 6
    assert record.outcome == "crashed"
    (loss,) = find_losses(record)
    assert (loss.start_frame, loss.outcome, loss.context.cause) == (2, "never", "crashed")
    assert "Segmentation fault" in loss.context.explanation


def test_the_log_of_a_crash_is_kept(faulty, config, frames):
    record = record_of(faulty("Raises"), config, frames(4))
    assert record.log_tail.splitlines()[-1] == "ValueError: the third frame is one too many"
    assert record_of(faulty("Healthy"), config, frames(4)).log_tail == ""


def test_offline_backend_tracked_what_it_has_poses_of(faulty, config, frames):
    record = record_of(faulty("Offline"), config, frames(5))
    assert record.states.tolist() == [NOT_YET, OK, LOST, OK, OK]
    assert record.events == ("", "initialized", "lost", "relocalized", "")
    assert record.map_id.tolist() == [-1, 0, -1, 0, 0]
    assert np.isnan(record.T_map_cam).all()  # it emitted none on the way
    (loss,) = find_losses(record)
    assert (loss.start_frame, loss.context.brightness) == (2, 2.0)


def test_in_real_time_a_slow_slam_is_given_only_frames_that_are_not_overtaken(faulty, config, frames):
    record = record_of(faulty("Slow"), config, frames(60, 1 / 60), "realtime")
    assert len(record.states) + record.frames_dropped == 60
    # 0.1 s a frame is one frame in six.
    assert 0 < len(record.states) <= 20
    assert (np.diff(record.stamps_ns) > 0.09e9).mean() > 0.8


def test_in_real_time_frames_wait_until_they_are_due(faulty, config, frames):
    with SlamSession(faulty("Healthy"), config, "realtime") as session:
        session.wait_ready()
        run, begin = SlamRun(session), time.monotonic()
        record = run_sequence(run, frames(6, 0.3))
        took_s = time.monotonic() - begin
        timing = run.timing()
    assert (len(record.states), record.frames_dropped) == (6, 0)
    assert 0 <= timing["late_ms_median"] <= timing["late_ms_max"] < 300
    assert took_s >= 1.5
    assert timing["computer"] == computer_name()
    assert abs(datetime.now(UTC) - datetime.fromisoformat(timing["ended"])) < timedelta(minutes=1)


def test_frames_that_a_hanging_slam_was_not_there_for_are_lost_not_dropped(faulty, config, frames):
    with SlamSession(faulty("Sleeps"), config, "realtime", Limits(frame_s=1.0)) as session:
        record = run_sequence(SlamRun(session), frames(40, 1 / 30))
    assert record.outcome == "timeout"
    assert (len(record.states), record.frames_dropped) == (40, 0)
    assert record.states.tolist() == [OK] * 2 + [LOST] * 38


def test_live_in_real_time_no_frame_is_dropped(faulty, config, frames):
    with SlamSession(faulty("Slow"), config, "realtime") as session:
        run = SlamRun(session)
        for frame in frames(8, 1 / 60):
            run.feed(frame)
        record, timing = run.finish(), run.timing()
    assert (len(record.states), record.frames_dropped) == (8, 0)
    # Seven frames of 0.1 s each, due within 0.12 s.
    assert timing["late_ms_max"] > 500
