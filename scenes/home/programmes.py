"""What stands in which kind of room, and where: sofas face the television, chairs stand at tables."""

from collections.abc import Callable, Iterator

import numpy as np

from slamgym.scenes.home.floorplan import Wall
from slamgym.scenes.home.furnisher import Furnisher
from slamgym.scenes.home.furniture import bathroom, clutter, decor, kitchen, seating, shelves, tables
from slamgym.scenes.home.furniture.clutter import Maker
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.home.placement import Placed


def _living_room(room: Furnisher) -> None:
    layout = room.layout
    sofas = _sofa_and_table(room)
    opposite = [(_wall_of(room, sofas[0]) + k) % 4 for k in (2, 1, 3)] if sofas else None
    screen = room.make(decor.television)
    layout.against_wall(
        room.make(tables.tv_bench), opposite, company=lambda bench: [bench.beside(screen, 0.0, 0.22, 0.4605)]
    )
    _dining_place(room, tables.dining_table, 4)
    shelf = shelves.bookshelf
    stood = room.stand(
        shelf, tables.sideboard, seating.armchair, shelf, decor.plant, decor.floor_lamp, tables.round_table
    )
    room.scatter([s for s in stood if s.piece.tops], clutter.ON_CABINETS, 2)
    room.hang(decor.clock, 1.9)


def _wall_of(room: Furnisher, item: Placed) -> int:
    return [wall.yaw for wall in room.layout.planned.walls].index(item.yaw)


def _sofa_and_table(room: Furnisher) -> list[Placed]:
    """A sofa by the longest free wall with a coffee table on a rug in front of it."""
    walls = room.layout.planned.walls
    order = sorted(range(4), key=lambda i: (len(walls[i].openings), -walls[i].length))
    for sofa in room.stand(seating.sofa, walls=order):
        table = sofa.beside(room.make(tables.coffee_table), 0.0, 1.2)
        if room.layout.put(table):
            room.scatter([table], clutter.ON_LIVING_TABLES, 4)
        room.rug_at(sofa, 0.0, 1.4, (2.3, 1.5))
        return [sofa]
    return []


def _dining_place(room: Furnisher, maker: Maker, seats: int) -> None:
    """A table with chairs on both long sides, somewhere in the room where all of it fits."""
    bounds = room.layout.planned.room
    table_piece = room.make(maker)
    for _ in range(30):
        x = float(room.rng.uniform(bounds.x_min, bounds.x_max))
        y = float(room.rng.uniform(bounds.y_min, bounds.y_max))
        table = Placed(table_piece, float(room.rng.integers(4)) * np.pi / 2, (x, y, 0.0))
        chairs = _chairs_around(room, table, seats)
        if room.layout.put(table, *chairs, margin=0.2):
            room.scatter([table], clutter.ON_LIVING_TABLES, 3)
            return


def _chairs_around(room: Furnisher, table: Placed, seats: int) -> list[Placed]:
    """Chairs by turns on both long sides, pushed in a little."""
    low, high = table.piece.bounds
    chair = room.make(seating.chair)
    places = (0.0,) if seats == 2 else (-0.25, 0.25)
    chairs = []
    for x in (share * float(high[0] - low[0]) for share in places):
        for edge, out, facing in ((float(low[1]), -1.0, 0.0), (float(high[1]), 1.0, np.pi)):
            back, turn = float(room.rng.uniform(0.35, 0.45)), float(room.rng.uniform(-0.15, 0.15))
            chairs.append(table.beside(chair, x, edge + out * back, turn=facing + turn))
    return chairs


def _kitchen(room: Furnisher) -> None:
    row = _kitchen_row(room)
    room.scatter([unit for unit in row if unit.piece.tops], clutter.ON_KITCHEN_TOPS, 2)
    _dining_place(room, tables.kitchen_table, 2)
    stood = room.stand(tables.sideboard, decor.plant)
    room.scatter([s for s in stood if s.piece.tops], clutter.ON_KITCHEN_TOPS, 3)
    room.hang(shelves.wall_shelf, 1.4)
    room.hang(decor.clock, 1.9)


def _kitchen_row(room: Furnisher) -> list[Placed]:
    """Fridge and units side by side from a corner, as many as fit, with cupboards and a hood above."""
    for number in range(len(kitchen.BASE_UNITS), 1, -1):
        units = [room.make(maker) for maker in (kitchen.fridge, *kitchen.BASE_UNITS[:number])]
        for wall in (room.layout.planned.walls[i] for i in room.rng.permutation(4)):
            for row in _rows(wall, units):
                if room.layout.put(*row):
                    _above_row(room, row)
                    return row
    return []


def _rows(wall: Wall, units: list[Piece]) -> Iterator[list[Placed]]:
    """The units from either end of the wall, or away from it."""
    spots = 0.32 + 0.602 * np.arange(len(units))
    for shift in np.arange(0.0, wall.length - spots[-1] - 0.32, 0.3):
        for along in (spots + shift, wall.length - spots - shift):
            yield [Placed(u, wall.yaw, wall.point(s)) for u, s in zip(units, along, strict=True)]


def _above_row(room: Furnisher, row: list[Placed]) -> None:
    for unit in row[1:]:
        maker = kitchen.hood if unit.piece.kind == "oven" else kitchen.wall_cupboard
        room.layout.put(unit.beside(room.make(maker), 0.0, 0.0, 1.5))


def _bedroom(room: Furnisher) -> None:
    for bed in room.stand(seating.double_bed) or room.stand(seating.single_bed):
        half = float(bed.piece.bounds[1, 0])
        stands = [bed.beside(room.make(tables.nightstand), side * (half + 0.23), 0.0) for side in (-1, 1)]
        room.scatter([s for s in stands if room.layout.put(s)], clutter.ON_NIGHTSTANDS, 2)
        room.rug_at(bed, 0.0, 2.0, (2.2, 1.4))
    room.stand(tables.wardrobe)
    stood = room.stand(tables.dresser, shelves.bookshelf, seating.armchair, decor.plant, seating.ottoman)
    room.scatter([s for s in stood if s.piece.tops], clutter.ON_CABINETS, 3)


def _study(room: Furnisher) -> None:
    _work_place(room)
    shelf = shelves.bookshelf
    stood = room.stand(shelf, shelf, seating.armchair, tables.dresser, decor.floor_lamp, decor.plant)
    room.scatter([s for s in stood if s.piece.tops], clutter.ON_CABINETS, 3)
    room.hang(shelves.wall_shelf, 1.45)
    room.hang(decor.clock, 1.9)


def _work_place(room: Furnisher) -> None:
    seat, turn = room.make(seating.office_chair), np.pi + float(room.rng.uniform(-0.4, 0.4))
    desk = room.layout.against_wall(
        room.make(tables.desk), company=lambda desk: [desk.beside(seat, -0.15, 1.25, turn=turn)]
    )
    if desk:
        for maker, y in ((clutter.monitor, 0.25), (clutter.keyboard, 0.48)):
            room.layout.put(desk.beside(room.make(maker), -0.1, y, 0.7405))
        room.scatter([desk], clutter.ON_DESKS, 3)


def _bathroom(room: Furnisher) -> None:
    room.stand(bathroom.toilet)
    basin = room.stand(bathroom.washbasin)
    tub = room.stand(bathroom.bath) or room.stand(bathroom.shower)
    for item in basin:
        mirror = room.make(bathroom.mirror_cabinet)
        room.layout.put(item.beside(mirror, 0.0, -0.01, 1.2))
    stood = room.stand(bathroom.washing_machine, bathroom.towel_rail, bathroom.laundry_basket)
    room.scatter([s for s in stood if s.piece.tops], clutter.IN_BATHROOMS, 2)
    for item in tub[:1]:
        room.rug_at(item, 0.0, float(item.piece.bounds[1, 1]) + 0.35, (0.8, 0.5))


def _hall(room: Furnisher) -> None:
    stood = room.stand(tables.shoe_cabinet, decor.coat_rack, shelves.bookshelf, tables.shoe_cabinet, decor.plant)
    room.scatter([s for s in stood if s.piece.tops], clutter.ON_CABINETS, 2)


PROGRAMMES: dict[str, Callable[[Furnisher], None]] = {
    "living_room": _living_room,
    "kitchen": _kitchen,
    "bedroom": _bedroom,
    "study": _study,
    "bathroom": _bathroom,
    "hall": _hall,
}
