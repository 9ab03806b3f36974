import os
import signal

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.errors import ConfigError, SlamError
from slamgym.rollout import run_episode
from slamgym.wrappers import SlamWrapper

SMALL = {"camera": "small", "path_length_m": 1.5, "speed": 0.5}


def make(**params):
    return gym.make("HomeRobotSLAM-v0", **{**SMALL, "slam": "groundtruth", **params})


def steps_of(env, seed=7):
    agent = PathFollower()
    obs, info = env.reset(seed=seed)
    yield obs, 0.0, False, info
    done = False
    while not done:
        obs, reward, terminated, truncated, info = env.step(agent.act(obs, info))
        done = terminated or truncated
        yield obs, reward, done, info


def test_the_oracle_is_perfect():
    env = make()
    episode = run_episode(env, PathFollower(), seed=7)
    env.close()
    summary = episode.summary
    assert (summary["status"], summary["success"], summary["completion"]) == ("ok", True, 1.0)
    assert summary["ate_rmse_m"] < 1e-9
    assert summary["rpe_trans_rmse_m"] < 1e-9
    assert summary["losses"] == []
    assert summary["frames_fed"] == len(episode.steps)


def test_passes_gymnasiums_checker():
    env = make(slam="orbslam3")
    check_env(env, skip_render_check=True)
    env.close()


def test_stride_feeds_every_nth_frame_and_leaves_the_drive_alone():
    runs = {}
    for stride in (0, 2):
        env = make(stride=stride)
        runs[stride] = list(steps_of(env))
        env.close()
    assert len(runs[0]) == len(runs[2])
    for (obs0, _, _, info0), (obs2, _, _, info2) in zip(runs[0], runs[2], strict=True):
        assert np.array_equal(obs0["rgb"], obs2["rgb"])
        assert info0["stamp_ns"] == info2["stamp_ns"]
    fresh = [info["slam"]["fresh"] for _, _, _, info in runs[2]]
    assert fresh == [step % 3 == 0 for step in range(len(fresh))]
    assert runs[2][-1][3]["episode_slam"]["frames_fed"] == sum(fresh)
    events = [info["slam"]["event"] for _, _, _, info in runs[2]]
    assert events.count("initialized") == 1
    poses = [info["slam"]["T_map_cam"] for _, _, _, info in runs[2]]
    assert np.array_equal(poses[3], poses[5])
    assert not np.array_equal(poses[3], poses[6])


def test_info_keeps_its_types_and_holds_no_wall_clock():
    env = make(slam="orbslam3", stride=1)
    for obs, _, done, info in steps_of(env):
        slam = info["slam"]
        assert list(slam) == ["state", "T_map_cam", "map_id", "tracked_points", "fresh", "event"]
        assert slam["state"] in ("not_initialized", "ok", "lost")
        assert slam["T_map_cam"].shape == (4, 4)
        assert np.isnan(slam["T_map_cam"]).all() == (slam["state"] != "ok")
        assert (slam["map_id"] == -1) == (slam["state"] != "ok")
        assert obs["slam_state"] == ("not_initialized", "ok", "lost").index(slam["state"])
        assert ("episode_slam" in info) == done
    env.close()


def test_tracking_reward_counts_untracked_frames(faulty):
    rewards = {}
    for reward in ("progress", "tracking"):
        env = make(slam=faulty("LosesEveryThird"), reward=reward)
        steps = list(steps_of(env))
        env.close()
        rewards[reward] = np.array([reward for _, reward, _, _ in steps[1:]])
        lost = np.array([info["slam"]["state"] == "lost" for _, _, _, info in steps[1:]])
    assert lost.any()
    assert rewards["progress"] - rewards["tracking"] == pytest.approx(lost.astype(float))


def test_killed_slam_ends_the_episode_and_the_next_one_is_right():
    env = make(slam="orbslam3", path_length_m=3.0)
    agent = PathFollower()
    obs, info = env.reset(seed=7)
    for _ in range(20):
        obs, _, terminated, _, info = env.step(agent.act(obs, info))
        assert not terminated
    os.kill(env.get_wrapper_attr("slam_pid"), signal.SIGKILL)
    obs, _, terminated, truncated, info = env.step(agent.act(obs, info))
    assert terminated
    assert not truncated
    assert info["slam"]["event"] == "crashed"
    assert info["episode_slam"]["status"] == "crashed"
    assert info["episode_slam"]["ate_online_rmse_m"] < 0.1
    episode = run_episode(env, agent, seed=7)
    assert episode.summary["status"] == "ok"
    assert episode.summary["ate_rmse_m"] < 0.05
    env.close()


def test_hanging_slam_ends_with_timeout(faulty):
    env = make(slam=faulty("Sleeps"), slam_timeout_s=0.5)
    *_, (_, _, done, info) = steps_of(env)
    assert done
    assert info["episode_slam"]["status"] == "timeout"
    env.close()


def test_no_process_outlives_the_environment(children):
    before = children()
    env = make()
    run_episode(env, PathFollower(), seed=7)
    env.reset(seed=8)
    assert children() - before
    env.close()
    env.close()
    assert children() == before


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_vector_environments(mode):
    # A process that has rendered cannot be forked into one that renders.
    started = {"vector_kwargs": {"context": "spawn"}} if mode == "async" else {}
    vector = gym.make_vec("HomeRobotSLAM-v0", num_envs=2, vectorization_mode=mode, **started, **SMALL)
    obs, info = vector.reset(seed=[7, 7])  # this view has the 500 features that ORB-SLAM3 wants to begin
    for _ in range(5):
        obs, _, _, _, info = vector.step(np.full((2, 2), [1.0, 0.0], np.float32))
    vector.close()
    assert obs["slam_state"].tolist() == [1, 1]
    assert info["slam"]["T_map_cam"].shape == (2, 4, 4)
    assert list(info["slam"]["state"]) == ["ok", "ok"]


def test_spec_recreates_it():
    env = make(stride=1, max_episode_steps=6)
    again = gym.make(env.spec)
    assert again.get_wrapper_attr("slam_params") == env.get_wrapper_attr("slam_params")
    results = [list(steps_of(one))[-1][3] for one in (env, again)]
    assert results[0]["episode_slam"]["frames_fed"] == results[1]["episode_slam"]["frames_fed"] == 4
    env.close()
    again.close()


def test_wraps_by_hand():
    env = SlamWrapper(gym.make("HomeRobot-v0", **SMALL), slam="groundtruth", stride=3)
    assert run_episode(env, PathFollower(), seed=1).summary["status"] == "ok"
    env.close()
    for wrong in (gym.make("CartPole-v1"), make()):
        with pytest.raises(ConfigError, match="expected a HomeRobot environment without a SLAM"):
            SlamWrapper(wrong)


@pytest.mark.parametrize(
    ("params", "error", "message"),
    [
        ({"slam": "orbslam"}, ConfigError, "did you mean 'orbslam3'"),
        ({"slam": "orbslam3", "slam_options": {"feature": 1}}, ConfigError, "did you mean 'features'"),
        ({"slam": "orbslam3", "slam_options": {"vocabulary": "/nonexistent/voc.txt"}}, SlamError, "/nonexistent"),
        ({"slam": "groundtruth", "loop_closure": True}, ConfigError, "loop_closure"),
        ({"slam": "json:dumps"}, ConfigError, "without"),
        ({"slam": ":"}, ConfigError, "module:class"),
        ({"slam_sync": "lock"}, ConfigError, "did you mean 'lockstep'"),
        ({"stride": -1}, ConfigError, "got -1"),
    ],
)
def test_bad_input_is_refused_when_it_is_made(params, error, message):
    with pytest.raises(error, match=message) as caught:
        make(**params)
    assert "\n" not in str(caught.value)


def test_a_concluded_or_failed_episode_takes_no_more_steps():
    env = make(max_episode_steps=3)
    *_, (_, _, done, _) = steps_of(env)
    assert done
    with pytest.raises(gym.error.ResetNeeded):
        env.step(np.zeros(2, np.float32))
    with pytest.raises(ConfigError):
        env.reset(options={"tour": "nowhere"})
    with pytest.raises(gym.error.ResetNeeded):
        env.step(np.zeros(2, np.float32))
    assert run_episode(env, PathFollower(), seed=1).summary["end"] == "truncated"
    env.close()
