import json
import os
import signal

import gymnasium as gym
import numpy as np
import pytest
import yaml

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.errors import OutputError
from slamgym.eval.accuracy import ate
from slamgym.eval.drive import summarize_drive
from slamgym.eval.episode import summarize_slam
from slamgym.eval.evaluation import evaluate
from slamgym.eval.summary import without_nan
from slamgym.eval.trajectories import read_stamps, read_tum
from slamgym.rollout import EpisodeInterrupted, run_episode
from slamgym.run_folder import write_run


@pytest.fixture(scope="module")
def episode():
    env = gym.make("HomeRobotSLAM-v0", speed=0.4, path_length_m=3.0)
    yield run_episode(env, PathFollower(), seed=7)
    env.close()


def test_real_orbslam3_tracks_a_drive_through_a_house(episode):
    assert episode.summary["status"] == "ok"
    assert episode.summary["completion"] == 1.0
    assert 0.0 < episode.summary["ate_rmse_m"] < 0.05
    assert 0.0 < episode.summary["ate_online_rmse_m"] < 0.05
    assert 0.0 < episode.summary["rpe_step_trans_rmse_m"] < 0.02
    assert episode.summary["tracked_points_median"] > 100
    assert episode.summary["frames_fed"] == len(episode.steps)


def test_run_folder_says_the_same_as_the_episode(episode, tmp_path):
    folder = write_run(episode, tmp_path / "run")
    written = json.loads((folder / "episode.json").read_text())
    assert written["ate_rmse_m"] == episode.summary["ate_rmse_m"]
    assert written["time_to_first_loss_s"] is None  # NaN has no place in JSON
    truth, estimate = read_tum(folder / "groundtruth.txt"), read_tum(folder / "estimate.txt")
    np.testing.assert_array_equal(read_stamps(folder / "fed_frames.txt"), episode.slam.stamps_ns)
    at = np.searchsorted(truth.stamps_ns, estimate.stamps_ns)
    assert np.array_equal(truth.stamps_ns[at], estimate.stamps_ns)
    assert ate(truth.T[at], estimate.T).trans_m.rmse == pytest.approx(written["ate_rmse_m"], abs=1e-7)
    # Optical frame: the camera's y axis points down.
    assert truth.T[:, 2, 1] == pytest.approx(-1.0)


def test_the_files_of_a_run_folder_evaluate_to_what_its_results_say(episode, tmp_path):
    folder = write_run(episode, tmp_path / "run")
    written = json.loads((folder / "episode.json").read_text())
    truth, estimate = read_tum(folder / "groundtruth.txt"), read_tum(folder / "estimate.txt")
    again = without_nan(evaluate(truth, estimate, frames_ns=read_stamps(folder / "fed_frames.txt")).summary)
    common = (written.keys() & again.keys()) - {"distance_m"}  # of the drive along the floor, not of the camera
    figures = {key for key in common if isinstance(written[key], float)}
    assert len(figures) > 35
    assert {key: again[key] for key in figures} == pytest.approx({key: written[key] for key in figures}, abs=1e-4)
    assert {key: again[key] for key in common - figures} == {key: written[key] for key in common - figures}


def test_no_figure_of_an_episode_hides_another(episode):
    drive = summarize_drive(episode.truth.stamps_ns, episode.truth.T, episode.path_xy, 0.4)
    slam = summarize_slam(episode.slam)
    assert not drive.keys() & slam.keys()
    assert episode.config.keys() & episode.summary.keys() == {"map_policy"}
    assert episode.config["map_policy"] == episode.summary["map_policy"]
    assert episode.summary["path_deviation_max_m"] == drive["path_deviation_max_m"]


def test_a_written_config_repeats_the_drive(episode, tmp_path):
    config = yaml.safe_load((write_run(episode, tmp_path / "run") / "config.yaml").read_text())
    run = config.pop("run")
    assert run["agent"] == "slamgym.agents.follower:PathFollower"
    assert set(run["versions"]) == {"slamgym", "house_sha256", "pyorbslam3", "vocabulary_sha256"}
    assert config["slam_options"]["features"] == 1000  # the default, written out
    env = gym.make(run["env_id"], **{**config, "slam": "groundtruth", "slam_options": {}})
    again = run_episode(env, PathFollower(), run["seed"])
    env.close()
    assert np.array_equal(again.truth.T, episode.truth.T)


def test_existing_results_are_never_overwritten(episode, tmp_path):
    write_run(episode, tmp_path / "run")
    with pytest.raises(OutputError, match="new or empty"):
        write_run(episode, tmp_path / "run")
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


def test_interrupt_hands_over_what_was_driven(tmp_path):
    class Impatient(PathFollower):
        def act(self, obs, info):
            if info["progress_m"] > 0.3:
                raise KeyboardInterrupt
            return super().act(obs, info)

    env = gym.make("HomeRobotSLAM-v0", camera="small", slam="groundtruth")
    with pytest.raises(EpisodeInterrupted) as interrupted:
        run_episode(env, Impatient(), seed=1)
    env.close()
    episode = interrupted.value.episode
    assert episode.summary["end"] == "interrupted"
    assert 0.3 < episode.summary["progress_m"] < 0.4
    assert episode.summary["frames_fed"] == len(episode.steps)
    assert write_run(episode, tmp_path / "run").name == "run.interrupted"
    assert write_run(episode, tmp_path / "run").name == "run.interrupted-2"


def test_ctrl_c_waits_for_the_step_to_end():
    class Signalling(PathFollower):
        def act(self, obs, info):
            if info["progress_m"] > 0.1:
                os.kill(os.getpid(), signal.SIGINT)
            return super().act(obs, info)

    env = gym.make("HomeRobotSLAM-v0", camera="small", slam="groundtruth")
    with pytest.raises(EpisodeInterrupted) as interrupted:
        run_episode(env, Signalling(), seed=1)
    env.close()
    episode = interrupted.value.episode
    assert episode.summary["frames_fed"] == len(episode.steps)
    assert episode.summary["completion"] == 1.0
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_parameters_of_any_type_are_written(tmp_path):
    env = gym.make("HomeRobot-v0", camera="small", speed=np.float64(0.5), path_length_m=np.int64(1))
    folder = write_run(run_episode(env, PathFollower(), seed=1), tmp_path / "run")
    env.close()
    assert yaml.safe_load((folder / "config.yaml").read_text())["speed"] == 0.5
    assert not (folder / "estimate.txt").exists()
