"""What stands in which kind of room."""

from collections.abc import Callable, Sequence

import numpy as np

from slamgym.scenes.home import groups
from slamgym.scenes.home.furnisher import Furnisher
from slamgym.scenes.home.furniture import (
    bathroom,
    beds,
    clutter,
    coats,
    decor,
    fixtures,
    kitchenware,
    lamps,
    litter,
    seating,
    shelves,
    sofas,
    tables,
)
from slamgym.scenes.home.furniture.piece import Maker
from slamgym.scenes.home.placement import Placed

_WIDE_M = 2.0  # from which furniture may stand on both sides


def _stand_and_fill(
    room: Furnisher,
    *makers: Maker,
    things: tuple[Maker, ...] = clutter.ON_CABINETS,
    each: float = 4,
    walls: Sequence[int] | None = None,
) -> None:
    """Puts pieces against walls, and small things on their tops."""
    room.scatter([item for item in room.stand(*makers, walls=walls) if item.piece.tops], things, each)


def _living_room(room: Furnisher) -> None:
    groups.television_opposite(room, groups.sofa_and_table(room))
    groups.dining_place(room, tables.dining_table, 4)
    shelf = shelves.bookshelf
    _stand_and_fill(
        room,
        shelf,
        tables.sideboard,
        sofas.armchair,
        shelf,
        decor.plant,
        lamps.floor_lamp,
        tables.round_table,
        tables.dresser,
        decor.plant,
    )
    room.hang(decor.clock, 1.9)
    room.hang(shelves.wall_shelf, 1.45)
    room.hang(fixtures.wall_lamp, 1.7)
    room.litter(litter.ANYWHERE, 3)


def _dining_room(room: Furnisher) -> None:
    groups.dining_place(room, tables.dining_table, 6)
    _stand_and_fill(room, tables.sideboard, tables.dresser, decor.plant, lamps.floor_lamp, shelves.bookshelf)
    room.hang(fixtures.wall_mirror, 1.55)
    room.hang(fixtures.wall_lamp, 1.7)
    room.litter(litter.ANYWHERE, 2)


def _kitchen(room: Furnisher) -> None:
    row = groups.kitchen_row(room)
    room.scatter([unit for unit in row if unit.piece.tops], kitchenware.ON_KITCHEN_TOPS, 3)
    groups.dining_place(room, tables.kitchen_table, 2)
    _stand_and_fill(room, tables.sideboard, shelves.bookshelf, decor.plant, things=kitchenware.ON_KITCHEN_TOPS)
    room.hang(shelves.wall_shelf, 1.4)
    room.hang(decor.clock, 1.9)
    room.hang(fixtures.calendar, 1.5)
    room.hang(fixtures.pinned_notes, 1.45)
    room.litter(litter.IN_KITCHENS, 3)


def _bedroom(room: Furnisher) -> None:
    groups.bed_group(room, beds.double_bed, beds.single_bed)
    room.stand(tables.wardrobe)
    _stand_and_fill(room, tables.dresser, shelves.bookshelf, sofas.armchair, decor.plant, seating.ottoman)
    room.hang(fixtures.wall_mirror, 1.45)
    room.litter(litter.IN_BEDROOMS, 3)


def _nursery(room: Furnisher) -> None:
    groups.bed_group(room, beds.single_bed)
    groups.work_place(room)
    _stand_and_fill(room, tables.wardrobe, shelves.bookshelf, tables.dresser)
    room.hang(shelves.wall_shelf, 1.4)
    room.hang(fixtures.pinned_notes, 1.4)
    room.litter(litter.FOR_CHILDREN, 4)


def _study(room: Furnisher) -> None:
    groups.work_place(room)
    shelf = shelves.bookshelf
    _stand_and_fill(room, shelf, shelf, sofas.armchair, tables.dresser, lamps.floor_lamp, decor.plant)
    room.hang(shelves.wall_shelf, 1.45)
    room.hang(decor.clock, 1.9)
    room.hang(fixtures.calendar, 1.5)
    room.litter(litter.AT_WORK, 3)


def _bathroom(room: Furnisher) -> None:
    room.stand(bathroom.toilet)
    basin = room.stand(bathroom.washbasin)
    tub = room.stand(bathroom.bath) or room.stand(bathroom.shower)
    for item in basin:
        mirror = room.make(bathroom.mirror_cabinet)
        room.layout.put(item.beside(mirror, 0.0, -0.01, 1.2))
    _stand_and_fill(
        room,
        bathroom.washing_machine,
        bathroom.towel_rail,
        bathroom.laundry_basket,
        things=clutter.IN_BATHROOMS,
        each=2,
    )
    for item in tub[:1]:
        room.rug_at(item, 0.0, float(item.piece.bounds[1, 1]) + 0.35, (0.8, 0.5))
    room.hang(bathroom.towel_hooks, 1.5)
    room.hang(bathroom.paper_roll, 0.75)
    room.hang(bathroom.bath_shelf, 1.35)


def _hall(room: Furnisher) -> None:
    side = _one_side(room)
    _stand_and_fill(
        room,
        tables.shoe_cabinet,
        coats.coat_rack,
        shelves.bookshelf,
        tables.shoe_cabinet,
        decor.plant,
        each=2,
        walls=side,
    )
    room.hang(fixtures.wall_mirror, 1.5)
    room.hang(fixtures.key_hooks, 1.5)
    room.litter(litter.IN_HALLS, 4, side)
    if side is not None:
        _lay_runner(room)


def _lay_runner(room: Furnisher) -> None:
    """A long rug in the middle of a narrow room."""
    bounds = room.layout.planned.room
    size = np.array([bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min])
    width, depth = np.where(size == size.max(), 0.4, 0.55) * size
    middle = ((bounds.x_min + bounds.x_max) / 2, (bounds.y_min + bounds.y_max) / 2, 0.0)
    room.layout.lay(Placed(decor.rug(room.palette, room.rng, float(width), float(depth)), 0.0, middle))


def _one_side(room: Furnisher) -> list[int] | None:
    """The long wall of a narrow room with the fewest metres of doorways: a robot gets along the other; else None."""
    walls = room.layout.planned.walls
    if min(wall.length for wall in walls) >= _WIDE_M:
        return None
    free = [wall.length - sum(o.width for o in wall.openings) for wall in walls]
    return [int(np.argmax(free))]


PROGRAMMES: dict[str, Callable[[Furnisher], None]] = {
    "living_room": _living_room,
    "dining_room": _dining_room,
    "kitchen": _kitchen,
    "bedroom": _bedroom,
    "nursery": _nursery,
    "study": _study,
    "bathroom": _bathroom,
    "hall": _hall,
}
