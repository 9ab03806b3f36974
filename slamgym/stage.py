"""A house as the environment needs it: lit, with its occupancy grid and the space that is free for the robot."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from slamgym.errors import SceneError
from slamgym.files import short_hash
from slamgym.params import DriveParams
from slamgym.robot import ROBOT_HEIGHT, ROBOT_RADIUS
from slamgym.scenes.fingerprint import array_sha256, house_sha256
from slamgym.scenes.house import House
from slamgym.scenes.map_server import read_map
from slamgym.scenes.occupancy import OccupancyGrid, free_space, occupancy_grid
from slamgym.scenes.registry import load_scene
from slamgym.types import BoolArray

CLEARANCE_M = 0.05
"""Kept free around the robot when paths are planned."""
KEPT = 2
"""Houses that stay in memory: a reset, or another environment in the same house, needs no loading."""
LEAST_ON_FLOOR = 0.5

Progress = Callable[[float], None]


@dataclass(frozen=True, slots=True, eq=False)
class _Loaded:
    """A house, lit and unlit, its hash, and its own grid or why it has none."""

    house: House
    unlit: House
    sha256: str
    grid: OccupancyGrid | SceneError


_houses: dict[tuple[object, ...], _Loaded] = {}


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """house: as it is drawn. unlit: as it was loaded. free: cells (ny, nx) of the grid where the robot's centre may be.

    versions: hashes of what a drive depends on besides the parameters.
    """

    house: House
    unlit: House
    grid: OccupancyGrid
    free: BoolArray
    versions: dict[str, str]


def load_stage(params: DriveParams, on_progress: Progress | None = None) -> Stage:
    """The stage of the parameters' scene. on_progress: called with the share of the light that is baked, 0 to 1.

    A house stays in memory as long as the scene's own file is unchanged; textures and other files that it names are
    not looked at again by the same process. Raises SceneError, and ConfigError for scene options.
    """
    loaded = _load_house(params, on_progress)
    versions = {"house_sha256": short_hash(loaded.sha256)}
    if params.occupancy_map is not None:
        grid = _given_map(params.occupancy_map, loaded)
        versions["occupancy_map_sha256"] = short_hash(array_sha256(grid.occupied).hex())
    else:
        assert isinstance(loaded.grid, OccupancyGrid)
        grid = loaded.grid
    return Stage(loaded.house, loaded.unlit, grid, free_space(grid, ROBOT_RADIUS + CLEARANCE_M), versions)


def _load_house(params: DriveParams, on_progress: Progress | None) -> _Loaded:
    """The house, from memory where it is among the most recent ones."""
    key = _key(params)
    loaded = _houses.pop(key, None)
    while len(_houses) >= KEPT:
        del _houses[next(iter(_houses))]
    if loaded is None or (isinstance(loaded.grid, SceneError) and params.occupancy_map is None):
        unlit = load_scene(params.scene, params.scene_options)
        grid = _own_grid(unlit)
        if isinstance(grid, SceneError) and params.occupancy_map is None:
            raise grid  # before the work of lighting it
        house = _lit(unlit, on_progress) if params.lighting == "baked" else unlit
        loaded = _Loaded(house, unlit, house_sha256(unlit), grid)
    _houses[key] = loaded
    return loaded


def _own_grid(house: House) -> OccupancyGrid | SceneError:
    """The grid of a house that the robot can drive in; else why it cannot: a given map may stand in for it."""
    try:
        grid = occupancy_grid(house, ROBOT_HEIGHT)
        free_space(grid, ROBOT_RADIUS + CLEARANCE_M)
    except SceneError as error:
        return error
    return grid


def _key(params: DriveParams) -> tuple[object, ...]:
    """What a house depends on; a file that was written anew is another one."""
    source = params.scene_source().source
    state = source.stat() if isinstance(source, Path) else None
    written = (source, state.st_mtime_ns, state.st_size, state.st_ino) if state else source
    return params.scene, repr(sorted(params.scene_options.items())), params.lighting, written


def _lit(house: House, on_progress: Progress | None) -> House:
    from slamgym.scenes.light import baked  # Embree takes a while to import

    return baked(house, on_progress)


def _given_map(path: Path, loaded: _Loaded) -> OccupancyGrid:
    """The map that the user gives; raises SceneError when it lies elsewhere than the house's floor."""
    given, own = read_map(path), loaded.grid
    if isinstance(own, SceneError):
        return given
    share = _share_on_floor(given, own)
    if share < LEAST_ON_FLOOR:
        raise SceneError(
            f"occupancy_map: expected a map of {loaded.house.name}, which reaches {_reach(own)} m, got one that "
            f"reaches {_reach(given)} m, with {share:.0%} of its free cells on free floor; correct its origin"
        )
    return given


def _share_on_floor(given: OccupancyGrid, own: OccupancyGrid) -> float:
    cells = own.cell_of(given.centre_of(np.argwhere(~given.occupied)))
    inside = cells[((cells >= 0) & (cells < own.occupied.shape)).all(axis=1)]
    return float(np.count_nonzero(~own.occupied[tuple(inside.T)])) / max(len(cells), 1)


def _reach(grid: OccupancyGrid) -> str:
    (x, y), (height, width) = grid.origin_xy, np.array(grid.occupied.shape) * grid.resolution_m
    return f"x {x:.1f} to {x + width:.1f}, y {y:.1f} to {y + height:.1f}"
