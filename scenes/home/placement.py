"""Placing furniture in one room: nothing overlaps, doorways stay free, and wide routes join them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from slamgym.scenes.home.floorplan import Opening, PlannedRoom, Wall
from slamgym.scenes.home.furniture.piece import Piece, Top
from slamgym.types import BoolArray, FloatArray

ROUTE_WIDTH = 0.8
DOOR_ZONE = 0.9  # metres into the room that stay free behind a doorway
_HEADROOM = 1.4  # height of the space in front of a piece
_STANDS = 0.3  # what begins higher hangs, or stands on something else
_NARROWS_BELOW = 1.3  # what hangs higher does not narrow a route
_CELL = 0.05
_TRIES = 6
_LONG, _SLICES = 0.7, 6
_TOUCH = 1e-3  # overlaps up to 1 mm count as touching
_CUT_OFF_M2 = 0.5  # clear floor that furniture may close off from the doors
_OPEN_SHARE = 0.09  # of the room's area that must be 0.45 m away from everything and joined to the doors


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A piece in the house: turned by `yaw`, radians, and moved to `at`, metres."""

    piece: Piece
    yaw: float
    at: tuple[float, float, float]

    @property
    def bounds(self) -> FloatArray:
        """Axis-aligned bounding box (2, 3) in the world."""
        if self._askew:
            return self.in_world().bounds
        (x0, y0, z0), (x1, y1, z1) = self.piece.bounds
        return _around([self.point(x0, y0), self.point(x1, y1)], z0 + self.at[2], z1 + self.at[2])

    @property
    def _askew(self) -> bool:
        return bool(abs(np.sin(2.0 * self.yaw)) > 1e-6)

    def boxes(self) -> list[FloatArray]:
        """Axis-aligned boxes (2, 3) in the world that cover the piece: several where it is long and stands askew."""
        low, high = self.piece.bounds
        if high[0] - low[0] < _LONG or not self._askew:
            return [self.bounds]
        z = low[2] + self.at[2], high[2] + self.at[2]
        spans = pairwise(np.linspace(low[0], high[0], _SLICES + 1))
        return [_around([self.point(x, y) for x in ends for y in (low[1], high[1])], *z) for ends in spans]

    def in_world(self) -> Piece:
        return self.piece.placed(self.yaw, self.at)

    def point(self, x: float, y: float, z: float = 0.0) -> tuple[float, float, float]:
        """World position of a point in the piece's frame."""
        c, s = float(np.cos(self.yaw)), float(np.sin(self.yaw))
        return self.at[0] + c * x - s * y, self.at[1] + s * x + c * y, self.at[2] + z

    def beside(self, piece: Piece, x: float, y: float, z: float = 0.0, turn: float = 0.0) -> "Placed":
        """Another piece, given in this one's frame."""
        return Placed(piece, self.yaw + turn, self.point(x, y, z))

    def front(self) -> FloatArray:
        """The box (2, 3) in front of the piece that people need to use it."""
        low, high = self.piece.bounds
        corners = [self.point(x, y) for x in (low[0], high[0]) for y in (high[1], high[1] + self.piece.front)]
        return _around(corners, 0.0, _HEADROOM)


def _around(points: Sequence[ArrayLike], bottom: float, top: float) -> FloatArray:
    xy = np.array(points, dtype=np.float64)[:, :2]
    return np.array([[*xy.min(axis=0), bottom], [*xy.max(axis=0), top]])


def overlaps(box: FloatArray, others: Sequence[FloatArray]) -> bool:
    """Whether a box (2, 3) shares more than a touch with any of the others."""
    if not len(others):
        return False
    low, high = np.stack([o[0] for o in others]), np.stack([o[1] for o in others])
    return bool(((box[0] < high - _TOUCH) & (low < box[1] - _TOUCH)).all(axis=1).any())


class RoomLayout:
    """The furniture of one room as it fills up. Every `put` either fits and stays, or changes nothing."""

    def __init__(self, planned: PlannedRoom, height: float) -> None:
        self.planned = planned
        self.height = height
        self.items: list[Placed] = []
        self._origin = np.array([planned.room.x_min, planned.room.y_min])
        self._boxes: list[FloatArray] = []
        self._free: list[tuple[Opening, FloatArray]] = []
        self._fronts: list[FloatArray] = []
        self._approaches = [_approach(wall, o) for wall, o in self.openings("door")]

    def openings(self, kind: str) -> list[tuple[Wall, Opening]]:
        """The room's doorways or windows with the walls that they are in."""
        return [(wall, o) for wall in self.planned.walls for o in wall.openings if o.kind == kind]

    @property
    def area(self) -> float:
        room = self.planned.room
        return (room.x_max - room.x_min) * (room.y_max - room.y_min)

    def keep_free(self, wall: Wall, opening: Opening, depth: float) -> None:
        """Keeps the space in front of an opening free of all that is put later, as deep as given, metres."""
        sides = (opening.centre - opening.width / 2, opening.centre + opening.width / 2)
        corners = [wall.point(s, inward) for s in sides for inward in (0.0, depth)]
        self._free.append((opening, _around(corners, opening.bottom, opening.top)))

    def put(self, *group: Placed, margin: float = 0.0, before: Opening | None = None) -> bool:
        """Adds pieces that may overlap one another, if all of them fit; `margin` keeps them clear of others, metres.

        They stay inside the room, clear of other pieces, of the space in front of these, and of doorways and windows;
        and the free routes through the room stay open. before: the one opening that they may stand in front of.
        """
        boxes = [box for item in group for box in item.boxes()]
        grown = [box + np.array([[-margin, -margin, 0.0], [margin, margin, 0.0]]) for box in boxes]
        fronts = [item.front() for item in group if item.piece.front]
        low = [box for box in boxes if box[0, 2] < _STANDS]
        kept_free = [box for opening, box in self._free if opening is not before]
        if not all(self._inside(box) for box in boxes) or any(
            overlaps(box, [*self._boxes, *kept_free]) for box in grown
        ):
            return False
        if any(overlaps(box, self._fronts) for box in low) or any(overlaps(front, self._boxes) for front in fronts):
            return False
        if not self._passable(boxes):
            return False
        self.lay(*group)
        self._boxes += boxes
        self._fronts += fronts
        return True

    def lay(self, *group: Placed) -> None:
        """Adds pieces without a check: what is thin, or known to fit."""
        self.items += group

    def against_wall(
        self,
        piece: Piece,
        rng: np.random.Generator,
        walls: Sequence[int] | None = None,
        z: float = 0.0,
        margin: float = 0.0,
        gap: float = 0.015,
        company: Callable[[Placed], list[Placed]] = lambda _: [],
    ) -> Placed | None:
        """Puts the piece with its back to the first of the walls (indices) where it fits: in a corner or anywhere.

        company: what has to stand with it, such as the chair of a desk.
        """
        for i in rng.permutation(4).tolist() if walls is None else walls:
            wall = self.planned.walls[i]
            for s in _spots(piece, wall.length, rng):
                item = Placed(piece, wall.yaw, wall.point(s, gap, z))
                if self.put(item, *company(item), margin=margin):
                    return item
        return None

    def on_top(self, host: Placed, top: Top, piece: Piece, rng: np.random.Generator) -> bool:
        """Puts a small piece somewhere on a top of another, turned a little."""
        for _ in range(_TRIES):
            x, y = rng.uniform(*top.x), rng.uniform(*top.y)
            item = Placed(piece, host.yaw + float(rng.uniform(-0.4, 0.4)), host.point(x, y, top.z + 0.0005))
            if self.put(item, margin=0.01):
                return True
        return False

    def contains(self, item: Placed) -> bool:
        """Whether the piece lies inside the room."""
        return self._inside(item.bounds)

    def _inside(self, box: FloatArray) -> bool:
        room = self.planned.room
        low, high = np.array([room.x_min, room.y_min]), np.array([room.x_max, room.y_max])
        return bool((box[0, :2] >= low).all() and (box[1, :2] <= high).all() and box[1, 2] <= self.height + _TOUCH)

    def _passable(self, boxes: list[FloatArray]) -> bool:
        """Whether free space, half a route's width away from everything, joins all doors and is large enough."""
        if not any(_narrows(box) for box in boxes):
            return True
        clear = _clear_cells(self.planned, [box for box in (*self._boxes, *boxes) if _narrows(box)])
        labels, number = ndimage.label(clear)
        at_all_doors = set(range(1, number + 1))
        for box in self._approaches:
            (x0, y0), (x1, y1) = np.floor((box[:, :2] - self._origin) / _CELL).astype(int)
            at_all_doors &= set(np.unique(labels[x0 : x1 + 1, y0 : y1 + 1]).tolist())
        joined = max((int((labels == label).sum()) for label in at_all_doors), default=0) * _CELL**2
        cut_off = int(clear.sum()) * _CELL**2 - joined
        return joined >= _OPEN_SHARE * self.area and cut_off <= _CUT_OFF_M2


def _spots(piece: Piece, length: float, rng: np.random.Generator) -> list[float]:
    low, high = piece.bounds[:, 0]
    first, last = 0.02 - low, length - 0.02 - high
    if last < first:
        return []
    ends = [first, last] if rng.random() < 0.5 else [last, first]
    anywhere = rng.uniform(first, last, _TRIES).tolist()
    return [float(s) for s in (anywhere if piece.bounds[0, 2] < 0.0 else ends + anywhere)]


def _approach(wall: Wall, opening: Opening) -> FloatArray:
    """Where one stands before stepping through a doorway; behind an ajar door no route is wide enough there."""
    corners = [wall.point(opening.centre + s, inward) for s in (-0.35, 0.35) for inward in (0.35, 0.7)]
    return _around(corners, 0.0, _HEADROOM)


def _narrows(box: FloatArray) -> bool:
    return bool(box[0, 2] < _NARROWS_BELOW)


def _clear_cells(planned: PlannedRoom, obstacles: list[FloatArray]) -> BoolArray:
    """Cells (nx, ny) of the room where a disc as wide as a route touches neither walls nor obstacles."""
    room = planned.room
    origin = np.array([room.x_min, room.y_min])
    shape = np.ceil((np.array([room.x_max, room.y_max]) - origin) / _CELL).astype(int)
    free = np.zeros(shape + 2, dtype=bool)
    free[1:-1, 1:-1] = True
    for box in obstacles:
        (x0, y0), (x1, y1) = (np.floor((corner[:2] - origin) / _CELL).astype(int) + 1 for corner in box)
        free[max(x0, 0) : x1 + 1, max(y0, 0) : y1 + 1] = False
    return np.asarray(ndimage.distance_transform_edt(free, sampling=_CELL)[1:-1, 1:-1] > ROUTE_WIDTH / 2)
