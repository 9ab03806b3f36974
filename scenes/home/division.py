"""Dividing a rectangle into a home: a recursive division into rooms, doorways that join them, windows."""

from dataclasses import replace
from itertools import combinations

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.home.floorplan import (
    DOOR_FRAME,
    DOOR_HEIGHT,
    DOOR_WIDTH,
    INNER_WALL,
    Cell,
    Doorway,
    FloorPlan,
    Opening,
    PlannedRoom,
    Wall,
)
from slamgym.scenes.house import Room

_MIN_SIDE = 2.15
_MAX_ASPECT = 2.1
_CORRIDOR = 1.4
_DOOR_TO_CORNER = 0.68  # centre of a doorway to the end of the shared wall
_ATTEMPTS = 500
_AREAS = {"bathroom": (4.8, 10.0), "living_room": (14.0, 32.0)}

# How willingly one walks through a room to reach the next.
_PRIVACY = {"hall": 0, "living_room": 1, "kitchen": 2, "study": 3, "bedroom": 4, "bathroom": 9}
_KINDS_BY_SIZE = ("living_room", "bedroom", "kitchen", "study", "bedroom")


def make_floor_plan(rng: np.random.Generator) -> FloorPlan:
    """A home of 4 to 7 rooms, all reachable without crossing the bathroom; SceneError if none is found."""
    divide = _with_corridor if rng.random() < 0.5 else _open_plan
    for _ in range(_ATTEMPTS):
        width, depth = rng.uniform(8.2, 10.5), rng.uniform(6.8, 8.5)
        outline = Cell(0.0, 0.0, width, depth)
        cells, kinds = divide(rng, outline)
        if not all(_habitable(c, kind) for c, kind in zip(cells, kinds, strict=True)):
            continue
        if doorways := _choose_doorways(rng, cells, kinds):
            height = float(rng.uniform(2.5, 2.6))
            return FloorPlan(width, depth, height, _rooms(rng, outline, cells, kinds, doorways), doorways)
    raise SceneError(f"procedural house: expected a floor plan within {_ATTEMPTS} attempts, got none; try another seed")


def _with_corridor(rng: np.random.Generator, outline: Cell) -> tuple[list[Cell], list[str]]:
    """Rooms on both sides of a corridor from west to east; the last cell is the corridor."""
    south = outline.y_min + (outline.y_max - outline.y_min - _CORRIDOR) * float(rng.uniform(0.42, 0.58))
    north = south + _CORRIDOR
    cells = _divide(rng, Cell(outline.x_min, outline.y_min, outline.x_max, south), int(rng.integers(2, 4)))
    cells += _divide(rng, Cell(outline.x_min, north, outline.x_max, outline.y_max), int(rng.integers(2, 4)))
    corridor = Cell(outline.x_min, south, outline.x_max, north)
    return [*cells, corridor], [*_kinds(cells), "hall"]


def _open_plan(rng: np.random.Generator, outline: Cell) -> tuple[list[Cell], list[str]]:
    cells = _divide(rng, outline, int(rng.integers(4, 6)))
    return cells, _kinds(cells)


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


def _kinds(cells: list[Cell]) -> list[str]:
    """The largest is the living room, the smallest the bathroom."""
    order = sorted(range(len(cells)), key=lambda i: -cells[i].area)
    kinds = [""] * len(cells)
    for i, kind in zip(order, [*_KINDS_BY_SIZE[: len(cells) - 1], "bathroom"], strict=True):
        kinds[i] = kind
    return kinds


def _habitable(cell: Cell, kind: str) -> bool:
    short, long = sorted(cell.sides)
    smallest, largest = _AREAS.get(kind, (7.0, 25.0))
    return kind == "hall" or (short >= _MIN_SIDE and long / short <= _MAX_ASPECT and smallest <= cell.area <= largest)


def _shared_wall(a: Cell, b: Cell) -> tuple[str, float, float, float] | None:
    """Direction of the wall between two cells, position across, start and end; None where no doorway fits."""
    for along, across in (("x", "y"), ("y", "x")):
        low = max(getattr(a, f"{along}_min"), getattr(b, f"{along}_min"))
        high = min(getattr(a, f"{along}_max"), getattr(b, f"{along}_max"))
        for one, other in ((a, b), (b, a)):
            at = getattr(one, f"{across}_max")
            if at == getattr(other, f"{across}_min") and high - low >= 2 * _DOOR_TO_CORNER:
                return along, at, low, high
    return None


def _choose_doorways(rng: np.random.Generator, cells: list[Cell], kinds: list[str]) -> tuple[Doorway, ...]:
    """A tree from the most public room, then doors that close loops between public rooms; () if it is impossible."""
    walls = {
        pair: w for pair in combinations(range(len(cells)), 2) if (w := _shared_wall(cells[pair[0]], cells[pair[1]]))
    }
    privacy = [_PRIVACY[kind] for kind in kinds]
    reached, chosen = {int(np.argmin(privacy))}, []
    while len(reached) < len(cells):
        edges = [pair for pair in walls if len(reached.intersection(pair)) == 1]
        via = {pair: min(privacy[i] for i in pair if i in reached) for pair in edges}
        best = min(edges, key=lambda pair: (via[pair], pair), default=None)
        if best is None or via[best] >= _PRIVACY["bathroom"]:
            return ()
        chosen.append(best)
        reached.update(best)
    public = [pair for pair in walls if pair not in chosen and sum(privacy[i] for i in pair) <= 4]
    return tuple(_doorway(rng, pair, walls[pair], privacy) for pair in chosen + public[:2])


def _doorway(
    rng: np.random.Generator, pair: tuple[int, int], wall: tuple[str, float, float, float], privacy: list[int]
) -> Doorway:
    """Near one end of the shared wall; private rooms have a door, public ones an open passage."""
    along, across, low, high = wall
    spot = low + _DOOR_TO_CORNER if rng.random() < 0.5 else high - _DOOR_TO_CORNER
    inner = max(pair, key=lambda i: privacy[i])
    leaf_in = inner if privacy[inner] > _PRIVACY["kitchen"] else None
    return Doorway(pair, (spot, across) if along == "x" else (across, spot), along, leaf_in)


def _rooms(
    rng: np.random.Generator, outline: Cell, cells: list[Cell], kinds: list[str], doorways: tuple[Doorway, ...]
) -> tuple[PlannedRoom, ...]:
    rooms = []
    for i, (cell, kind) in enumerate(zip(cells, kinds, strict=True)):
        name = kind if kinds[:i].count(kind) == 0 else f"{kind}_{kinds[:i].count(kind) + 1}"
        outer = [
            cell.y_min == outline.y_min,
            cell.x_max == outline.x_max,
            cell.y_max == outline.y_max,
            cell.x_min == outline.x_min,
        ]
        south, east, north, west = (0.0 if out else INNER_WALL / 2 for out in outer)
        bounds = (cell.x_min + west, cell.y_min + south, cell.x_max - east, cell.y_max - north)
        room = Room(name, kind, *bounds)
        doors = [d for d in doorways if i in d.rooms]
        rooms.append(PlannedRoom(room, cell, _walls(rng, room, outer, doors, i)))
    return tuple(rooms)


def _walls(
    rng: np.random.Generator, room: Room, outer: list[bool], doors: list[Doorway], index: int
) -> tuple[Wall, ...]:
    """South, east, north, west; `outer` is in the same order."""
    dx, dy = room.x_max - room.x_min, room.y_max - room.y_min
    frames = (
        (room.x_min, room.y_min, 0.0, dx),
        (room.x_max, room.y_min, np.pi / 2, dy),
        (room.x_max, room.y_max, np.pi, dx),
        (room.x_min, room.y_max, -np.pi / 2, dy),
    )
    walls = [Wall((x, y), yaw, length, out) for (x, y, yaw, length), out in zip(frames, outer, strict=True)]
    windowed = _windowed(rng, walls, room.kind)
    openings = [_windows(rng, w.length, room.kind) if i in windowed else () for i, w in enumerate(walls)]
    return tuple(
        replace(w, openings=_doors(w, doors, index) if not w.outer else o) for w, o in zip(walls, openings, strict=True)
    )


def _windowed(rng: np.random.Generator, walls: list[Wall], kind: str) -> set[int]:
    """Indices of the walls with windows: one outer wall, and often a second one in large rooms."""
    outer = [i for i in rng.permutation(4).tolist() if walls[i].outer]
    count = 2 if kind == "living_room" or (kind in ("bedroom", "study") and rng.random() < 0.4) else 1
    return set(outer[:count])


def _doors(wall: Wall, doors: list[Doorway], index: int) -> tuple[Opening, ...]:
    """The doorways in this inner wall, in order along it."""
    width, top = DOOR_WIDTH + 2 * DOOR_FRAME, DOOR_HEIGHT + DOOR_FRAME
    spots = [(spot, d.leaf_in == index) for d in doors if (spot := _on_wall(wall, d.centre)) is not None]
    return tuple(Opening("door", spot, width, 0.0, top, leaf) for spot, leaf in sorted(spots))


def _on_wall(wall: Wall, point: tuple[float, float]) -> float | None:
    """How far along the wall a doorway's centre lies, or None if it is in another wall."""
    along, inward = wall.along(point)
    return along if abs(inward + INNER_WALL / 2) < 1e-6 and 0.0 < along < wall.length else None


def _windows(rng: np.random.Generator, length: float, kind: str) -> tuple[Opening, ...]:
    """One window in the middle of the wall, two in a long one; small and high in the bathroom."""
    if kind == "bathroom":
        return (Opening("window", length / 2, 0.7, 1.45, 2.15),)
    count = 2 if length > 4.4 else 1
    width = min(float(rng.uniform(1.1, 1.5)), length / count - 0.9)
    sill = 1.15 if kind == "kitchen" else 0.9
    if width < 0.6:
        return ()
    return tuple(Opening("window", length * (i + 0.5) / count, width, sill, 2.15) for i in range(count))
