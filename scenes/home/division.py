"""Dividing a rectangle into a home of a given size: corridors, and a recursive division into rooms."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.home.doorways import choose_doorways
from slamgym.scenes.home.floorplan import Cell, FloorPlan
from slamgym.scenes.home.walls import planned_rooms

_MIN_SIDE = 2.15
_MAX_ASPECT = 2.1
_CORRIDOR = 1.4
_ATTEMPTS = 2000

Division = tuple[list[Cell], list[str]]


@dataclass(frozen=True, slots=True)
class HomeSize:
    """Ranges of the outline's sides, metres, the ways to divide it, and the areas that kinds of rooms may have, m2."""

    width: tuple[float, float]
    depth: tuple[float, float]
    divisions: tuple[Callable[[np.random.Generator, Cell], Division], ...]
    areas: dict[str, tuple[float, float]]
    other_areas: tuple[float, float]


def make_floor_plan(rng: np.random.Generator, size: str = "medium") -> FloorPlan:
    """A home of a size in SIZES, all reachable without crossing a bathroom; SceneError if none is found."""
    home = SIZES[size]
    divide = home.divisions[int(rng.integers(len(home.divisions)))]
    for _ in range(_ATTEMPTS):
        width, depth = float(rng.uniform(*home.width)), float(rng.uniform(*home.depth))
        outline = Cell(0.0, 0.0, width, depth)
        cells, kinds = divide(rng, outline)
        if not all(_habitable(c, kind, home) for c, kind in zip(cells, kinds, strict=True)):
            continue
        if doorways := choose_doorways(rng, cells, kinds):
            height = float(rng.uniform(2.5, 2.6))
            return FloorPlan(width, depth, height, planned_rooms(rng, outline, cells, kinds, doorways), doorways)
    raise SceneError(f"procedural house: expected a floor plan within {_ATTEMPTS} attempts, got none; try another seed")


def _habitable(cell: Cell, kind: str, home: HomeSize) -> bool:
    short, long = sorted(cell.sides)
    smallest, largest = home.areas.get(kind, home.other_areas)
    return kind == "hall" or (short >= _MIN_SIDE and long / short <= _MAX_ASPECT and smallest <= cell.area <= largest)


def _open_plan(rng: np.random.Generator, outline: Cell) -> Division:
    cells = _divide(rng, outline, int(rng.integers(4, 6)))
    return cells, _kinds(cells)


def _four_rooms(rng: np.random.Generator, outline: Cell) -> Division:
    cells = _divide(rng, outline, 4)
    return cells, _kinds(cells)


def _with_corridor(rng: np.random.Generator, outline: Cell) -> Division:
    """Rooms on both sides of a corridor from west to east; the last cell is the corridor."""
    south = outline.y_min + (outline.y_max - outline.y_min - _CORRIDOR) * float(rng.uniform(0.42, 0.58))
    north = south + _CORRIDOR
    cells = _divide(rng, Cell(outline.x_min, outline.y_min, outline.x_max, south), int(rng.integers(2, 4)))
    cells += _divide(rng, Cell(outline.x_min, north, outline.x_max, outline.y_max), int(rng.integers(2, 4)))
    corridor = Cell(outline.x_min, south, outline.x_max, north)
    return [*cells, corridor], [*_kinds(cells), "hall"]


def _with_branched_corridor(rng: np.random.Generator, outline: Cell) -> Division:
    """A corridor from west to east and one that leaves it northwards; the last two cells are the corridors."""
    south = outline.y_min + float(rng.uniform(3.4, 4.2))
    north = south + _CORRIDOR
    west = outline.x_min + outline.sides[0] * float(rng.uniform(0.42, 0.58)) - _CORRIDOR / 2
    east = west + _CORRIDOR
    cells = _divide(rng, Cell(outline.x_min, outline.y_min, outline.x_max, south), int(rng.integers(3, 5)))
    cells += _divide(rng, Cell(outline.x_min, north, west, outline.y_max), 2)
    cells += _divide(rng, Cell(east, north, outline.x_max, outline.y_max), int(rng.integers(2, 4)))
    corridors = [Cell(outline.x_min, south, outline.x_max, north), Cell(west, north, east, outline.y_max)]
    return [*cells, *corridors], [*_kinds(cells, _LARGE_KINDS), "hall", "hall"]


def _divide(rng: np.random.Generator, cell: Cell, count: int) -> list[Cell]:
    """Halves the longer side again and again until there are `count` cells."""
    if count == 1:
        return [cell]
    first = int(rng.integers(1, count))
    share = first / count * float(rng.uniform(0.75, 1.3))
    if cell.sides[0] >= cell.sides[1]:
        x = cell.x_min + share * cell.sides[0]
        halves = Cell(cell.x_min, cell.y_min, x, cell.y_max), Cell(x, cell.y_min, cell.x_max, cell.y_max)
    else:
        y = cell.y_min + share * cell.sides[1]
        halves = Cell(cell.x_min, cell.y_min, cell.x_max, y), Cell(cell.x_min, y, cell.x_max, cell.y_max)
    return _divide(rng, halves[0], first) + _divide(rng, halves[1], count - first)


_KINDS = ("living_room", "bedroom", "kitchen", "study", "bedroom")
_LARGE_KINDS = ("living_room", "bedroom", "kitchen", "dining_room", "nursery", "study", "bedroom", "study")


def _kinds(cells: list[Cell], by_size: tuple[str, ...] = _KINDS) -> list[str]:
    """The largest is the living room, the smallest the bathroom."""
    order = sorted(range(len(cells)), key=lambda i: -cells[i].area)
    kinds = [""] * len(cells)
    for i, kind in zip(order, [*by_size[: len(cells) - 1], "bathroom"], strict=True):
        kinds[i] = kind
    return kinds


SIZES: dict[str, HomeSize] = {
    "small": HomeSize(
        (6.4, 7.8), (5.4, 6.6), (_four_rooms,), {"bathroom": (4.6, 8.0), "living_room": (12.0, 20.0)}, (6.5, 16.0)
    ),
    "medium": HomeSize(
        (8.2, 10.5),
        (6.8, 8.5),
        (_with_corridor, _open_plan),
        {"bathroom": (4.8, 10.0), "living_room": (14.0, 32.0)},
        (7.0, 25.0),
    ),
    "large": HomeSize(
        (11.5, 14.5),
        (10.0, 11.8),
        (_with_branched_corridor,),
        {"bathroom": (5.0, 11.0), "living_room": (18.0, 40.0)},
        (7.5, 28.0),
    ),
}
