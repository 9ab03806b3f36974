import json

import cv2
import gymnasium as gym
import numpy as np
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import AGENTS, PathFollower
from slamgym.errors import ConfigError, OutputError, SceneError, SequenceError
from slamgym.rollout import run_episode
from slamgym.study.drive_work import keep_facts, load_drive, read_facts, record_planned_drive
from slamgym.study.planned import PlannedDrive

PARAMS = {"camera": "small", "lighting": "flat", "path_length_m": 1.0, "speed": 0.5}
DRIVE = PlannedDrive("d1", "procedural", "procedural #3", PARAMS, seed=3, agent="patrol", max_episode_steps=40)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("drives") / "d1"
    record_planned_drive(DRIVE, folder)
    return folder


def test_what_is_read_is_what_was_driven(folder):
    env = gym.make("HomeRobot-v0", max_episode_steps=40, **PARAMS)
    driven = run_episode(env, AGENTS["patrol"](), 3)
    env.close()
    drive = load_drive(folder)
    read = drive.facts.episode
    assert drive.facts.planned == DRIVE
    assert read.summary == driven.summary
    assert read.summary["end"] == "truncated"
    assert read.config["run"] == driven.config["run"]
    assert read.config.keys() == driven.config.keys()
    for there, here in zip(driven.motion().items(), read.motion().items(), strict=True):
        assert there[0] == here[0]
        assert np.array_equal(there[1], here[1])
    assert np.array_equal(read.truth.T, driven.truth.T)
    assert np.array_equal(read.path_xy, driven.path_xy)
    assert np.array_equal(read.grid.occupied, driven.grid.occupied)
    assert np.array_equal(read.grid.origin_xy, driven.grid.origin_xy)
    assert read.grid.resolution_m == driven.grid.resolution_m
    assert np.array_equal(drive.sequence.T_world_cam, driven.truth.T)
    assert drive.sequence.stamps_ns.tolist() == driven.truth.stamps_ns.tolist()


def test_what_is_kept_has_the_facts_and_no_frames(folder, tmp_path):
    for _ in range(2):  # a study that goes on finds it there
        keep_facts(folder, tmp_path / "kept" / "d1")
    kept = tmp_path / "kept" / "d1"
    assert {path.name for path in kept.iterdir()} == {"drive.json", "drive.npz", "views.jpg"}
    assert sum(path.stat().st_size for path in kept.iterdir()) < 200_000
    assert read_facts(kept).episode.summary == read_facts(folder).episode.summary
    assert cv2.imread(str(kept / "views.jpg")).shape == (2 * 180, 3 * 240, 3)
    with pytest.raises(SequenceError):
        load_drive(kept)


def test_of_a_recorded_sequence_nothing_is_copied(folder, tmp_path):
    drive = PlannedDrive("own", "own", "own", {}, sequence=str(folder / "frames"))
    record_planned_drive(drive, tmp_path / "own")
    assert {path.name for path in (tmp_path / "own").iterdir()} == {"drive.json", "views.jpg"}
    read = load_drive(tmp_path / "own")
    assert read.facts.episode is None
    assert len(read.sequence) == len(load_drive(folder).sequence)
    keep_facts(tmp_path / "own", tmp_path / "kept")
    assert read_facts(tmp_path / "kept").planned == drive


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"agent": "patroll"}, ConfigError),
        ({"params": {"sped": 1}}, ConfigError),
        ({"params": {"scene": "/nonexistent/house.glb"}}, SceneError),
        ({"params": {**PARAMS, "scene_options": {"size": "huge"}}}, ConfigError),
        ({"agent": "cautious", "params": PARAMS}, ConfigError),  # it needs a SLAM in the loop
        ({"sequence": "/nonexistent/sequence"}, SequenceError),
    ],
)
def test_a_drive_that_cannot_be_driven_leaves_nothing(change, error, tmp_path):
    drive = PlannedDrive(**{"drive_id": "d", "dataset": "d", "path": "p", "params": {}, **change})
    with pytest.raises(error):
        record_planned_drive(drive, tmp_path / "drive")
    assert list(tmp_path.iterdir()) == []


def test_an_error_of_an_agent_is_not_told_as_a_full_disk(tmp_path, monkeypatch):
    class Forgetful(PathFollower):
        def act(self, *_):
            raise FileNotFoundError("policy.pt")

    monkeypatch.setitem(AGENTS, "forgetful", Forgetful)
    drive = PlannedDrive("d", "d", "procedural #1", PARAMS, agent="forgetful")
    with pytest.raises(SceneError, match=r"procedural #1: .* got FileNotFoundError: policy\.pt"):
        record_planned_drive(drive, tmp_path / "drive")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_with_something_in_it_is_left_alone(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(OutputError, match="new or empty"):
        record_planned_drive(DRIVE, tmp_path)


@pytest.mark.parametrize("broken", ["", "{", "[]", '{"drive": {"drive_id": "d"}}'])
def test_a_folder_that_is_no_drive_is_told_in_one_line(broken, tmp_path):
    (tmp_path / "drive.json").write_text(broken)
    with pytest.raises(SequenceError, match="expected a drive that a study recorded") as told:
        read_facts(tmp_path)
    assert len(str(told.value).splitlines()) == 1


def test_facts_are_plain_json(folder):
    told = json.loads((folder / "drive.json").read_text(), parse_constant=pytest.fail)
    assert told["drive"]["params"] == PARAMS
