"""Furnishing a house: doors, curtains, furniture, pictures and lamps, room by room."""

from collections.abc import Iterator

import numpy as np

from slamgym.scenes.home.floorplan import DOOR_WIDTH, FloorPlan
from slamgym.scenes.home.furnisher import Furnisher
from slamgym.scenes.home.furniture import decor
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.placement import Placed, RoomLayout
from slamgym.scenes.home.programmes import PROGRAMMES
from slamgym.scenes.house import Lamp

_AREA_PER_LAMP = 15.0


def furnish(plan: FloorPlan, palette: Palette, rng: np.random.Generator) -> tuple[list[Placed], list[Lamp]]:
    """All furniture of a house, and the lamps that shine in it."""
    items: list[Placed] = []
    lamps: list[Lamp] = []
    pictures = iter(palette.pictures)
    kinds = [planned.room.kind for planned in plan.rooms]
    entrance = kinds.index("hall" if "hall" in kinds else "living_room")
    for i, planned in enumerate(plan.rooms):
        room = Furnisher(RoomLayout(planned, plan.height, rng), palette, pictures)
        _doors(room)
        _curtains(room)
        if i == entrance:
            _front_door(room)
        PROGRAMMES[planned.room.kind](room)
        _radiators(room)
        _pictures(room)
        lamps += _ceiling_lamps(room)
        items += room.layout.items
    return items, lamps


def _doors(room: Furnisher) -> None:
    """Door leaves, folded back against the wall where there is space for them."""
    layout, side = room.layout, DOOR_WIDTH + 0.06
    leaf = decor.door_leaf(room.palette, DOOR_WIDTH - 0.03, 2.03)
    for wall, opening in layout.openings("door"):
        spots = [s for s in (opening.centre - side, opening.centre + side) if side / 2 < s < wall.length - side / 2]
        if opening.leaf:
            any(layout.put(Placed(leaf, wall.yaw, wall.point(s))) for s in spots)


def _curtains(room: Furnisher) -> None:
    """Curtains where people sit or sleep; nothing may stand in front of a window."""
    layout = room.layout
    for wall, opening in layout.openings("window"):
        if layout.planned.room.kind in ("living_room", "bedroom", "study"):
            cloth = decor.curtain(room.palette, opening.width, opening.top + 0.12, opening.bottom - 0.04)
            layout.put(Placed(cloth, wall.yaw, wall.point(opening.centre)))
        layout.keep_free(wall, opening, 0.12)


def _front_door(room: Furnisher) -> None:
    """Closed, in an outer wall."""
    door = decor.door_leaf(room.palette, 0.95, 2.1)
    outer = [i for i, wall in enumerate(room.layout.planned.walls) if wall.outer]
    room.layout.against_wall(Piece("front_door", door.components, front=0.9), outer, gap=0.0)


def _radiators(room: Furnisher) -> None:
    """Under the windows, where nothing else stands."""
    for wall, opening in room.layout.openings("window"):
        fins = decor.radiator(room.palette, opening.width - 0.1)
        room.layout.put(Placed(fins, wall.yaw, wall.point(opening.centre)))


def _pictures(room: Furnisher) -> None:
    """Pictures at eye level, about one for every 6 m2, none twice in a house; none in the bathroom."""
    if room.layout.planned.room.kind == "bathroom":
        return
    for _ in range(1 + int(room.layout.area / 6.0)):
        finish = next(room.pictures, None)
        if finish is None:
            return
        piece = decor.wall_picture(room.palette, room.rng, finish)
        z = float(room.rng.uniform(1.4, 1.6))
        room.layout.against_wall(piece, z=z, margin=0.08, gap=0.002)


def _ceiling_lamps(room: Furnisher) -> Iterator[Lamp]:
    """Hanging lamps in a line along the room; the light is just under each shade."""
    bounds, height = room.layout.planned.room, room.layout.height
    size = np.array([bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min])
    number = max(1, round(room.layout.area / _AREA_PER_LAMP), round(size.max() / 5.0))
    for i in range(number):
        share = np.where(size == size.max(), (i + 0.5) / number, 0.5)
        x, y = (np.array([bounds.x_min, bounds.y_min]) + share * size).tolist()
        room.layout.lay(Placed(room.make(decor.ceiling_lamp), 0.0, (x, y, height)))
        yield Lamp((x, y, height - decor.CEILING_LAMP_DROP))
