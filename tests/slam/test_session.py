import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slamgym.errors import ConfigError, SlamError
from slamgym.slam import session as session_module
from slamgym.slam.process import WorkerProcess
from slamgym.slam.process_tree import own_mb, process_tree, resident_mb
from slamgym.slam.scratch import ScratchFolder
from slamgym.slam.session import Limits, SlamSession
from slamgym.types import SlamEvent, TrackingState

PIPES: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def wait_until_gone(pid: int, limit_s: float = 5.0) -> bool:
    deadline = time.monotonic() + limit_s
    while is_alive(pid) and time.monotonic() < deadline:
        time.sleep(0.01)
    return not is_alive(pid)


def test_healthy_run(faulty, config, frame):
    with SlamSession(faulty("Healthy"), config) as session:
        results = [session.track(frame(k)) for k in range(10)]
        final = session.finish()
    assert [r.tracked_points for r in results] == list(range(10))  # each frame's own image arrived
    assert final.stamps_ns.tolist() == list(range(10))
    assert (session.outcome, len(session.track_s)) == ("", 10)


def test_map_points_are_those_of_a_backend_that_tells_them(faulty, config, frame):
    for name in (faulty("Healthy"), "groundtruth"):
        with SlamSession(name, config) as session:
            session.track(frame(1))
            assert session.map_points() is None
            assert session.outcome == ""
    with SlamSession(faulty("Segfaults"), config) as session:
        for number in range(1, 4):
            session.track(frame(number))
        assert session.outcome == "crashed"
        assert session.map_points() is None


def test_groundtruth_is_relative_to_the_first_frame(config, frame):
    with SlamSession("groundtruth", config) as session:
        results = [session.track(frame(k)) for k in (5, 6, 8)]
        final = session.finish()
    assert [r.T_map_cam[0, 3] for r in results] == [0.0, 1.0, 3.0]
    assert [r.event for r in results] == [SlamEvent.INITIALIZED, SlamEvent.NONE, SlamEvent.NONE]
    np.testing.assert_allclose(final.T_map_cam, [r.T_map_cam for r in results])


def test_groundtruth_without_frames(config):
    with SlamSession("groundtruth", config) as session:
        assert session.finish().T_map_cam.shape == (0, 4, 4)


@pytest.mark.parametrize(
    ("backend", "outcome", "failure"),
    [
        ("Sleeps", "timeout", "no answer within 0.5 s at frame 2"),
        ("HoldsGil", "timeout", "no answer within 0.5 s at frame 2"),
        ("Aborts", "crashed", "its process was ended by signal 6 (Aborted) at frame 2"),
        ("Segfaults", "crashed", "its process was ended by signal 11 (Segmentation fault) at frame 2"),
        ("Exits", "crashed", "its process ended with exit code 0 at frame 2"),
        ("Raises", "crashed", "ValueError: the third frame is one too many (at frame 2)"),
        ("RaisesOwnError", "crashed", "raised while tracking (at frame 2)"),
    ],
)
def test_fault_in_the_third_frame(faulty, config, frame, backend, outcome, failure):
    limits = Limits(frame_s=0.5 if outcome == "timeout" else 30.0)
    with SlamSession(faulty(backend), config, limits=limits) as session:
        results = [session.track(frame(k)) for k in range(5)]
        final = session.finish()
        assert wait_until_gone(session.pid)
    assert [r.state for r in results] == [TrackingState.OK] * 2 + [TrackingState.LOST] * 3
    assert [r.event for r in results] == ["", "", outcome, "", ""]
    assert all(np.isnan(r.T_map_cam).all() and r.map_id == -1 for r in results[2:])
    assert (session.outcome, len(session.track_s), len(final.stamps_ns)) == (outcome, 2, 0)
    assert session.failure == failure


def test_log_tells_why_it_crashed(faulty, config, frame):
    with SlamSession(faulty("Raises"), config) as session:
        for k in range(3):
            session.track(frame(k))
        assert session.log().splitlines()[-1] == "ValueError: the third frame is one too many"
    assert session.log() == ""


def test_growing_memory_is_stopped_at_its_limit(faulty, config, frame):
    with SlamSession(faulty("GrowsMemory"), config, limits=Limits(memory_mb=300)) as session:
        results = [session.track(frame(k)) for k in range(4)]
    assert [r.event for r in results] == ["", "", SlamEvent.CRASHED, ""]
    used_mb = re.fullmatch(r"it took (\d+) MB of memory, more than its limit of 300 MB at frame 2", session.failure)
    # 10 MB every 2 ms, looked at every 50 ms.
    assert 300 <= int(used_mb[1]) < 1500


def test_programs_that_the_slam_started_end_with_it(faulty, config, frame, children):
    before = children()
    with SlamSession(faulty("LeavesChildren"), config, limits=Limits(frame_s=1.5)) as session:
        for k in range(2):
            session.track(frame(k))
        running = children() - before
        session.track(frame(2))
        assert session.outcome == "timeout"
        assert children() == before
    assert len(running) == 1


def test_memory_that_grows_while_lockstep_waits_is_stopped_too(faulty, config, frame):
    with SlamSession(faulty("GrowsBehind"), config, "lockstep", Limits(memory_mb=300)) as session:
        results = [session.track(frame(k)) for k in range(5)]
    assert [r.event for r in results] == ["", "", "", SlamEvent.CRASHED, ""]
    used_mb = re.fullmatch(r"it took (\d+) MB of memory, more than its limit of 300 MB after frame 2", session.failure)
    assert 300 <= int(used_mb[1]) < 1500


def test_memory_of_a_process_tree():
    program = "import os; x = b'x' * 100_000_000; os.fork(); print(flush=True); input()"
    child = subprocess.Popen([sys.executable, "-c", program], **PIPES)
    with child:
        for _ in range(2):
            child.stdout.readline()
        tree = process_tree(child.pid)
        apart, together = ([measure(pid) for pid in tree] for measure in (resident_mb, own_mb))
        child.kill()
    assert len(tree) == 2
    assert all(mb > 100 for mb in apart)
    assert 100 < sum(together) < 130  # what the two share counts once
    assert process_tree(child.pid) == []


def test_program_in_a_session_of_its_own_ends_too(faulty, config, frame):
    with SlamSession(faulty("LeavesASession"), config, limits=Limits(frame_s=1.5)) as session:
        for k in range(2):
            session.track(frame(k))
        session.track(frame(2))
        assert session.outcome == "timeout"
    assert not [path for path in Path("/proc").glob("[0-9]*/cmdline") if read_bytes(path) == b"sleep\x001000\x00"]


def read_bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError:
        return b""


def test_a_closed_session_says_so(faulty, config, frame):
    session = SlamSession(faulty("Healthy"), config)
    session.track(frame(0))
    session.close()
    for use in (lambda: session.track(frame(1)), session.finish, session.start):
        with pytest.raises(SlamError, match="after its close"):
            use()


def test_a_program_that_ignores_its_children_gets_an_outcome(faulty, config, frame):
    before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    try:
        with SlamSession(faulty("Aborts"), config) as session:
            results = [session.track(frame(k)) for k in range(4)]
    finally:
        signal.signal(signal.SIGCHLD, before)
    assert [r.event for r in results] == ["", "", SlamEvent.CRASHED, ""]


def test_temporary_files_of_a_crashed_slam_are_removed(faulty, config, frame, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with SlamSession(faulty("LeavesFiles"), config) as session:
        session.wait_ready()
        (scratch,) = tmp_path.iterdir()
        for k in range(3):
            session.track(frame(k))
        assert len(list(scratch.iterdir())) == 1
    assert list(tmp_path.iterdir()) == []


def test_scratch_of_a_killed_program_is_removed_by_the_next_and_that_of_a_live_one_kept(tmp_path, monkeypatch):
    program = "from slamgym.slam.scratch import ScratchFolder; x = ScratchFolder(); print(x.path, flush=True); input()"
    env = os.environ | {"TMPDIR": str(tmp_path)}
    with subprocess.Popen([sys.executable, "-c", program], env=env, **PIPES) as other:
        folder = Path(other.stdout.readline().decode().strip())
        old = time.time() - 3600
        os.utime(folder, (old, old))
        monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
        ScratchFolder().close()
        assert folder.is_dir()
        other.kill()
    ScratchFolder().close()
    assert list(tmp_path.iterdir()) == []


def test_chatter_does_not_block_and_takes_little_disk(faulty, config, frame):
    with SlamSession(faulty("Chatters"), config) as session:
        results = [session.track(frame(k)) for k in range(4)]
        time.sleep(0.1)
        session.track(frame(4))
        assert session.log().splitlines()[-1] == "the last line"
        assert len(session.log()) == 2**20
        (log,) = (fd.stat() for fd in Path("/proc/self/fd").iterdir() if fd.exists() and fd.stat().st_size > 50e6)
        assert log.st_blocks * 512 < 20e6
    assert [r.state for r in results] == [TrackingState.OK] * 4


@pytest.mark.parametrize(
    ("backend", "why"), [("AnswersUnpicklable", "expected .* a TrackResult"), ("AnswersNothing", "got None")]
)
def test_answer_of_a_wrong_kind_is_a_crash(faulty, config, frame, backend, why):
    with SlamSession(faulty(backend), config) as session:
        assert session.track(frame(0)).event == SlamEvent.CRASHED
        assert re.search(why, session.log())


def test_killed_between_frames_and_the_next_session_is_right(faulty, config, frame):
    with SlamSession(faulty("Healthy"), config) as session:
        session.track(frame(0))
        os.kill(session.pid, signal.SIGKILL)
        result = session.track(frame(1))
        assert (result.event, session.outcome) == (SlamEvent.CRASHED, "crashed")
    with SlamSession(faulty("Healthy"), config) as session:
        assert session.track(frame(7)).tracked_points == 7


def test_interrupted_wait_does_not_shift_the_answers(faulty, config, frame, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    with SlamSession(faulty("Healthy"), config) as session:
        for wait in (session.wait_ready, lambda: session.track(frame(1))):
            with monkeypatch.context() as patch:
                patch.setattr(WorkerProcess, "receive", interrupt)
                with pytest.raises(KeyboardInterrupt):
                    wait()
            session.wait_ready()
        assert session.track(frame(2)).tracked_points == 2
        assert session.finish().stamps_ns.tolist() == [1, 2]


def test_missing_library_is_the_users_to_solve(faulty, config):
    session = SlamSession(faulty("LacksLibrary"), config)
    with pytest.raises(SlamError, match="install it"):
        session.wait_ready()
    assert wait_until_gone(session.pid)


def test_crash_at_start_is_an_outcome(faulty, config, frame):
    with SlamSession(faulty("AbortsAtStart"), config) as session:
        session.wait_ready()
        assert session.outcome == "crashed"
        assert [session.track(frame(k)).event for k in range(2)] == [SlamEvent.CRASHED, SlamEvent.NONE]


@pytest.mark.parametrize(
    ("backend", "outcome", "failure"),
    [
        ("AbortsAtFinish", "crashed", "its process was ended by signal 6 (Aborted) when it was to end"),
        ("HangsAtFinish", "timeout", "no answer within 1.5 s when it was to end"),
    ],
)
def test_fault_at_finish_is_an_outcome(faulty, config, frame, backend, outcome, failure):
    with SlamSession(faulty(backend), config, limits=Limits(finish_s=1.5)) as session:
        session.track(frame(0))
        assert len(session.finish().stamps_ns) == 0
        assert (session.outcome, session.failure) == (outcome, failure)


def test_frame_of_another_size_is_refused(faulty, config, frame):
    with SlamSession(faulty("Healthy"), config) as session:
        good = frame(0)
        bad = type(good)(0, good.rgb[:-1], good.depth, good.T_world_cam)
        with pytest.raises(ConfigError, match=r"expected uint8 \(24, 32, 3\), got uint8 \(23, 32, 3\)"):
            session.track(bad)
        assert session.track(good).state is TrackingState.OK


def test_lockstep_waits_for_background_threads(faulty, config, frame):
    with SlamSession(faulty("WorksBehind"), config, "lockstep") as session:
        for k in range(3):
            session.track(frame(k))
    assert session.lockstep_wait_s > 0.25
    assert session.lockstep_overruns == 0


def test_free_does_not_wait(faulty, config, frame):
    with SlamSession(faulty("WorksBehind"), config, "free") as session:
        session.track(frame(0))
    assert session.lockstep_wait_s == 0.0


def test_polling_counts_as_idle(faulty, config, frame):
    with SlamSession(faulty("Polls"), config, "lockstep") as session:
        for k in range(10):
            session.track(frame(k))
    assert session.lockstep_overruns == 0


def test_lockstep_wait_is_bounded(faulty, config, frame, monkeypatch):
    monkeypatch.setattr(session_module, "LOCKSTEP_LIMIT_S", 0.2)
    with SlamSession(faulty("WorksForEver"), config, "lockstep") as session:
        assert session.track(frame(0)).state is TrackingState.OK
    assert session.lockstep_overruns == 1


def test_nothing_leaks(faulty, config, frame, children):
    def open_files() -> int:
        return len(list(Path("/proc/self/fd").iterdir()))

    SlamSession(faulty("Healthy"), config).close()
    with SlamSession(faulty("Healthy"), config) as session:  # starts the spawning thread
        session.track(frame(0))
    files, processes, shared = open_files(), children(), set(Path("/dev/shm").iterdir())
    for backend in ("Healthy", "Aborts", "AbortsAtStart", "Raises") * 5:
        session = SlamSession(faulty(backend), config)
        session.start()
        if backend != "Healthy":
            for k in range(3):
                session.track(frame(k))
        session.close()
        session.close()
        assert not is_alive(session.pid)
    assert open_files() == files
    assert children() == processes
    assert set(Path("/dev/shm").iterdir()) == shared


def test_ctrl_c_in_the_terminal_does_not_reach_the_worker(faulty, config):
    with SlamSession(faulty("Healthy"), config) as session:
        session.wait_ready()
        assert os.getsid(session.pid) != os.getsid(0)


PARENT = """
import sys, threading
sys.path.insert(0, sys.argv[1])
import numpy as np
from slamgym.camera import PinholeCamera
from slamgym.slam.backend import SlamConfig
from slamgym.slam.process import WorkerProcess
from slamgym.slam.session import SlamSession
from slamgym.types import Frame

session = SlamSession("faulty_backends:HoldsGil", SlamConfig(PinholeCamera(32, 24, 30.0, 30.0, 15.5, 11.5), 30.0))
starter = threading.Thread(target=session.wait_ready)  # a thread that ends before the run does
starter.start()
starter.join()
frame = Frame(0, np.zeros((24, 32, 3), np.uint8), np.zeros((24, 32), np.float32), np.eye(4))
session.track(frame)
session.track(frame)
print(session.pid, flush=True)
session.track(frame)
"""


def test_worker_dies_with_its_parent_even_while_it_hangs():
    parent = subprocess.Popen([sys.executable, "-c", PARENT, str(Path(__file__).parent)], stdout=subprocess.PIPE)
    with parent:
        worker = int(parent.stdout.readline())
        time.sleep(0.2)
        assert is_alive(worker)
        parent.kill()
    assert wait_until_gone(worker)
