"""The real ORB-SLAM3 loses track for a known reason: the losses that are told, and controls that have none."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import slamgym  # noqa: F401  registers the environments
from slamgym.agents import PathFollower
from slamgym.camera import CAMERAS
from slamgym.eval.datasets import read_sequence
from slamgym.eval.episode import summarize_slam
from slamgym.geometry import mast_camera_pose
from slamgym.recording import record_drive
from slamgym.render import Renderer
from slamgym.rollout import run_episode
from slamgym.scenes.house import House, Material, Part
from slamgym.slam.backend import SlamConfig
from slamgym.slam.record import SlamRun, run_sequence
from slamgym.slam.session import SlamSession
from slamgym.types import Frame

FPS = 15
CAMERA = CAMERAS["default"]


def slam_over(frames):
    with SlamSession("orbslam3", SlamConfig(CAMERA, FPS), "lockstep") as session:
        return summarize_slam(run_sequence(SlamRun(session), frames))


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Some 13 s through a house."""
    folder = tmp_path_factory.mktemp("drive") / "frames"
    env = gym.make("HomeRobot-v0", speed=0.4, path_length_m=5.0, fps=FPS)
    record_drive(env, PathFollower(), 7, folder)
    env.close()
    return read_sequence(folder)


def stopping(sequence, stop, seconds, *, covered):
    """The frames of a robot that stands still for a while at frame `stop`, its camera `covered` or not."""
    waits = round(seconds * FPS)
    for k, number in enumerate([*range(stop), *[stop] * waits, *range(stop, len(sequence))]):
        frame = replace(sequence.frame(number), stamp_ns=round(k * 1e9 / FPS))
        dark = covered and stop <= k < stop + waits
        yield replace(frame, rgb=0 * frame.rgb, depth=0 * frame.depth) if dark else frame


STOP = 130


def test_control_that_only_stops(drive):
    summary = slam_over(stopping(drive, STOP, 6.0, covered=False))
    assert (summary["status"], summary["losses"], summary["maps"]) == ("ok", [], 1)


def test_blackout_of_2_s_is_found_again(drive):
    summary = found_again(drive)
    # Right after it was found again, ORB-SLAM3 at times slips once more.
    loss, *slips = summary["losses"]
    assert loss["end_frame"] == STOP + 29
    assert loss["duration_s"] == pytest.approx(2.0)
    assert loss["distance_m"] == pytest.approx(0.0, abs=1e-6)
    assert all(STOP + 30 < slip["start_frame"] < STOP + 45 for slip in slips)
    assert (summary["status"], summary["maps"], summary["success"]) == ("ok", 1, False)


def found_again(drive):
    """The first of three runs in which ORB-SLAM3 finds itself again: now and then it does not, and begins a new map."""
    for _ in range(3):
        summary = slam_over(stopping(drive, STOP, 2.0, covered=True))
        loss = summary["losses"][0]
        assert (loss["start_frame"], loss["context"]["cause"]) == (STOP, "dark")
        if loss["outcome"] == "relocalized":
            return summary
    raise AssertionError("began a new map in each of three runs")


def test_blackout_of_6_s_begins_a_new_map(drive):
    summary = slam_over(stopping(drive, STOP, 6.0, covered=True))
    (loss,) = summary["losses"]
    assert (loss["start_frame"], loss["end_frame"], loss["outcome"]) == (STOP, STOP + 89, "new_map")
    assert loss["duration_s"] == pytest.approx(6.0)
    assert loss["context"]["cause"] == "dark"
    assert (summary["status"], summary["maps"]) == ("ok", 2)


class QuickTurn(PathFollower):
    """Turns as fast as it can for `TURNING` frames, then finds back to its path."""

    TURNING = range(60, 70)

    def act(self, obs, info):
        turns = round(info["stamp_ns"] * 1e-9 * FPS) in self.TURNING
        return np.array([0.0, 1.0], np.float32) if turns else super().act(obs, info)


@pytest.mark.parametrize("agent", [PathFollower(), QuickTurn()])
def test_quick_turn(agent):
    # Rich textures, so that the young map has enough to be found again by.
    params = {"scene_options": {"texture": 2.0}, "speed": 0.3, "turn_rate": 12.0, "path_length_m": 2.5, "fps": FPS}
    env = gym.make("HomeRobotSLAM-v0", max_episode_steps=150, **params)
    episode = run_episode(env, agent, 7)
    env.close()
    losses = episode.summary["losses"]
    if isinstance(agent, QuickTurn):
        assert losses[0]["start_frame"] in range(60, 75)  # in the turn, or on the way back
        assert losses[0]["outcome"] == "relocalized"
        assert losses[0]["context"]["rotation_rate_degps"] > 200
        assert losses[0]["context"]["cause"] in ("fast_turn", "low_overlap")
        assert losses[0]["rotation_deg"] > 90
    else:
        assert losses == []
    assert (episode.summary["status"], episode.summary["maps"]) == ("ok", 1)


def wall(blank_from, blank_to):
    """A wall along y at x = 2 m, papered with a random pattern but for a stretch, and the drive along it."""
    pattern = np.random.default_rng(0).integers(0, 256, (64, 64, 3), dtype=np.uint8)
    papered, plain = Material("paper", texture=np.kron(pattern, np.ones((4, 4, 1), np.uint8))), Material("plain")
    stretches = [(papered, -3.0, blank_from), (plain, blank_from, blank_to), (papered, blank_to, 12.0)]
    return House("wall", tuple(stretch(*one) for one in stretches if one[1] < one[2]))


def stretch(material, y_begin, y_end):
    corners = [[2.0, y_begin, 0.0], [2.0, y_end, 0.0], [2.0, y_end, 3.0], [2.0, y_begin, 3.0]]
    uv = [[y_begin / 2, 0.0], [y_end / 2, 0.0], [y_end / 2, 1.5], [y_begin / 2, 1.5]]
    faces = [[0, 2, 1], [0, 3, 2]]
    return Part(
        material.name, material, np.array(corners, np.float32), np.array(faces, np.int32), np.array(uv, np.float32)
    )


def along(house, metres, speed):
    """Frames of a camera 2 m before the wall that looks at it and moves along."""
    with Renderer(house, CAMERA, "flat") as renderer:
        for k in range(round(metres / speed * FPS)):
            pose = mast_camera_pose(0.0, k * speed / FPS, 0.0, 1.2)
            yield Frame(round(k * 1e9 / FPS), *renderer.render(pose), pose)


def test_drive_along_a_blank_wall():
    """The view is 2.8 m wide: at 0.5 m/s nothing but plain wall is in it from y = 4.4 m, frame 132, to 5.6 m."""
    summary = slam_over(along(wall(3.0, 7.0), 9.0, 0.5))
    (loss,) = summary["losses"]
    assert 100 < loss["start_frame"] <= 133
    assert 167 < loss["end_frame"] < 260
    assert loss["context"]["cause"] == "few_keypoints"
    assert loss["context"]["keypoints"] < 0.3 * loss["context"]["usual_keypoints"] or loss["context"]["keypoints"] < 300


def test_control_along_a_papered_wall():
    summary = slam_over(along(wall(3.0, 3.0), 9.0, 0.5))
    assert (summary["status"], summary["losses"], summary["maps"]) == ("ok", [], 1)
