from collections.abc import Callable

import numpy as np
import pytest

from slamgym.scenes.occupancy import OccupancyGrid, free_space

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
