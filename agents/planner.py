"""Random tours through a house, planned on its occupancy grid."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from math import ceil
from typing import cast

import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.graph import MCP_Geometric

from slamgym.agents.dubins import Pose, dubins_curves
from slamgym.agents.path import PROJECTION_WINDOW_M, SPACING_M, Path, arc_length
from slamgym.agents.smooth import smooth
from slamgym.errors import ConfigError, SceneError, unknown_word
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.types import BoolArray, FloatArray, IntArray

GOAL_CLEARANCE_M = 0.4
"""Goals are in the open where possible: room enough to turn round in a curve."""
GOAL_DISTANCE_M = 2.5
OBSTACLE_COST = 4.0
OBSTACLE_RANGE_M = 0.15
ROUTE_SIGMAS_M = (0.1, 0.2, 0.3, 0.4)
JOINT_SIGMAS_M = (0.1, 0.2)
JOINT_RADII_M = (0.5, 0.4, 0.33)
JOINT_TRIMS_M = (0.2, 0.5, 0.8)
MIN_LEG_M = 0.3
ROUND_TRIP_ATTEMPTS = 16
ROUND_TRIP_EXCESS = 1.03
LAP_AGAIN_M = 3.0
"""So far a lap goes on beyond its start: enough for ORB-SLAM3 to see it again, from the same side, and close a loop."""


def plan_path(
    grid: OccupancyGrid, free: BoolArray, path_length_m: float, rng: np.random.Generator, tour: str = "one_way"
) -> Path:
    """A smooth path between random goals, with a point every 0.05 m, that depends on its arguments alone.

    free: where the robot's centre may be, from `free_space`; the path stays within half a cell of it.
    tour: "one_way" is exactly `path_length_m` long; "round_trip" ends where it starts and is at least
    that long, mostly a few percent more and at times up to twice that; "lap" is a round trip that then takes its first
    3 m once more, these included in its length, which is at least 6 m.

    Legs lead to goals at least 2.5 m away where the house has them, keep away from obstacles, and are joined by curves;
    where there is no room for a curve the path turns on the spot. Its `goals_m` tell where one leg ends and the next
    begins. Raises SceneError when no such path is found, ConfigError for an unknown tour and for a shorter lap.
    """
    if tour not in TOURS:
        raise ConfigError(unknown_word("tour", tour, TOURS))
    roads = _Roads.of(grid, free)
    if len(roads.goals) < 2:
        raise SceneError("no path: expected free space of at least two cells to drive between, got none")
    return TOURS[tour](roads, path_length_m, rng)


@dataclass(frozen=True, slots=True, eq=False)
class _Roads:
    """cost: of a metre through each cell (ny, nx), -1 where the robot cannot be. goals: cells (G, 2) worth a visit."""

    grid: OccupancyGrid
    free: BoolArray
    cost: FloatArray
    goals: IntArray

    @classmethod
    def of(cls, grid: OccupancyGrid, free: BoolArray) -> "_Roads":
        clearance = distance_transform_edt(free, sampling=grid.resolution_m)
        cost = np.where(free, 1 + OBSTACLE_COST * np.exp(-clearance / OBSTACLE_RANGE_M), -1.0)
        return cls(grid, free, cost, np.argwhere(clearance >= min(GOAL_CLEARANCE_M, clearance.max() / 2)))

    def is_free(self, xy: FloatArray) -> BoolArray:
        """Whether the robot's centre can be at points (..., 2)."""
        row, column = np.moveaxis(np.clip(self.grid.cell_of(xy), 0, np.array(self.free.shape) - 1), -1, 0)
        return cast(BoolArray, self.free[row, column])

    def route(self, start: int, goal: int) -> FloatArray:
        """Cheapest way (P, 2) from one goal to another, by their indices, smoothed."""
        search = MCP_Geometric(self.cost)
        search.find_costs([self.goals[start]], [self.goals[goal]])
        return smooth(self.grid.centre_of(search.traceback(self.goals[goal])), self.is_free, ROUTE_SIGMAS_M)

    def distances(self, start: int) -> FloatArray:
        """Length (G,), metres, of the shortest way from one goal to each."""
        costs, _ = MCP_Geometric(np.where(self.free, self.grid.resolution_m, -1.0)).find_costs([self.goals[start]])
        return cast(FloatArray, costs[tuple(self.goals.T)])

    def far_goal(self, start: int, rng: np.random.Generator) -> int:
        """A random goal at least 2.5 m away as the crow flies, or half as far as the farthest."""
        distance = np.linalg.norm(self.goals - self.goals[start], axis=1) * self.grid.resolution_m
        return int(rng.choice(np.flatnonzero(distance >= min(GOAL_DISTANCE_M, distance.max() / 2))))


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """Legs joined so far: points xy (P, 2). goals_m: distances along it of where one leg ends and the next begins."""

    xy: FloatArray
    goals_m: tuple[float, ...] = ()

    @property
    def length_m(self) -> float:
        return float(arc_length(self.xy)[-1])


def _one_way(roads: _Roads, length_m: float, rng: np.random.Generator) -> Path:
    """A path through random goals, exactly `length_m` long."""
    here = int(rng.integers(len(roads.goals)))
    way = None
    for _ in range(_leg_limit(length_m)):
        goal = roads.far_goal(here, rng)
        way, here = _join(way, roads.route(here, goal), roads), goal
        if way.length_m >= length_m and (path := _finish(way, roads)).length_m >= length_m:
            return path.cut(length_m)
    raise _no_path(length_m)


def _round_trip(roads: _Roads, length_m: float, rng: np.random.Generator, again_m: float = 0.0) -> Path:
    """A path through random goals and back, then its first `again_m` once more, `length_m` long or little more."""
    home = int(rng.integers(len(roads.goals)))
    target_m, found = length_m, []
    for _ in range(ROUND_TRIP_ATTEMPTS):
        path = _finish(_on_again(_loop(roads, home, target_m - again_m, rng), again_m, roads), roads)
        if path.length_m >= length_m:
            found.append(path)
        if length_m <= path.length_m <= length_m * ROUND_TRIP_EXCESS:
            break
        # Joints and smoothing change the length.
        target_m = max(target_m + length_m - path.length_m, again_m + (length_m - again_m) / 2)
    if not found:
        raise _no_path(length_m)
    return min(found, key=lambda path: path.length_m)


def _lap(roads: _Roads, length_m: float, rng: np.random.Generator) -> Path:
    """A round trip that then takes its first LAP_AGAIN_M once more; a shorter one would be far longer than asked."""
    if length_m < 2 * LAP_AGAIN_M:
        raise ConfigError(
            f"path_length_m: expected at least {2 * LAP_AGAIN_M:g} m for a lap, whose first {LAP_AGAIN_M:g} m are "
            f"driven twice, got {length_m:g} m; ask for a longer one, or for a round trip"
        )
    return _round_trip(roads, length_m, rng, LAP_AGAIN_M)


def _loop(roads: _Roads, home: int, length_m: float, rng: np.random.Generator) -> _Way:
    """A way through random goals and back to `home`, about `length_m` long."""
    to_home = roads.distances(home)
    here, way, driven_m = home, None, 0.0
    for _ in range(_leg_limit(length_m)):
        goal = roads.far_goal(here, rng)
        to_goal = roads.distances(here)
        rest = to_goal + to_home - (length_m - driven_m)
        if rest[goal] > 0:
            last = (rest >= 0) & (to_goal > MIN_LEG_M) & (to_home > MIN_LEG_M)
            if last.any():
                goal = int(np.argmin(np.where(last, rest, np.inf)))
                return _join(_join(way, roads.route(here, goal), roads), roads.route(goal, home), roads)
        way, here = _join(way, roads.route(here, goal), roads), goal
        driven_m = way.length_m
    raise _no_path(length_m)


def _on_again(way: _Way, again_m: float, roads: _Roads) -> _Way:
    """The way, and then its first metres once more."""
    return _join(way, way.xy[arc_length(way.xy) <= again_m], roads) if again_m else way


def _join(way: _Way | None, leg: FloatArray, roads: _Roads) -> _Way:
    """The way and then the leg (Q, 2), joined by the shortest free curve, or else by turning on the spot."""
    if way is None:
        return _Way(leg)
    for radius_m in JOINT_RADII_M:
        joined = list(_curved_joints(way, leg, radius_m, roads))
        if joined:
            return min(joined, key=lambda longer: longer.length_m)
    return _Way(np.concatenate([way.xy, leg[1:]]), (*way.goals_m, way.length_m))


def _curved_joints(way: _Way, leg: FloatArray, radius_m: float, roads: _Roads) -> Iterator[_Way]:
    """Way and leg joined by Dubins curves that leave the one and enter the other up to 0.8 m from where they meet.

    The goal is then the middle of the curve.
    """
    for trims in product(JOINT_TRIMS_M, repeat=2):
        i, j = (min(round(t / SPACING_M), len(xy) - 2) for t, xy in zip(trims, (way.xy, leg), strict=True))
        before, after = way.xy[: len(way.xy) - i], leg[j:]
        start, goal = _pose(before[-1], before[-1] - before[-2]), _pose(after[0], after[1] - after[0])
        for curve in dubins_curves(start, goal, radius_m, SPACING_M):
            if roads.is_free(curve).all():
                goal_m = float(arc_length(before)[-1] + arc_length(curve)[-1] / 2)
                yield _Way(np.concatenate([before, curve[1:-1], after]), (*way.goals_m, goal_m))
                break


def _pose(xy: FloatArray, direction: FloatArray) -> Pose:
    return float(xy[0]), float(xy[1]), float(np.arctan2(direction[1], direction[0]))


def _finish(way: _Way, roads: _Roads) -> Path:
    """The way, smoothed; a goal is where it comes nearest to what was one before."""
    rough, path = Path(way.xy), Path(smooth(way.xy, roads.is_free, JOINT_SIGMAS_M))
    scale = path.length_m / rough.length_m
    goals_m = [path.project(rough.point_at(s), max(0.0, s * scale - PROJECTION_WINDOW_M / 2)) for s in way.goals_m]
    return Path(path.xy, np.array(goals_m))


def _leg_limit(length_m: float) -> int:
    return 20 + ceil(2 * length_m)


def _no_path(length_m: float) -> SceneError:
    return SceneError(
        f"no path: expected a tour of {length_m:.2f} m in the free space, found none; "
        "ask for another length, or for a scene with more room"
    )


TOURS: dict[str, Callable[[_Roads, float, np.random.Generator], Path]] = {
    "one_way": _one_way,
    "round_trip": _round_trip,
    "lap": _lap,
}
