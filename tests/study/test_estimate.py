import gymnasium as gym
import pytest

import slamgym  # noqa: F401
from slamgym.agents import AGENTS
from slamgym.recording import record_drive
from slamgym.study import estimate as costs
from slamgym.study.costs import Costs
from slamgym.study.estimate import estimate
from slamgym.study.plan import plan_study
from slamgym.study.spec import StudySpec

TINY = {"width": 32, "height": 24, "fx": 23.0, "fy": 23.0, "cx": 15.5, "cy": 11.5}


def planned(fixed=None, factors=(), **keys):
    paths = [{"scene": "procedural:1", "seeds": [1]}]
    return plan_study(
        StudySpec.checked({"name": "s", "paths": paths, "fixed": fixed or {}, "factors": factors, **keys})
    )


def test_frames_are_told_by_length_speed_and_rate():
    # 5 m at 0.5 m/s are 10 s, 20 frames each second and the first one.
    about = estimate(planned({"path_length_m": 5, "speed": 0.5, "fps": 20}, [{"stride": [0, 1, 3]}], repeats=2))
    assert (about.drives, about.runs, about.frames_rendered) == (1, 6, 201)
    assert about.frames_fed == 2 * (201 + 101 + 51)


def test_time_and_disk_follow():
    about = estimate(planned({"path_length_m": 5, "speed": 0.5, "fps": 20}, [{"stride": [0, 1]}]))
    seconds = costs.SCENE_S + 201 * costs.RENDER_S + 302 * costs.USUAL_SLAM_S + 2 * costs.RUN_S
    assert about.seconds() == pytest.approx(seconds)
    assert about.seconds(2) == pytest.approx(seconds / 2)
    assert about.seconds(16) == pytest.approx(seconds / 2)  # two runs
    kept = 2 * costs.RUN_BYTES + costs.DRIVE_BYTES
    assert about.disk_bytes(4) == about.disk_bytes(1) == kept + 201 * costs.FRAME_BYTES  # one drive


def test_frames_of_a_worker_each_and_one_ahead_are_kept():
    about = estimate(planned(factors=[{"speed": [0.2, 0.4, 0.8]}]))
    assert about.disk_bytes(2) - about.disk_bytes(1) == about.drive_bytes == (10 / 0.2 * 30 + 1) * costs.FRAME_BYTES


def test_small_images_cost_less():
    small, usual = (estimate(planned({"camera": camera})) for camera in ("small", "default"))
    assert small.drive_bytes * 4 == usual.drive_bytes
    assert (small.render_s - costs.SCENE_S) * 4 == pytest.approx(usual.render_s - costs.SCENE_S)


def test_in_real_time_a_run_takes_as_long_as_its_drive():
    fixed = {"path_length_m": 10, "speed": 1, "fps": 10, "slam_sync": "realtime"}
    about = estimate(planned(fixed, [{"stride": [0, 3]}]))
    assert about.slam_s == pytest.approx(2 * (10.1 + costs.RUN_S))


@pytest.mark.parametrize(
    ("agent", "tour"),
    [("follower", 1.0), ("look_around", 1.0), ("patrol", costs.ROUND_TRIP), ("lap", costs.ROUND_TRIP)],
)
def test_round_trips_are_longer_than_asked_for(agent, tour):
    about = estimate(planned({"agent": agent, "path_length_m": 10, "speed": 0.5, "fps": 20}))
    assert about.frames_rendered == pytest.approx(10 * tour / 0.5 * 20, abs=2)


def test_a_slow_slam_gets_the_time_that_its_own_limits_allow():
    (run,) = planned({"path_length_m": 5, "speed": 0.5, "fps": 20, "slam_timeout_s": 30, "slam_finish_timeout_s": 7})
    assert Costs([run]).limit_s(run) > 201 * 30 + 2 * 7
    assert Costs([run]).limit_s(run.drive) < 201 * 30


def test_a_drive_is_cut_off():
    assert estimate(planned({"max_episode_steps": 50})).frames_rendered == 50
    assert estimate(planned({"path_length_m": 1000, "speed": 0.1})).frames_rendered == 10_000


def test_a_recorded_sequence_is_counted_by_its_lists(sequences):
    about = estimate(planned(factors=[{"stride": [0, 1]}], paths=[{"sequence": [str(folder) for folder in sequences]}]))
    assert (about.drives, about.frames_rendered, about.frames_fed) == (3, 0, 3 * (20 + 10))
    assert about.drive_bytes == 0


@pytest.mark.parametrize(("agent", "speed"), [("follower", 0.6), ("patrol", 2.0)])
def test_it_is_about_as_many_frames_as_are_rendered(tmp_path, agent, speed):
    fixed = {
        "agent": agent,
        "speed": speed,
        "fps": 15,
        "path_length_m": 5,
        "camera": TINY,
        "lighting": "flat",
        "scene_options.size": "small",
    }
    (run,) = planned(fixed)
    env = gym.make("HomeRobot-v0", **run.drive.params)
    try:
        episode = record_drive(env, AGENTS[agent](), run.drive.seed, tmp_path / "frames")
    finally:
        env.close()
    assert estimate([run]).frames_rendered == pytest.approx(len(episode.steps), rel=0.4)
