"""Random tours through a house, planned on its occupancy grid."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import ceil
from typing import Literal, cast

import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.graph import MCP_Geometric

from slamgym.agents.dubins import Pose, dubins_curves
from slamgym.agents.path import SPACING_M, Path, arc_length
from slamgym.agents.smooth import smooth
from slamgym.errors import SceneError
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.types import BoolArray, FloatArray, IntArray

Tour = Literal["one_way", "round_trip"]

GOAL_CLEARANCE_M = 0.4
"""Goals are in the open where possible: room enough to turn round in a curve."""
GOAL_DISTANCE_M = 2.5
OBSTACLE_COST = 4.0
OBSTACLE_RANGE_M = 0.15
ROUTE_SIGMAS_M = (0.1, 0.2, 0.3, 0.4)
JOINT_SIGMAS_M = (0.05, 0.1)
JOINT_RADII_M = (0.4, 0.3)
JOINT_TRIMS_M = (0.2, 0.5, 0.8)
ROUND_TRIP_ATTEMPTS = 8
ROUND_TRIP_MARGIN = 0.03


def plan_path(
    grid: OccupancyGrid, free: BoolArray, path_length_m: float, rng: np.random.Generator, tour: Tour = "one_way"
) -> Path:
    """A smooth path between random goals, with a point every 0.05 m, that depends on its arguments alone.

    free: where the robot's centre may be, from `free_space`; the path stays within half a cell of it.
    tour: "one_way" is exactly `path_length_m` long; "round_trip" ends where it starts and is that long or little more.

    Legs lead to goals at least 2.5 m away where the house has them, keep away from obstacles, and are joined by curves;
    where there is no room for a curve the path turns on the spot. Raises SceneError when no such path is found.
    """
    planner = _Planner(grid, free)
    if tour == "one_way":
        return planner.one_way(path_length_m, rng).cut(path_length_m)
    return planner.round_trip(path_length_m, rng)


class _Planner:
    """Routes between cells of one free space."""

    def __init__(self, grid: OccupancyGrid, free: BoolArray) -> None:
        self.grid = grid
        self.free = free
        clearance = distance_transform_edt(free, sampling=grid.resolution_m)
        self.cost = np.where(free, 1 + OBSTACLE_COST * np.exp(-clearance / OBSTACLE_RANGE_M), -1.0)
        self.goals = np.argwhere(clearance >= min(GOAL_CLEARANCE_M, 0.7 * clearance.max()))
