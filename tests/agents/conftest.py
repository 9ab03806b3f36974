from collections.abc import Callable
from math import cos, sin

import numpy as np
import pytest

from slamgym.scenes.occupancy import OccupancyGrid, free_space

FPS = 30
SUBSTEP = 1 / 240
Flat = tuple[OccupancyGrid, np.ndarray]


def rooms(seed: int) -> OccupancyGrid:
    """2 x 3 rooms of 2.6 to 4 m, doors of 0.8 m between all neighbours, and furniture along the walls."""
    rng = np.random.default_rng(seed)
    width, height = rng.integers(52, 80, 3), rng.integers(52, 80, 2)
    x, y = (np.concatenate([[2], 2 + np.cumsum(size + 2)]) for size in (width, height))
    occupied = np.ones((y[-1], x[-1]), dtype=bool)
    for i in range(3):
        for j in range(2):
            room = occupied[y[j] : y[j] + height[j], x[i] : x[i] + width[i]]
            room[:] = False
            room[: rng.integers(8, 20), : rng.integers(8, 24)] = True
            room[-rng.integers(8, 20) :, -rng.integers(8, 24) :] = True
    for i in range(3):
        middle = x[i] + width[i] // 2
        occupied[y[1] - 3 : y[1] + 1, middle : middle + 16] = False
    for i in (1, 2):
        for j in range(2):
            middle = y[j] + height[j] // 2 - 8
            occupied[middle : middle + 16, x[i] - 3 : x[i] + 1] = False
    return OccupancyGrid(occupied, np.array([-3.0, 1.0]), 0.05)


@pytest.fixture(scope="session")
def flat() -> Callable[[int], Flat]:
    """A function that makes, of a seed, the grid of a flat and its free space for a robot of radius 0.25 m."""

    def make(seed: int) -> Flat:
        grid = rooms(seed)
        return grid, free_space(grid, 0.25)

    return make


@pytest.fixture(scope="session")
def corridor() -> Flat:
    """A corridor of 6 x 0.9 m: no room to turn round in a curve."""
    occupied = np.ones((24, 126), dtype=bool)
    occupied[3:21, 3:123] = False
    grid = OccupancyGrid(occupied, np.zeros(2), 0.05)
    return grid, free_space(grid, 0.25)


@pytest.fixture(scope="session")
def drive():
    """A function that drives an agent along a path, as a robot with 1 m/s^2 and 6 rad/s^2 does, and gives for each
    frame x, y, speed, progress and yaw. slam: what info["slam"] is at a progress.
    """
    return _drive


def _drive(path, agent, speed, turning_radius_m=0.25, slam=None, fps=FPS):
    (x, y), yaw = path.xy[0], path.heading_at(0.0)
    v = w = s = 0.0
    turn_rate = speed / turning_radius_m
    frames = [(x, y, v, s, yaw)]
    most_s = 5 * path.length_m / speed + 10 + 10 * len(path.goals_m) * 2 * np.pi / turn_rate
    for step in range(int(most_s * fps)):
        info = {
            "action_scale": np.array([speed, turn_rate]),
            "stamp_ns": round(step * 1e9 / fps),
            "robot": np.array([x, y, (yaw + np.pi) % (2 * np.pi) - np.pi]),
            "progress_m": s,
            "goal_m": path.next_goal(s) - s,
        }
        if slam is not None:
            info["slam"] = slam(s)
        forward, turn = agent.act({"waypoints": path.waypoints(s, x, y, yaw)}, info)
        for _ in range(round(1 / fps / SUBSTEP)):
            v = _approach(v, forward * speed, 1.0 * SUBSTEP)
            w = _approach(w, turn * turn_rate, 6.0 * SUBSTEP)
            x += v * cos(yaw + w * SUBSTEP / 2) * SUBSTEP
            y += v * sin(yaw + w * SUBSTEP / 2) * SUBSTEP
            yaw += w * SUBSTEP
        s = path.project((x, y), s)
        frames.append((x, y, v, s, yaw))
        if s >= path.length_m - 0.05:
            return np.array(frames)
    pytest.fail(f"stuck at {s:.2f} of {path.length_m:.2f} m")


def _approach(value, target, step):
    return value + np.clip(target - value, -step, step)
