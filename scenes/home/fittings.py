"""What every room gets beside its furniture: doors, curtains, radiators, switches, sockets, pictures."""

from collections.abc import Iterator
from functools import partial
from itertools import islice

import numpy as np

from slamgym.scenes.home.floorplan import DOOR_WIDTH, Opening, Wall
from slamgym.scenes.home.furnisher import Furnisher
from slamgym.scenes.home.furniture import decor, fixtures, openings
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.home.placement import DOOR_ZONE, Placed

_AJAR_DEG = (64.0, 112.0)  # less would leave less than 0.75 m to pass
_TRIES = 8
_LARGE_M2 = 12.0
_GROUPS = (1, 1, 2, 3, 3)  # pictures that hang together


def doors(room: Furnisher, leaf: Piece) -> None:
    """Leaves ajar at any angle that leaves the way free; nothing else may stand behind a doorway."""
    layout = room.layout
    for wall, opening in layout.openings("door"):
        layout.keep_free(wall, opening, DOOR_ZONE)
    for wall, opening in layout.openings("door"):
        ways = _ways_to_open(wall, opening, room.rng) if opening.leaf else ()
        any(layout.put(Placed(leaf, yaw, hinge), before=opening) for yaw, hinge in ways)


def _ways_to_open(
    wall: Wall, opening: Opening, rng: np.random.Generator
) -> Iterator[tuple[float, tuple[float, float, float]]]:
    """Yaws and hinges of a leaf; it opens towards the nearer corner if it can."""
    near = -1.0 if opening.centre < wall.length / 2 else 1.0
    for side in (near, -near):
        hinge = wall.point(opening.centre + side * (DOOR_WIDTH / 2 - 0.01), 0.022)
        for angle in np.deg2rad(rng.uniform(*_AJAR_DEG, _TRIES)):
            yield wall.yaw + (float(angle) if side < 0 else np.pi - float(angle)), hinge


def front_door(room: Furnisher) -> None:
    """Closed, in an outer wall, with an intercom beside it."""
    leaf = openings.door_leaf(room.palette, room.rng, 0.95, 2.1)
    door = openings.front_door(leaf, room.palette, 0.95, 2.1)
    outer = [i for i, wall in enumerate(room.layout.planned.walls) if wall.outer]
    if at := room.layout.against_wall(door, room.rng, outer, gap=0.0):
        sides = (at.beside(room.make(fixtures.intercom), x, 0.002, 1.4) for x in (0.7, -0.7))
        any(room.layout.put(item) for item in sides)


def windows(room: Furnisher) -> None:
    """Curtains where people sit or sleep, blinds elsewhere or none; nothing may stand in front of a window."""
    layout = room.layout
    homely = layout.planned.room.kind in ("living_room", "bedroom", "nursery", "dining_room", "study")
    for wall, opening in layout.openings("window"):
        width, top = opening.width, opening.top
        if homely:
            piece = openings.curtain(room.palette, room.rng, width, top + 0.12, opening.bottom - 0.04)
            layout.put(Placed(piece, wall.yaw, wall.point(opening.centre)))
        elif room.rng.random() < 0.6:
            piece = openings.blind(room.palette, room.rng, width, top)
            layout.put(Placed(piece, wall.yaw, wall.point(opening.centre)))
        layout.keep_free(wall, opening, 0.12)


def radiators(room: Furnisher) -> None:
    """Under the windows, where nothing else stands."""
    for wall, opening in room.layout.openings("window"):
        piece = openings.radiator(room.palette, opening.width - 0.1, min(0.56, opening.bottom - 0.28))
        room.layout.put(Placed(piece, wall.yaw, wall.point(opening.centre)))


def electrics(room: Furnisher) -> None:
    """A switch beside every doorway, sockets on one to three walls, an alarm, what the kind of room needs."""
    layout = room.layout
    for wall, opening in layout.openings("door"):
        for s in (opening.centre + 0.66, opening.centre - 0.66):
            if 0.06 < s < wall.length - 0.06:
                switch = Placed(room.make(fixtures.light_switch), wall.yaw, wall.point(s, 0.001, 1.08))
                if layout.put(switch):
                    break
    bounds = layout.planned.room
    number = 1 if bounds.kind in ("hall", "bathroom") else 2 if layout.area < _LARGE_M2 else 3
    for i in room.rng.permutation(4)[:number].tolist():
        room.hang(fixtures.socket, 0.32, [i])
    if bounds.kind in ("kitchen", "bathroom"):
        room.hang(fixtures.vent, 2.3)
    else:
        x, y = (0.64 * low + 0.36 * high for low, high in ((bounds.x_min, bounds.x_max), (bounds.y_min, bounds.y_max)))
        layout.lay(Placed(room.make(fixtures.smoke_alarm), 0.0, (x, y, layout.height)))
        room.hang(fixtures.thermostat, 1.45)


def pictures(room: Furnisher, richness: float) -> None:
    """Pictures at eye level, single or in groups, the more the larger the room is, none twice in a house.

    None in the bathroom; fewer where surfaces are plain.
    """
    if room.layout.planned.room.kind == "bathroom":
        return
    wanted = round((3.0 + room.layout.area / 3.0) * (0.25 + 0.75 * min(richness, 1.5)))
    while finishes := list(islice(room.household.pictures, min(wanted, int(room.rng.choice(_GROUPS))))):
        wanted -= len(finishes)
        first, *others = (decor.wall_picture(room.palette, room.rng, f, small=i > 0) for i, f in enumerate(finishes))
        z = float(room.rng.uniform(1.3, 1.6))
        hang = partial(room.layout.against_wall, rng=room.rng, z=z, margin=0.02, gap=0.002)
        if not hang(first, company=partial(_column_beside, others=others)):
            for piece in others:
                hang(piece)


def _column_beside(first: Placed, others: list[Piece]) -> list[Placed]:
    """Smaller pictures one above the other, on the right of the first."""
    left = float(first.piece.bounds[0, 0]) - 0.05
    tallest = max((float(np.ptp(piece.bounds[:, 2])) for piece in others), default=0.0)
    step = tallest + 0.05
    return [
        first.beside(piece, left - float(piece.bounds[1, 0]), 0.0, step * (i - (len(others) - 1) / 2))
        for i, piece in enumerate(others)
    ]
