import json
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pandas as pd
import pytest
import yaml

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.errors import ConfigError, OutputError, SequenceError
from slamgym.eval.datasets import read_sequence
from slamgym.params import SlamParams
from slamgym.recording import record_drive
from slamgym.replay import replay
from slamgym.rollout import run_episode
from slamgym.run_folder import write_run

DRIVE = {"speed": 0.5, "path_length_m": 1.5}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A drive, and the sequence of its frames."""
    folder = tmp_path_factory.mktemp("recorded") / "drive"
    env = gym.make("HomeRobot-v0", **DRIVE)
    episode = record_drive(env, PathFollower(), 7, folder)
    env.close()
    return episode, read_sequence(folder)


def params(**values):
    return SlamParams.checked(values)


def test_a_recorded_drive_is_the_drive(recorded):
    episode, sequence = recorded
    assert len(sequence) == len(episode.steps)
    assert sequence.stamps_ns.tolist() == episode.truth.stamps_ns.tolist()
    np.testing.assert_allclose(sequence.T_world_cam, episode.truth.T, atol=1e-8)
    env = gym.make("HomeRobot-v0", **DRIVE)
    obs, _ = env.reset(seed=7)
    env.close()
    frame = sequence.frame(0)
    assert np.array_equal(frame.rgb, obs["rgb"])
    np.testing.assert_allclose(frame.depth, obs["depth"], atol=1.1e-4)  # files hold steps of 0.2 mm


def test_a_replay_comes_to_what_the_live_drive_comes_to(recorded):
    env = gym.make("HomeRobotSLAM-v0", slam="groundtruth", stride=1, **DRIVE)
    live = run_episode(env, PathFollower(), 7)
    env.close()
    again = replay(recorded[1], params(slam="groundtruth", stride=1))
    assert again.slam.stamps_ns.tolist() == live.slam.stamps_ns.tolist()
    same = again.summary.keys() & live.summary.keys() - {"timing", "end", "distance_m", "map_results"}
    assert len(same) > 50
    for key in same:
        assert again.summary[key] == pytest.approx(live.summary[key], abs=1e-4, nan_ok=True), key
    assert again.summary["end"] == "sequence_end"


def test_one_rendering_serves_any_backend_and_stride(recorded):
    sequence = recorded[1]
    runs = [replay(sequence, params(slam="orbslam3", stride=stride, loop_closure=False)) for stride in (0, 3)]
    assert [run.summary["frames_fed"] for run in runs] == [len(sequence), -(-len(sequence) // 4)]
    assert [run.summary["status"] for run in runs] == ["ok", "ok"]
    assert max(run.summary["ate_rmse_m"] for run in runs) < 0.03
    assert runs[0].config["loop_closure"] is False
    assert runs[0].config["run"]["versions"].keys() == {"slamgym", "pyorbslam3", "vocabulary_sha256"}


def test_frames_in_memory_are_bounded(recorded):
    """However long the sequence is, few frames are read ahead of the one that is fed."""
    sequence = recorded[1]
    read, fed = [], []

    def reading(k):
        read.append(k)
        assert len(read) - len(fed) < 10
        return sequence.read_images(k)

    replay(replace(sequence, read_images=reading), params(slam="groundtruth"), fed.append)
    assert len(read) == len(sequence)


def test_run_folder_of_a_replay(recorded, tmp_path):
    done = replay(recorded[1], params(slam="groundtruth", stride=2))
    folder = write_run(done, tmp_path / "run")
    assert {path.name for path in folder.iterdir()} == {
        *("config.yaml", "episode.json", "groundtruth.txt", "estimate.txt", "poses.csv", "fed_frames.txt"),
        *("frames.csv", "map.png", "slam.log"),
    }
    assert yaml.safe_load((folder / "config.yaml").read_text())["stride"] == 2
    assert json.loads((folder / "episode.json").read_text())["sequence"] == "drive"
    frames, poses = (pd.read_csv(folder / name) for name in ("frames.csv", "poses.csv"))
    assert len(frames) == len(recorded[1])
    assert frames["slam_state"].notna().sum() == done.summary["frames_fed"]
    assert frames["speed_mps"].median() == pytest.approx(0.5, abs=0.05)
    assert poses.groupby("trajectory").size().to_dict() == dict.fromkeys(
        ("online", "final"), done.summary["frames_fed"]
    )


def test_crash_in_a_replay_is_an_outcome(recorded, faulty):
    done = replay(recorded[1], params(slam=faulty("Segfaults")))
    assert (done.summary["status"], done.summary["end"]) == ("crashed", "slam_gone")
    assert done.summary["completion"] == 2 / len(recorded[1])
    assert "Segmentation fault" in done.summary["failure"]


def test_image_that_cannot_be_read_ends_the_replay_with_its_name(recorded, children):
    sequence = recorded[1]
    before = children()

    def broken(k):
        if k == 20:
            raise SequenceError("rgb/20.png: expected a PNG image")
        return sequence.read_images(k)

    with pytest.raises(SequenceError, match=r"rgb/20\.png"):
        replay(replace(sequence, read_images=broken), params(slam="groundtruth"))
    assert children() == before


def test_recording_needs_a_new_folder(tmp_path):
    (tmp_path / "there").write_text("")
    env = gym.make("HomeRobot-v0", camera="small", **DRIVE)
    with pytest.raises(OutputError, match="new or empty"):
        record_drive(env, PathFollower(), 7, tmp_path)
    env.close()


def test_final_poses_at_other_stamps_are_a_crash(recorded, faulty):
    done = replay(recorded[1], params(slam=faulty("FinishesWithOtherStamps")))
    assert done.summary["status"] == "crashed"
    assert "has the stamp of a frame" in done.summary["failure"]


def test_holes_of_the_truth_are_not_judged(recorded):
    sequence = recorded[1]
    known = np.arange(len(sequence)) % 2 == 0
    done = replay(replace(sequence, has_truth=known), params(slam="groundtruth"))
    assert done.summary["frames_without_truth"] == (~known).sum()
    assert done.summary["completion"] == 1.0


def test_oracle_needs_a_truth(recorded):
    with pytest.raises(ConfigError, match="expected a sequence with a truth"):
        replay(replace(recorded[1], truth=None), params(slam="wheel_odometry"))


def test_sequence_without_a_truth(recorded, tmp_path):
    sequence = recorded[1]
    unknown = np.full_like(sequence.T_world_cam, np.nan)
    blind = replace(sequence, truth=None, T_world_cam=unknown, has_truth=np.zeros(len(sequence), bool))
    done = replay(blind, params(slam="orbslam3", stride=1))
    assert (done.summary["status"], done.summary["completion"]) == ("ok", 1.0)
    assert np.isnan(done.summary["ate_rmse_m"])
    folder = write_run(done, tmp_path / "run")
    assert not (folder / "groundtruth.txt").exists()
    assert len(pd.read_csv(folder / "frames.csv")) == len(sequence)
