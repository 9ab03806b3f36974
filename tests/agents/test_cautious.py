import numpy as np
import pytest

from slamgym.agents import Cautious, PathFollower
from slamgym.agents.path import Path, resample
from slamgym.errors import ConfigError

STRAIGHT = {"waypoints": np.stack([0.2 * np.arange(1.0, 6), np.zeros(5)], axis=1)}
BEND = {"waypoints": np.array([(0.2, 0.02), (0.4, 0.08), (0.55, 0.2), (0.65, 0.36), (0.7, 0.55)])}


def info(points, state="ok", stamp_ns=1, fresh=True):
    slam = {"state": state, "tracked_points": points, "fresh": fresh}
    return {"action_scale": np.array([0.2, 0.8]), "stamp_ns": stamp_ns, "slam": slam}


def used_to(*counts):
    agent = Cautious()
    for points in counts:
        agent.act(STRAIGHT, info(points))
    return agent


# Full speed down to half the usual 200, then in proportion, never below a fifth.
@pytest.mark.parametrize(("points", "forward"), [(400, 1.0), (200, 1.0), (100, 1.0), (50, 0.5), (30, 0.3), (5, 0.2)])
def test_speed_falls_with_the_tracked_points(points, forward):
    agent = used_to(200, 180, 220, 210, 190)
    action = agent.act(STRAIGHT, info(points))
    assert action.dtype == np.float32
    assert action == pytest.approx([forward, 0.0], abs=1e-6)


@pytest.mark.parametrize("state", ["not_initialized", "lost"])
def test_it_creeps_while_the_slam_is_not_tracking(state):
    assert used_to(200).act(STRAIGHT, info(200, state))[0] == pytest.approx(0.2)


def test_frames_that_the_slam_did_not_see_count_for_nothing():
    agent = used_to(200, 200, 200)
    for _ in range(10):
        agent.act(STRAIGHT, info(40, fresh=False))
        agent.act(STRAIGHT, info(40, "lost"))
    assert agent.act(STRAIGHT, info(40))[0] == pytest.approx(0.4)


def test_what_is_usual_is_that_of_this_episode():
    agent = used_to(1000, 1000, 1000)
    assert agent.act(STRAIGHT, info(100))[0] == pytest.approx(0.2)
    assert agent.act(STRAIGHT, info(100, stamp_ns=0))[0] == 1.0


def test_a_slam_that_counts_no_points_is_taken_at_its_word():
    assert used_to(0, 0).act(STRAIGHT, info(0))[0] == 1.0


def test_it_takes_the_same_curve_slower():
    forward, turn = PathFollower().act(BEND, info(100))
    slow_forward, slow_turn = used_to(200, 200, 200).act(BEND, info(50))
    assert turn > 0.1
    assert slow_forward / forward == pytest.approx(0.5)
    assert slow_turn / turn == pytest.approx(0.5)


def test_in_a_loop_it_is_slow_just_where_tracking_is_poor(drive):
    path = Path(resample(np.array([(0.0, 0), (3, 0), (3, 3), (0, 3)])))
    slam = lambda s: {"state": "ok", "tracked_points": 30 if 4 < s < 5 else 200, "fresh": True}  # noqa: E731
    frames = drive(path, Cautious(), 0.8, slam=slam)
    poor = (frames[:, 3] > 4.4) & (frames[:, 3] < 5)
    assert frames[poor, 2] == pytest.approx(0.8 * 0.3, abs=0.02)
    assert np.median(frames[frames[:, 3] < 4, 2]) == pytest.approx(0.8, abs=0.01)


def test_it_needs_a_slam():
    with pytest.raises(ConfigError, match="expected a SLAM in the loop"):
        Cautious().act(STRAIGHT, {"action_scale": np.array([0.2, 0.8]), "stamp_ns": 0})
