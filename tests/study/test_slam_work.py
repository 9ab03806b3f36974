import json
import os
import subprocess
from dataclasses import replace

import cv2
import gymnasium as gym
import pytest
import yaml

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import AGENTS
from slamgym.errors import ConfigError, OutputError, SequenceError, SlamError
from slamgym.eval.datasets import SequenceWriter
from slamgym.rollout import run_episode
from slamgym.run_folder import write_run
from slamgym.study.drive_work import load_drive, record_planned_drive
from slamgym.study.planned import PlannedDrive, PlannedRun
from slamgym.study.recorded_run import read_recorded_run
from slamgym.study.slam_work import read_planned, run_planned
from slamgym.study.work import write_crashed

DRIVE = PlannedDrive(
    drive_id="d1",
    dataset="procedural",
    path="procedural #7",
    params={"camera": "small", "lighting": "flat", "path_length_m": 1.0, "speed": 0.8, "depth_noise": "icl_nuim"},
    seed=7,
    agent="patrol",
)


BLACKOUT = range(36, 48)
"""Frames of the recorded sequence that are dark, at 30 a second."""


def planned(drive=DRIVE, busy_processes=0, **slam):
    return PlannedRun(f"{drive.drive_id}/1", drive, slam, 1, {"speed": 0.8}, busy_processes)


@pytest.fixture(scope="module")
def drive_folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drives") / "d1"
    record_planned_drive(DRIVE, folder)
    return folder


@pytest.fixture(scope="module")
def dark_drive(drive_folder, tmp_path_factory):
    """A sequence that somebody recorded, 0.4 s of it in the dark, as a drive of a study, and its folder there."""
    place = tmp_path_factory.mktemp("dark")
    sequence = load_drive(drive_folder).sequence
    with SequenceWriter(place / "night", sequence.camera, sequence.fps) as writer:
        for k, frame in enumerate(sequence.frames()):
            writer.add(replace(frame, rgb=0 * frame.rgb, depth=0 * frame.depth) if k in BLACKOUT else frame)
    drive = PlannedDrive("night", "own", "night", {}, sequence=str(place / "night"))
    record_planned_drive(drive, place / "drive")
    return drive, place / "drive"


def live(**slam):
    env = gym.make("HomeRobotSLAM-v0", **DRIVE.params, **slam)
    episode = run_episode(env, AGENTS[DRIVE.agent](), DRIVE.seed)
    env.close()
    return episode


def files(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("slam", [{"slam": "groundtruth"}, {"slam": "wheel_odometry", "stride": 2}])
def test_a_run_over_recorded_frames_is_the_live_drive(slam, drive_folder, tmp_path):
    episode = live(**slam)
    there = write_run(episode, tmp_path / "live")
    summary = run_planned(planned(**slam), drive_folder, tmp_path / "study")
    here = tmp_path / "study"
    assert files(here) - files(there) == {"planned.json"}
    assert files(there) <= files(here)

    # Nothing but the images has been rounded, and these backends do not look at them.
    for name in files(there) - {"episode.json", "slam.log", "map.png"}:
        assert (here / name).read_text() == (there / name).read_text(), name
    assert (here / "map.png").read_bytes() == (there / "map.png").read_bytes()
    expected, got = (json.loads((folder / "episode.json").read_text()) for folder in (there, here))
    assert list(got) == list(expected)
    assert got.pop("timing").keys() == expected.pop("timing").keys()
    assert got == expected
    assert list(summary) == list(episode.summary)


def test_config_names_nothing_of_the_study_and_repeats_the_run(drive_folder, tmp_path):
    run_planned(planned(slam="groundtruth", stride=1), drive_folder, tmp_path / "run")
    assert read_recorded_run(tmp_path / "run").agent is AGENTS["patrol"]
    config = yaml.safe_load((tmp_path / "run" / "config.yaml").read_text())
    run = config.pop("run")
    assert run["env_id"] == "HomeRobotSLAM-v0"
    assert (run["agent"], run["reset_options"]) == ("slamgym.agents.patrol:Patrol", {"tour": "round_trip"})
    assert set(run) == {"env_id", "seed", "agent", "reset_options", "versions"}
    gym.make(run["env_id"], **config).close()


@pytest.mark.parametrize(
    ("bad", "error"),
    [
        ({"slam": "orbslam"}, ConfigError),
        ({"slam": "groundtruth", "strid": 1}, ConfigError),
        ({"slam": "groundtruth", "loop_closure": True}, ConfigError),
        ({"slam": "faulty_backends:LacksLibrary"}, SlamError),
    ],
)
def test_a_slam_that_cannot_be_run_leaves_nothing(bad, error, drive_folder, tmp_path, faulty, children):
    before = children()
    with pytest.raises(error):
        run_planned(planned(busy_processes=1, **bad), drive_folder, tmp_path / "run")
    assert list(tmp_path.iterdir()) == []
    assert children() == before


def test_a_crash_is_a_result_over_the_whole_drive(drive_folder, tmp_path, faulty):
    summary = run_planned(planned(slam=faulty("Segfaults")), drive_folder, tmp_path / "run")
    drive = load_drive(drive_folder)
    frames = len(drive.sequence)
    assert (summary["status"], summary["end"], summary["frames_fed"]) == ("crashed", "slam_gone", frames)
    assert summary["distance_m"] == drive.facts.episode.summary["distance_m"]
    assert (tmp_path / "run" / "losses" / "1.jpg").exists()


def test_frames_around_a_loss_are_kept_for_a_person(dark_drive, tmp_path):
    drive, folder = dark_drive
    summary = run_planned(planned(drive, slam="opencv"), folder, tmp_path / "run")
    assert summary["sequence"] == "night"
    assert len(summary["losses"]) == 1
    assert summary["losses"][0]["start_s"] == pytest.approx(BLACKOUT[0] / 30, abs=0.04)
    assert [path.name for path in (tmp_path / "run" / "losses").iterdir()] == ["1.jpg"]
    assert not (folder / "frames").exists()
    strip = cv2.imread(str(tmp_path / "run" / "losses" / "1.jpg"))
    # 1.0 s and 0.3 s before, the last tracked, the first lost, 0.3 s and 1.0 s after it: of these two are dark.
    brightness = [strip[:150, k * 204 : k * 204 + 200].mean() for k in range(6)]
    assert [value < 5 for value in brightness] == [False, False, False, True, True, False]


def test_a_run_that_ended_its_worker_can_be_repeated(drive_folder, dark_drive, tmp_path):
    write_crashed(planned(slam="groundtruth", stride=2), drive_folder, tmp_path / "dead", "gone")
    run_planned(planned(slam="groundtruth", stride=2), drive_folder, tmp_path / "run")
    dead, alive = (yaml.safe_load((tmp_path / name / "config.yaml").read_text()) for name in ("dead", "run"))
    assert dead == alive
    assert read_recorded_run(tmp_path / "dead") == read_recorded_run(tmp_path / "run")
    drive, folder = dark_drive
    write_crashed(planned(drive, slam="opencv"), folder, tmp_path / "night", "gone")
    with pytest.raises(ConfigError, match=f"slamgym replay {drive.sequence} --out DIR --slam opencv"):
        read_recorded_run(tmp_path / "night")


def test_frames_that_cannot_be_read_are_told(drive_folder, tmp_path):
    with pytest.raises(SequenceError, match="expected a drive that a study recorded"):
        run_planned(planned(slam="groundtruth"), tmp_path / "gone", tmp_path / "run")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def mounted(tmp_path):
    """A function that mounts a small file system; skips where that is not permitted."""
    places = []

    def mount(options):
        place = tmp_path / f"mounted{len(places)}"
        place.mkdir()
        if os.geteuid() or subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place]).returncode:
            pytest.skip("mounting is not permitted")
        places.append(place)
        return place

    yield mount
    for place in places:
        subprocess.run(["umount", "-l", place], check=True)


def test_a_full_disk_leaves_nothing(mounted, drive_folder):
    place = mounted("size=48k")
    with pytest.raises(OutputError, match="No space left"):
        run_planned(planned(slam="groundtruth"), drive_folder, place / "run")
    assert list(place.iterdir()) == []
    place = mounted("size=2m")
    with pytest.raises(OutputError, match="No space left"):
        record_planned_drive(DRIVE, place / "drive")
    assert list(place.iterdir()) == []


def test_a_read_only_folder_is_told(mounted, drive_folder):
    place = mounted("ro")
    with pytest.raises(OutputError, match="cannot write"):
        run_planned(planned(slam="groundtruth"), drive_folder, place / "run")
    with pytest.raises(OutputError, match="cannot write"):
        record_planned_drive(DRIVE, place / "drive")


def test_processes_that_keep_the_computer_busy_are_gone_after_the_run(drive_folder, tmp_path, children):
    before = children()
    run = planned(busy_processes=2, slam="groundtruth", stride=3)
    summary = run_planned(run, drive_folder, tmp_path / "run")
    assert children() == before
    assert summary["status"] == "ok"
    assert read_planned(tmp_path / "run") == run
