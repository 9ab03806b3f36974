import subprocess
import sys

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower, Patrol
from slamgym.env import HomeRobotEnv
from slamgym.errors import ConfigError, SceneError
from slamgym.rollout import run_episode
from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.loader import SceneOptions
from slamgym.scenes.registry import SCENES

SMALL = {"camera": "small", "path_length_m": 2.0, "speed": 0.5}


@pytest.fixture(scope="module")
def env():
    env = gym.make("HomeRobot-v0", **SMALL)
    yield env
    env.close()


def drive(env, seed, steps, **reset):
    agent = PathFollower()
    obs, info = env.reset(seed=seed, **reset)
    observations, infos = [obs], [info]
    for _ in range(steps):
        obs, _, _, _, info = env.step(agent.act(obs, info))
        observations.append(obs)
        infos.append(info)
    return observations, infos


def test_making_it_opens_nothing():
    env = HomeRobotEnv(**SMALL)
    assert env._renderer is None
    assert env._robot is None
    with pytest.raises(gym.error.ResetNeeded):
        env.step(np.zeros(2, np.float32))


def test_passes_gymnasiums_checker():
    env = gym.make("HomeRobot-v0", render_mode="rgb_array", **SMALL)
    check_env(env.unwrapped)
    env.close()


@pytest.mark.parametrize("noise", [{}, {"depth_noise": "icl_nuim", "rgb_noise": 3.0, "motion_blur": 0.5}])
def test_same_seed_gives_identical_observations(noise):
    drives = []
    for _ in range(2):
        env = gym.make("HomeRobot-v0", **SMALL, **noise)
        drive(env, 3, 5)  # what happened before the reset must not matter
        drives.append(drive(env, 7, 40))
        env.close()
    (first, first_info), (second, second_info) = drives
    for a, b in zip(first, second, strict=True):
        assert all(np.array_equal(a[key], b[key]) for key in a)
    assert all(np.array_equal(a["T_world_cam"], b["T_world_cam"]) for a, b in zip(first_info, second_info, strict=True))


def test_observations_change_and_share_no_memory(env):
    observations, _ = drive(env, 7, 15)
    for key in ("rgb", "depth", "waypoints"):
        assert not np.array_equal(observations[5][key], observations[15][key])
        assert not np.shares_memory(observations[14][key], observations[15][key])
    kept = observations[0]["rgb"].copy()
    env.step(np.ones(2, np.float32))
    assert np.array_equal(observations[0]["rgb"], kept)


def test_seed_picks_the_path_and_speed_does_not(env):
    paths = {}
    for seed in (1, 2):
        env.reset(seed=seed)
        paths[seed] = env.unwrapped.path.xy
    assert not np.array_equal(paths[1], paths[2])
    fast = gym.make("HomeRobot-v0", **{**SMALL, "speed": 1.5, "fps": 10})
    fast.reset(seed=1)
    assert np.array_equal(fast.unwrapped.path.xy, paths[1])
    fast.close()


def test_first_frame_looks_along_the_path_from_its_start(env):
    obs, info = env.reset(seed=5)
    T_world_cam = info["T_world_cam"]
    assert T_world_cam[:2, 3] == pytest.approx(env.unwrapped.path.xy[0])
    assert T_world_cam[2, 3] == pytest.approx(0.83)
    forward = T_world_cam[:3, 2]
    x, y = obs["waypoints"][0]
    heading = np.arctan2(forward[1], forward[0])
    to_first = np.arctan2(*(env.unwrapped.path.point_at(0.2) - env.unwrapped.path.xy[0])[::-1])
    assert abs(np.arctan2(y, x) - (to_first - heading)) < 0.05
    assert x > 0.1


def test_rewards_sum_to_the_path_and_the_drive_ends_there(env):
    episode = run_episode(env, PathFollower(), seed=4)
    assert episode.summary["return"] == pytest.approx(episode.summary["progress_m"])
    assert episode.summary["progress_m"] == pytest.approx(SMALL["path_length_m"], abs=0.06)
    assert episode.summary["collision_steps"] == 0
    assert episode.summary["speed_reached_share"] > 0.1


def test_patrol_returns_to_its_start(env):
    episode = run_episode(env, Patrol(), seed=4)
    start, end = episode.truth.positions[[0, -1], :2]
    assert np.linalg.norm(end - start) < 0.15
    assert episode.summary["distance_m"] >= 0.9 * SMALL["path_length_m"]


def test_time_limit_truncates():
    env = gym.make("HomeRobot-v0", max_episode_steps=5, **SMALL)
    episode = run_episode(env, PathFollower(), seed=4)
    assert len(episode.steps) == 6
    assert episode.config["max_episode_steps"] == 5
    env.close()


def test_spec_recreates_it(env):
    again = gym.make(env.spec)
    first, _ = env.reset(seed=9)
    second, _ = again.reset(seed=9)
    assert np.array_equal(first["rgb"], second["rgb"])
    again.close()


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_vector_environments(mode, env):
    started = {"vector_kwargs": {"context": "spawn"}} if mode == "async" else {}
    vector = gym.make_vec("HomeRobot-v0", num_envs=2, vectorization_mode=mode, **started, **SMALL)
    obs, _ = vector.reset(seed=[7, 8])
    alone, _ = env.reset(seed=8)
    assert np.array_equal(obs["rgb"][1], alone["rgb"])
    obs, reward, _, _, info = vector.step(np.ones((2, 2), np.float32))
    assert obs["depth"].shape == (2, 240, 320)
    assert reward.shape == (2,)
    assert info["T_world_cam"].shape == (2, 4, 4)
    vector.close()


FORKING = """
import gymnasium as gym, numpy as np, slamgym
PARAMS = {"camera": "small", "path_length_m": 2.0}
vector = gym.make_vec("HomeRobot-v0", num_envs=2, vectorization_mode="async", **PARAMS)
print(vector.reset(seed=1)[0]["rgb"].mean() > 0)
vector.close()
gym.make("HomeRobot-v0", **PARAMS).reset()
vector = gym.make_vec("HomeRobot-v0", num_envs=2, vectorization_mode="async", **PARAMS)
vector.reset(seed=1)
"""


def test_forked_environments_work_unless_the_parent_has_rendered():
    result = subprocess.run([sys.executable, "-c", FORKING], capture_output=True, text=True, timeout=120)
    assert result.stdout.strip() == "True"
    assert "RenderError: cannot render in a process that was forked" in result.stderr


def test_records_a_video(tmp_path):
    env = gym.make("HomeRobot-v0", render_mode="rgb_array", max_episode_steps=10, **SMALL)
    env = gym.wrappers.RecordVideo(env, str(tmp_path), disable_logger=True)
    drive(env, 1, 10)
    env.close()
    assert [file.suffix for file in tmp_path.iterdir()] == [".mp4"]


def test_bad_use_is_told_in_one_line(env):
    with pytest.raises(SceneError, match="did you mean 'procedural'"):
        gym.make("HomeRobot-v0", scene="proceduarl")
    with pytest.raises(ConfigError, match="did you mean 'speed'"):
        gym.make("HomeRobot-v0", sped=1.0)
    with pytest.raises(ConfigError, match="render_mode"):
        gym.make("HomeRobot-v0", render_mode="rgb_aray")
    with pytest.raises(ConfigError, match="did you mean 'round_trip'"):
        env.reset(options={"tour": "roundtrip"})
    env.reset(seed=1)
    with pytest.raises(ConfigError, match="two finite numbers"):
        env.step(np.array([np.nan, 0.0], np.float32))


class Cupboard:
    """A floor of 0.6 x 0.6 m, in which no robot can turn round."""

    Options = SceneOptions
    suffixes = ()

    @staticmethod
    def load(source, options):
        corners = np.array([[0, 0, 0], [0.6, 0, 0], [0.6, 0.6, 0], [0, 0.6, 0]], np.float32)
        faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
        return House("cupboard", (Part("floor", Material("wood"), corners, faces),))


def test_a_house_without_room_is_refused_and_the_environment_can_be_closed(monkeypatch):
    monkeypatch.setitem(SCENES, "cupboard", f"{__name__}:Cupboard")
    env = gym.make("HomeRobotSLAM-v0", scene="cupboard", slam="groundtruth")
    with pytest.raises(SceneError, match="no room for the robot: expected at least"):
        env.reset(seed=0)
    env.close()


def test_noise_and_blur_do_what_they_say():
    quiet = gym.make("HomeRobot-v0", **SMALL)
    noisy = gym.make("HomeRobot-v0", **SMALL, rgb_noise=4.0, depth_noise="icl_nuim")
    (a,), _ = drive(quiet, 2, 0)
    (b,), _ = drive(noisy, 2, 0)
    middle = (a["rgb"] > 30) & (a["rgb"] < 225)
    difference = b["rgb"].astype(float) - a["rgb"]
    assert difference[middle].std() == pytest.approx(4.0, rel=0.1)
    assert 0 < np.median(np.abs(b["depth"] - a["depth"])[a["depth"] > 0]) < 0.05
    blurred = gym.make("HomeRobot-v0", **SMALL, motion_blur=1.0)
    spin = np.array([0.0, 1.0], np.float32)

    def sharpness(env):
        env.reset(seed=2)
        for _ in range(15):
            obs = env.step(spin)[0]
        return np.abs(np.diff(obs["rgb"].astype(float), axis=1)).mean()

    assert sharpness(blurred) < 0.9 * sharpness(quiet)
    for env in (quiet, noisy, blurred):
        env.close()


def test_a_stretch_of_the_path_is_driven_from_rest(env):
    _, (whole,) = drive(env, 7, 0)
    path = env.unwrapped.path
    _, infos = drive(env, 7, 3, options={"stretch_m": (0.5, 1.4)})
    stretch = env.unwrapped.path
    assert (whole["path_length_m"], infos[0]["path_length_m"]) == pytest.approx((2.0, 0.9))
    assert np.allclose(stretch.xy[[0, -1]], path.point_at([0.5, 1.4]))
    assert infos[0]["robot"] == pytest.approx([*path.point_at(0.5), path.heading_at(0.5)])
    assert (infos[0]["progress_m"], infos[0]["speed_mps"], infos[0]["stamp_ns"]) == (0.0, 0.0, 0)
    assert 0.0 < infos[-1]["progress_m"] < 0.02
    episode = run_episode(env, OnStretch(), 7)
    assert (episode.summary["end"], episode.summary["planned_path_m"]) == ("path_driven", pytest.approx(0.9))
    assert episode.config["run"]["reset_options"] == {"stretch_m": (0.5, 1.4)}


class OnStretch(PathFollower):
    reset_options = {"stretch_m": (0.5, 1.4)}  # noqa: RUF012


def test_a_stretch_ends_where_the_path_does(env):
    env.reset(seed=7, options={"stretch_m": [1.5, 99.0]})
    assert env.unwrapped.path.length_m == pytest.approx(0.5)


@pytest.mark.parametrize(
    "stretch_m", [(-0.1, 1.0), (1.0, 1.0), (1.96, 3.0), (5.0, 6.0), (np.nan, 1.0), 1.0, (1.0,), "ab"]
)
def test_what_is_no_stretch_is_refused(env, stretch_m):
    with pytest.raises(ConfigError, match=r"stretch_m: expected two distances along the path of 2.00 m"):
        env.reset(seed=7, options={"stretch_m": stretch_m})


def test_unknown_reset_options_are_refused(env):
    with pytest.raises(ConfigError, match="unknown reset option 'strech_m'; did you mean 'stretch_m'"):
        env.reset(seed=7, options={"strech_m": (0.0, 1.0)})
