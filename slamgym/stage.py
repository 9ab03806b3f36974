"""A house as the environment needs it: lit, with its occupancy grid and the space that is free for the robot."""

from collections.abc import Callable
from dataclasses import dataclass

from slamgym.params import DriveParams
from slamgym.robot import ROBOT_HEIGHT, ROBOT_RADIUS
from slamgym.scenes.house import House
from slamgym.scenes.light import baked
from slamgym.scenes.map_server import read_map
from slamgym.scenes.occupancy import OccupancyGrid, free_space, occupancy_grid
from slamgym.scenes.registry import load_scene
from slamgym.types import BoolArray

CLEARANCE_M = 0.05
"""Kept free around the robot when paths are planned."""
KEPT = 2
"""Stages that stay in memory: a reset, or another environment in the same house, needs no loading."""

_stages: dict[tuple[object, ...], "Stage"] = {}


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """free: cells (ny, nx) of the grid where the robot's centre may be."""

    house: House
    grid: OccupancyGrid
    free: BoolArray


def load_stage(params: DriveParams, on_progress: Callable[[float], None] | None = None) -> Stage:
    """The stage of the parameters' scene. on_progress: called with the share of the light that is baked, 0 to 1.

    Raises SceneError, and ConfigError for scene options.
    """
    key = _key(params)
    if key not in _stages:
        stage = _load(params, on_progress)
        while len(_stages) >= KEPT:
            del _stages[next(iter(_stages))]
        _stages[key] = stage
    return _stages[key]


def _load(params: DriveParams, on_progress: Callable[[float], None] | None) -> Stage:
    house = load_scene(params.scene, params.scene_options)
    given = params.occupancy_map
    grid = occupancy_grid(house, ROBOT_HEIGHT) if given is None else read_map(given)
    free = free_space(grid, ROBOT_RADIUS + CLEARANCE_M)
    return Stage(baked(house, on_progress) if params.lighting == "baked" else house, grid, free)


def _key(params: DriveParams) -> tuple[object, ...]:
    """What a stage depends on; a file that was written anew is another one."""
    files = [path for path in (params.scene_source().source, params.occupancy_map) if not isinstance(path, int | None)]
    states = tuple((path.resolve(), path.stat().st_mtime_ns, path.stat().st_size) for path in files)
    return params.scene, repr(sorted(params.scene_options.items())), params.lighting, states
