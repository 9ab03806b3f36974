"""The follower, the real robot and a real house together."""

import numpy as np
import pytest

from slamgym.agents import PathFollower
from slamgym.agents.planner import plan_path
from slamgym.env import END_REACHED_M
from slamgym.eval.drive import distance_to_path
from slamgym.robot import ROBOT_HEIGHT, ROBOT_RADIUS, DifferentialDrive
from slamgym.scenes.occupancy import free_space, occupancy_grid
from slamgym.scenes.registry import load_scene
from slamgym.stage import CLEARANCE_M

FPS = 30


@pytest.fixture(scope="module", params=[0, 5])
def home(request):
    house = load_scene(f"procedural:{request.param}")
    grid = occupancy_grid(house, ROBOT_HEIGHT)
    robot = DifferentialDrive(house)
    yield robot, grid, free_space(grid, ROBOT_RADIUS + CLEARANCE_M)
    robot.close()


@pytest.mark.parametrize("tour", ["one_way", "round_trip"])
@pytest.mark.parametrize(("speed", "turn_rate", "most_m"), [(0.2, 0.8, 0.1), (0.8, 3.2, 0.1), (1.6, 6.4, 0.2)])
@pytest.mark.parametrize("seed", range(2))
def test_drives_its_path_without_a_bump(home, seed, speed, turn_rate, most_m, tour):
    robot, grid, free = home
    path = plan_path(grid, free, 12.0, np.random.default_rng(seed), tour=tour)
    state = robot.reset(*path.xy[0], path.heading_at(0.0))
    info = {"action_scale": (speed, turn_rate)}
    s, driven = 0.0, []
    while s < path.length_m - END_REACHED_M:
        assert len(driven) < 3 * FPS * path.length_m / speed, f"stuck at {s:.2f} of {path.length_m:.2f} m"
        waypoints = path.waypoints(s, state.x, state.y, state.yaw)
        forward, turn = PathFollower().act({"waypoints": waypoints}, info)
        state = robot.step(forward * speed, turn * turn_rate, 1 / FPS)
        assert not state.collided
        driven.append((state.x, state.y))
        s = path.project((state.x, state.y), s)
    assert distance_to_path(np.array(driven), path.xy).max() < most_m
