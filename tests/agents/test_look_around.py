import numpy as np
import pytest

from slamgym.agents import LookAround, PathFollower
from slamgym.agents.path import Path, resample
from slamgym.agents.planner import plan_path

CORNER = resample(np.array([(0.0, 0), (3, 0), (3, 3)]))


def turned_deg(path, frames):
    """Degrees to the left that the robot stands beyond the direction of the path, at each frame, without wrapping."""
    ahead = np.unwrap([path.heading_at(s) for s in frames[:, 3]])
    return np.degrees(frames[:, 4] - ahead)


@pytest.mark.parametrize("speed", [0.05, 0.2, 0.8, 1.6])
def test_it_turns_once_around_at_each_goal(speed, drive):
    path = Path(CORNER, np.array([1.0, 1.5, 4.0]))
    frames = drive(path, LookAround(), speed)
    turned = turned_deg(path, frames)
    half = [np.argmax(turned > 360 * k + 180) for k in range(3)]
    assert frames[half, 3] == pytest.approx(path.goals_m, abs=0.06)
    assert frames[half, 2] == pytest.approx(0, abs=0.01)
    done = [np.argmax(turned > 360 * k + 355) for k in range(3)]
    assert np.linalg.norm(frames[done, :2] - frames[half, :2], axis=1).max() < 0.01
    assert turned[-1] == pytest.approx(3 * 360, abs=3)
    assert turned.max() < 3 * 360 + 50


@pytest.mark.parametrize(("speed", "fps"), [(0.2, 5), (1.0, 5), (0.4, 1)])
def test_few_frames_a_second(speed, fps, drive):
    """Then it may roll past a goal between two frames, and turn by a good part of a circle."""
    path = Path(CORNER, np.array([1.0, 4.0]))
    turned = turned_deg(path, drive(path, LookAround(), speed, fps=fps))
    assert turned[-1] == pytest.approx(2 * 360, abs=90)  # the follower wobbles


def test_a_robot_that_could_turn_by_more_than_half_a_circle_a_frame(drive):
    path = Path(resample(np.array([(0.0, 0), (4, 0)])), np.array([2.0]))
    turned = turned_deg(path, drive(path, LookAround(), 0.4, turning_radius_m=0.05, fps=2))
    assert turned[-1] == pytest.approx(360, abs=20)


@pytest.mark.parametrize("seed", range(3))
def test_on_planned_paths(flat, seed, drive):
    path = plan_path(*flat(seed), 14.0, np.random.default_rng(seed))
    assert len(path.goals_m)
    looked, followed = drive(path, LookAround(), 0.8), drive(path, PathFollower(), 0.8)
    more = looked[-1, 4] - followed[-1, 4]
    assert np.degrees(more) == pytest.approx(360 * len(path.goals_m), abs=25)


def test_where_the_path_turns_back_it_looks_around_first(drive):
    path = Path(resample(np.array([(0.0, 0), (2, 0), (0, 0)])), np.array([2.0]))
    frames = drive(path, LookAround(), 0.2)
    assert np.degrees(abs(frames[-1, 4])) % 360 == pytest.approx(180, abs=5)
    assert np.degrees(np.abs(np.diff(frames[:, 4])).sum()) == pytest.approx(540, abs=25)


def test_a_path_without_goals_is_followed_as_ever(drive):
    path = Path(CORNER)
    assert np.array_equal(drive(path, LookAround(), 0.2), drive(path, PathFollower(), 0.2))


def test_a_new_episode_starts_anew(drive):
    agent, path = LookAround(), Path(CORNER, np.array([1.0]))
    first = drive(path, agent, 0.8)
    assert np.array_equal(drive(path, agent, 0.8), first)
    # Also after one that ended in the middle of a turn.
    halfway = Path(CORNER, np.array([5.94]))
    drive(halfway, agent, 0.8)
    assert np.array_equal(drive(path, agent, 0.8), first)
