"""Floor plans: a rectangle cut into rooms, joined by doorways and lit by windows.

The plan is x to the east, y to the north, metres. Rooms are cells of a recursive division; cells meet in the middle of
the inner walls, outer walls stand outside of the cells.
"""

from dataclasses import dataclass

import numpy as np

from slamgym.scenes.house import Room

INNER_WALL = 0.12
OUTER_WALL = 0.25
DOOR_WIDTH = 0.9
DOOR_HEIGHT = 2.05
DOOR_FRAME = 0.04


@dataclass(frozen=True, slots=True)
class Cell:
    """A rectangle of the plan."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @property
    def sides(self) -> tuple[float, float]:
        return self.x_max - self.x_min, self.y_max - self.y_min

    @property
    def area(self) -> float:
        return self.sides[0] * self.sides[1]


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a wall: `centre` along the wall, from `bottom` to `top` above the floor, metres.

    leaf: whether a door opens into this room.
    """

    kind: str
    centre: float
    width: float
    bottom: float
    top: float
    leaf: bool = False


@dataclass(frozen=True, slots=True)
class Wall:
    """One side of a room, seen from inside.

    Its frame: x along the wall from `origin` (east along the south wall, and so counter-clockwise around the room), y
    into the room, z up; `yaw` turns it into the world's.
    """

    origin: tuple[float, float]
    yaw: float
    length: float
    outer: bool
    openings: tuple[Opening, ...] = ()

    def point(self, along: float, inward: float = 0.0, z: float = 0.0) -> tuple[float, float, float]:
        """World position of a point given in the wall's frame."""
        c, s = float(np.cos(self.yaw)), float(np.sin(self.yaw))
        return self.origin[0] + c * along - s * inward, self.origin[1] + s * along + c * inward, z

    def along(self, point: tuple[float, ...]) -> tuple[float, float]:
        """How far along the wall and how far into the room a world point lies."""
        x, y = point[0] - self.origin[0], point[1] - self.origin[1]
        c, s = float(np.cos(self.yaw)), float(np.sin(self.yaw))
        return c * x + s * y, -s * x + c * y


@dataclass(frozen=True, slots=True)
class PlannedRoom:
    """A room, the cell that its floor covers, and its walls: south, east, north, west."""

    room: Room
    cell: Cell
    walls: tuple[Wall, ...]


@dataclass(frozen=True, slots=True)
class Doorway:
    """A doorway between two rooms (by index) at a point in the middle of the wall.

    along: direction of the wall, "x" or "y". leaf_in: the room that its door opens into; None for an open passage.
    """

    rooms: tuple[int, int]
    centre: tuple[float, float]
    along: str
    leaf_in: int | None


@dataclass(frozen=True, slots=True)
class FloorPlan:
    """A whole storey. width, depth: inside the outer walls; height: floor to ceiling."""

    width: float
    depth: float
    height: float
    rooms: tuple[PlannedRoom, ...]
    doorways: tuple[Doorway, ...]
