"""Programs of the user's, really run over recorded frames."""

import os
import shlex
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from slamgym.errors import ConfigError, SlamError, TrajectoryWarning
from slamgym.eval.accuracy import ate
from slamgym.eval.datasets import read_sequence
from slamgym.eval.trajectories import Trajectory
from slamgym.geometry import inverse
from slamgym.slam.backend import SlamConfig, check_config
from slamgym.slam.command import Command, at_frames
from slamgym.slam.session import SlamSession
from slamgym.types import TrackingState

RGBD_TUM = shlex.join([sys.executable, str(Path(__file__).parent / "standins" / "rgbd_tum.py")])
STOCK = f"{RGBD_TUM} {{vocabulary}} {{settings}} {{sequence}} {{associations}}"
POSE = "1 2 3 0 0 0 1"


def sh(script: str) -> str:
    return shlex.join(["sh", "-c", script])


@pytest.fixture
def configured(config):
    """The tiny camera's configuration with options as the command line gives them: text."""

    def make(command, *, loop_closure=None, **options):
        return replace(config, loop_closure=loop_closure, options={"command": command, **options})

    return make


@pytest.fixture
def finished(configured, frame):
    """What a shell script makes of two frames, at 0.1 s and 0.2 s."""

    def finish(script: str, **options):
        config = configured(sh(script), **options)
        check_config("command", config)
        backend = Command(config)
        for number in (1, 2):
            backend.track(replace(frame(number), stamp_ns=number * 100_000_000))
        return backend.finish()

    return finish


def test_program_with_the_command_line_of_orbslam2(configured, frame, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    frames = [replace(frame(k), stamp_ns=10**18 + k * 33_333_333) for k in range(5)]
    with SlamSession("command", configured(f"{STOCK} --leave-out 0 3", features="500")) as session:
        online = [session.track(one) for one in frames]
        final = session.finish()
        assert session.outcome == "", session.log()
        assert "vocabulary of 6 branches and 6 levels" in session.log()
    assert {result.state for result in online} == {TrackingState.NOT_INITIALIZED}
    # It wrote six decimals; these are the stamps that were fed.
    assert final.stamps_ns.tolist() == [frames[k].stamp_ns for k in (1, 2, 4)]
    np.testing.assert_allclose(final.T_map_cam, [frames[k].T_world_cam for k in (1, 2, 4)], atol=1e-6)
    assert final.map_id.tolist() == [0, 0, 0]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.filterwarnings("ignore:.*colour images have no depth image")
def test_real_slam_on_real_frames_with_the_settings_of_orbslam2(shared_data):
    sequence = read_sequence(shared_data / "tum_fr1_xyz_100")
    frames = [sequence.frame(k) for k in range(30)]
    config = SlamConfig(sequence.camera, sequence.fps, options={"command": f"{STOCK} --slam orbslam3"})
    with SlamSession("command", config) as session:
        for one in frames:
            session.track(one)
        final = session.finish()
        assert session.outcome == "", session.log()
        assert "- color order: BGR" in session.log()
    assert final.stamps_ns.tolist() == [one.stamp_ns for one in frames]
    truth = np.array([one.T_world_cam for one in frames])
    assert ate(truth, final.T_map_cam).trans_m.rmse < 0.015
    assert np.linalg.norm(inverse(truth[0])[:3] @ truth[-1][:, 3]) > 0.2  # it did move


def test_only_what_the_command_names_is_written_and_looked_up(configured, frame):
    script = f"test ! -e ../settings.yaml && echo 0 {POSE} > {{trajectory}}"
    backend = Command(configured(sh(script), vocabulary="missing.txt"))
    backend.track(frame(0))
    assert len(backend.finish().stamps_ns) == 1


def test_frames_are_files_that_a_program_can_read(finished, tmp_path):
    finished(f"cp -r {{sequence}} {tmp_path}; echo 0.1 {POSE} > CameraTrajectory.txt")
    copy = tmp_path / "sequence"
    assert (copy / "associations.txt").read_text().split("\n")[0].split()[1::2] == [
        "rgb/0.100000000.png",
        "depth/0.100000000.png",
    ]
    assert cv2.imread(str(copy / "depth/0.200000000.png"), cv2.IMREAD_UNCHANGED)[0, 0] == 2 * 5000  # 2 m
    assert cv2.imread(str(copy / "rgb/0.200000000.png"))[0, 0].tolist() == [2, 2, 2]


@pytest.mark.parametrize(("loop_closure", "given"), [(None, "1"), (True, "1"), (False, "0")])
def test_loop_closure_reaches_the_program(finished, loop_closure, given):
    final = finished("echo 0.1 {loop_closure} 0 0 0 0 0 1 > {trajectory}", loop_closure=loop_closure)
    assert final.T_map_cam[0, 0, 3] == float(given)


def test_trajectory_in_a_folder_of_its_own(finished):
    final = finished(f"echo 0.2 {POSE} > out/poses.txt", trajectory="out/poses.txt")
    assert final.stamps_ns.tolist() == [200_000_000]
    np.testing.assert_allclose(final.T_map_cam[0, :3, 3], [1, 2, 3])


def test_users_own_settings(finished, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.yaml").write_text("7")
    final = finished("echo 0.1 $(cat {settings}) 0 0 0 0 0 1 > CameraTrajectory.txt", settings="mine.yaml")
    assert final.T_map_cam[0, 0, 3] == 7.0


def test_users_own_vocabulary(finished, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.txt").write_text("6 6 0 0\n0 1 " + "0 " * 32 + "1")
    final = finished("echo 0.1 $(head -c 1 {vocabulary}) 0 0 0 0 0 1 > CameraTrajectory.txt", vocabulary="mine.txt")
    assert final.T_map_cam[0, 0, 3] == 6.0


def test_files_of_the_users_are_found_from_the_users_folder(config, frame, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("my slam").write_text('#!/bin/sh\ncp "$1" CameraTrajectory.txt\n')
    Path("my slam").chmod(0o755)
    Path("poses.txt").write_text(f"0 {POSE}\n")
    backend = Command(replace(config, options={"command": "'./my slam' poses.txt"}))
    backend.track(frame(0))
    assert backend.finish().stamps_ns.tolist() == [0]


def test_no_module_path_of_ours_reaches_the_program(finished, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", "/ours")
    assert len(finished(f'test -z "$PYTHONPATH" && echo 0.1 {POSE} > CameraTrajectory.txt').stamps_ns) == 1


def test_empty_trajectory_means_never_tracked(finished):
    assert finished(": > CameraTrajectory.txt").T_map_cam.shape == (0, 4, 4)


def test_nothing_is_run_without_frames(configured):
    assert Command(configured(sh("exit 3"))).finish().T_map_cam.shape == (0, 4, 4)


def test_poses_that_are_not_finite_are_left_out(finished):
    with pytest.warns(TrajectoryWarning, match=r"^CameraTrajectory.txt:2: .*NaN or infinity"):
        final = finished(f"(echo 0.1 {POSE}; echo 0.2 nan 0 0 0 0 0 1) > CameraTrajectory.txt")
    assert final.stamps_ns.tolist() == [100_000_000]


@pytest.mark.parametrize(
    ("script", "message"),
    [
        ("exit 3", "sh ended with exit code 3, expected 0"),
        ("kill -SEGV $$", r"exit code 139 \(SIGSEGV\), expected 0; .* 'accept_exit_codes'"),
        ("exit 139", r"exit code 139 \(SIGSEGV\)"),
        (": > Other.txt", "expected the trajectory CameraTrajectory.txt, the program wrote Other.txt"),
        (":", "the program wrote nothing"),
        ("echo hello > CameraTrajectory.txt", "cannot be read: CameraTrajectory.txt:1: expected .* 8 columns"),
        (f"echo 1000 {POSE} > CameraTrajectory.txt", "stamps of frames, 0.100000 to 0.200000 s, got 1000.000000"),
    ],
)
def test_failure_of_the_program(finished, script, message):
    with pytest.raises(SlamError, match=message) as caught:
        finished(script)
    assert "\n" not in str(caught.value)


def test_crash_after_saving_can_be_accepted(finished):
    script = f"echo 0.1 {POSE} > CameraTrajectory.txt; kill -SEGV $$"
    assert len(finished(script, accept_exit_codes="0,139").stamps_ns) == 1


def test_file_that_cannot_be_started(config, frame, tmp_path):
    (tmp_path / "slam").write_bytes(b"\x7fELF of another machine")
    (tmp_path / "slam").chmod(0o755)
    backend = Command(replace(config, options={"command": str(tmp_path / "slam")}))
    backend.track(frame(0))
    with pytest.raises(SlamError, match=r"cannot start .*slam: Exec format error"):
        backend.finish()


def test_repairs_are_told_to_the_user(configured, frame):
    script = f"(echo 0 {POSE}; echo 0.01 nan 0 0 0 0 0 1; echo 9 {POSE}) > CameraTrajectory.txt"
    with SlamSession("command", configured(sh(script))) as session:
        session.track(frame(0))
        with pytest.warns(TrajectoryWarning) as told:
            assert len(session.finish().stamps_ns) == 1
    first, second = (str(one.message) for one in told)
    assert first.startswith("CameraTrajectory.txt:2: expected")
    assert second == "1 of 2 poses belong to no frame: left out"


def test_failure_of_the_program_is_a_crash_of_the_run(configured, frame):
    with SlamSession("command", configured(sh("echo some words; exit 3"))) as session:
        session.track(frame(0))
        assert len(session.finish().stamps_ns) == 0
        assert session.outcome == "crashed"
        assert "ended with exit code 3" in session.failure
        assert "some words" in session.log()


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("", "expected a program"),
        ("sh {setings}", r"unknown placeholder .* 'setings'; did you mean 'settings'\? Valid: associations"),
        ("sh {}", "unknown placeholder"),
        ("sh {settings:9}", "unknown placeholder .* 'settings9'; did you mean 'settings'"),
        ("sh 'a", "No closing quotation"),
        ("sh {settings", "expected '}'"),
    ],
)
def test_bad_template(configured, command, message):
    with pytest.raises(ConfigError, match=message) as caught:
        check_config("command", configured(command))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("program", ["no_such_program", "./no_such_program", __file__, "~nobody_at_all/slam"])
def test_missing_program(configured, program):
    with pytest.raises(SlamError, match=f"no executable '{program}'; build it"):
        check_config("command", configured(f"{program} {{sequence}}"))


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        ("sh {settings}", {"vocabulary": "v.txt"}, "'vocabulary': expected {vocabulary} in the slam option 'command'"),
        ("sh {vocabulary}", {"features": "500"}, "'features': expected {settings} in"),
        ("sh {vocabulary}", {"settings": "s.yaml"}, "'settings': expected {settings} in"),
        ("sh {settings}", {"settings": "s.yaml", "levels": "4"}, "'levels': expected it in s.yaml, the settings file"),
        ("sh {settings}", {"loop_closure": False}, "loop_closure: expected {loop_closure} in"),
        ("sh", {"trajectory": "/tmp/t.txt"}, "'trajectory': expected a path inside .*, got '/tmp/t.txt'"),
        ("sh", {"trajectory": "../t.txt"}, "'trajectory': expected a path inside"),
        ("sh", {"accept_exit_codes": "0,x"}, r"'accept_exit_codes': .*integer.*, got 'x'"),
    ],
)
def test_what_cannot_reach_the_program_is_refused(configured, command, options, message):
    with pytest.raises(ConfigError, match=message):
        check_config("command", configured(command, **options))


def test_all_options_at_their_defaults_are_no_reason_to_refuse(configured):
    defaults = Command.Options().model_dump(exclude={"command"})
    check_config("command", configured("sh {sequence}", **defaults))


@pytest.mark.parametrize(
    ("options", "message"),
    [({"settings": "no.yaml"}, "'settings': expected a file"), ({"vocabulary": "no.txt"}, "vocabulary: .* no.txt")],
)
def test_missing_files(configured, options, message):
    with pytest.raises(SlamError, match=message):
        check_config("command", configured("sh {settings} {vocabulary}", **options))


def test_versions_name_the_files_that_the_command_names(configured, tmp_path):
    slam = tmp_path / "slam.py"
    slam.write_bytes(b"")
    versions = Command.versions(configured(f"sh {slam} {{vocabulary}} {{settings}}", settings=str(slam)))
    assert versions.keys() == {"sh_sha256", f"{slam}_sha256", "settings_sha256", "vocabulary_sha256"}
    assert versions[f"{slam}_sha256"] == versions["settings_sha256"] == "e3b0c44298fc"  # SHA-256 of nothing
    assert Command.versions(configured(sh("x" * 5000))).keys() == {"sh_sha256"}  # too long for a file's name


def test_versions_tell_files_of_the_same_name_apart(configured, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for folder, text in (("first", b""), ("second", b"abc")):
        Path(folder).mkdir()
        Path(folder, "main.py").write_bytes(text)
    versions = Command.versions(configured("sh first/main.py ./second/main.py"))
    del versions["sh_sha256"]
    # SHA-256 of nothing, and of "abc" as in FIPS 180.
    assert versions == {"first/main.py_sha256": "e3b0c44298fc", "./second/main.py_sha256": "ba7816bf8f01"}


def trajectory(*stamps_ns: int) -> Trajectory:
    T = np.tile(np.eye(4), (len(stamps_ns), 1, 1))
    T[:, 0, 3] = range(len(stamps_ns))
    return Trajectory(np.array(stamps_ns, dtype=np.int64), T)


def test_poses_go_to_the_nearest_frame():
    fed_ns = np.array([0, 1000, 1100, 3000])  # 100 ns at the least: 50 is too far
    with pytest.warns(TrajectoryWarning, match="2 of 5 poses belong to no frame"):
        final = at_frames(trajectory(-49, 1049, 1051, 2000, 3050), fed_ns, fps=30.0)
    assert final.stamps_ns.tolist() == [0, 1000, 1100]
    assert final.T_map_cam[:, 0, 3].tolist() == [0.0, 1.0, 2.0]


def test_pose_of_a_single_frame_may_be_half_a_frame_off():
    fed_ns = np.array([0])
    assert len(at_frames(trajectory(49_999_999), fed_ns, fps=10.0).stamps_ns) == 1
    with pytest.raises(SlamError, match="write the stamps that associations"):
        at_frames(trajectory(50_000_000), fed_ns, fps=10.0)


# The end of a program whose own end nobody waits for.

HANGING = "sleep 60 & echo $$ $! > {pids}.draft; mv {pids}.draft {pids}; sleep 60"
"""Writes its own process id and that of its child."""


def written(path: Path) -> list[int]:
    deadline = time.monotonic() + 20
    while not path.exists() and time.monotonic() < deadline:
        time.sleep(0.01)
    return [int(word) for word in path.read_text().split()]


def all_gone(pids: list[int]) -> bool:
    deadline = time.monotonic() + 5
    while (alive := [pid for pid in pids if is_alive(pid)]) and time.monotonic() < deadline:
        time.sleep(0.01)
    return not alive


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_program_and_its_children_die_with_the_worker(configured, frame, tmp_path):
    pids_file = tmp_path / "pids"
    with SlamSession("command", configured(sh(HANGING.format(pids=pids_file)))) as session:
        session.track(frame(0))
        finishing = threading.Thread(target=session.finish)
        finishing.start()
        pids = written(pids_file)
        assert len(pids) == 2
        assert all(map(is_alive, pids))
        os.kill(session.pid, signal.SIGKILL)
        finishing.join(10)
        assert session.outcome == "crashed"
    assert all_gone(pids)


PARENT = """
import sys
import numpy as np
from slamgym.camera import PinholeCamera
from slamgym.slam.backend import SlamConfig
from slamgym.slam.session import SlamSession
from slamgym.types import Frame

config = SlamConfig(PinholeCamera(32, 24, 30.0, 30.0, 15.5, 11.5), 30.0, options={"command": sys.argv[1]})
session = SlamSession("command", config)
session.track(Frame(0, np.zeros((24, 32, 3), np.uint8), np.zeros((24, 32), np.float32), np.eye(4)))
session.finish()
"""


def test_program_and_its_children_die_with_the_parent(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    pids_file = tmp_path / "pids"
    with subprocess.Popen([sys.executable, "-c", PARENT, sh(HANGING.format(pids=pids_file))]) as parent:
        pids = written(pids_file)
        assert all(map(is_alive, pids))
        parent.kill()
    assert all_gone(pids)


def test_what_a_program_leaves_running_is_ended(finished, tmp_path, children):
    before = children()
    finished(f"sleep 60 & echo $! > {tmp_path}/pid; echo 0.1 {POSE} > CameraTrajectory.txt")
    assert all_gone(written(tmp_path / "pid"))
    assert children() == before
