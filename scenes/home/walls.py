"""From cells and doorways to rooms: inner bounds, walls, and the windows in those that are outer."""

from dataclasses import replace

import numpy as np

from slamgym.scenes.home.floorplan import (
    DOOR_FRAME,
    DOOR_HEIGHT,
    DOOR_WIDTH,
    INNER_WALL,
    Cell,
    Doorway,
    Opening,
    PlannedRoom,
    Wall,
)
from slamgym.scenes.house import Room


def planned_rooms(
    rng: np.random.Generator, outline: Cell, cells: list[Cell], kinds: list[str], doorways: tuple[Doorway, ...]
) -> tuple[PlannedRoom, ...]:
    """The cells as rooms between walls that doorways and windows pierce; names count the rooms of a kind."""
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
    often = 1.0 if kind == "living_room" else 0.0 if kind in ("hall", "bathroom") else 0.4
    count = 2 if rng.random() < often else 1
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
    sill = 1.15 if kind == "kitchen" else float(rng.choice([0.6, 0.9, 0.9]))
    if width < 0.6:
        return ()
    return tuple(Opening("window", length * (i + 0.5) / count, width, sill, 2.15) for i in range(count))
