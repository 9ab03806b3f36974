"""Furniture that stands in groups: sofa and table, table and chairs, kitchen rows, beds with nightstands, desks."""

from collections.abc import Iterator

import numpy as np

from slamgym.scenes.home.floorplan import Wall
from slamgym.scenes.home.furnisher import Furnisher
from slamgym.scenes.home.furniture import clutter, decor, desktop, fixtures, kitchen, seating, sofas, tables
from slamgym.scenes.home.furniture.piece import Maker, Piece
from slamgym.scenes.home.placement import Placed


def sofa_and_table(room: Furnisher) -> list[Placed]:
    """A sofa by the longest free wall with a coffee table on a rug in front of it."""
    walls = room.layout.planned.walls
    order = sorted(range(4), key=lambda i: (len(walls[i].openings), -walls[i].length))
    for sofa in room.stand(sofas.sofa, walls=order):
        table = sofa.beside(room.make(tables.coffee_table), 0.0, 1.2)
        if room.layout.put(table):
            room.scatter([table], clutter.ON_LIVING_TABLES, 6)
        room.rug_at(sofa, 0.0, 1.4, (2.3, 1.5))
        return [sofa]
    return []


def television_opposite(room: Furnisher, sofa: list[Placed]) -> None:
    """A bench with a television, facing the sofa if there is one."""
    opposite = [(_wall_of(room, sofa[0]) + k) % 4 for k in (2, 1, 3)] if sofa else None
    screen = room.make(decor.television)
    bench = room.make(tables.tv_bench)
    top = bench.bounds[1, 2] + 5e-4
    room.layout.against_wall(bench, room.rng, opposite, company=lambda b: [b.beside(screen, 0.0, 0.22, float(top))])


def _wall_of(room: Furnisher, item: Placed) -> int:
    return [wall.yaw for wall in room.layout.planned.walls].index(item.yaw)


def dining_place(room: Furnisher, maker: Maker, seats: int) -> None:
    """A table with chairs on both long sides, somewhere in the room where all of it fits."""
    bounds = room.layout.planned.room
    table_piece = room.make(maker)
    for _ in range(30):
        x = float(room.rng.uniform(bounds.x_min, bounds.x_max))
        y = float(room.rng.uniform(bounds.y_min, bounds.y_max))
        table = Placed(table_piece, float(room.rng.integers(4)) * np.pi / 2, (x, y, 0.0))
        chairs = _chairs_around(room, table, seats)
        if room.layout.put(table, *chairs, margin=0.2):
            room.scatter([table], clutter.ON_DINING_TABLES, 1.3 * seats)
            return


def _chairs_around(room: Furnisher, table: Placed, seats: int) -> list[Placed]:
    """Chairs by turns on both long sides, pushed in a little."""
    low, high = table.piece.bounds
    chair = room.make(seating.chair)
    places = {2: (0.0,), 4: (-0.25, 0.25)}.get(seats, (-0.33, 0.0, 0.33))
    chairs = []
    for x in (share * float(high[0] - low[0]) for share in places):
        for edge, out, facing in ((float(low[1]), -1.0, 0.0), (float(high[1]), 1.0, np.pi)):
            back, turn = float(room.rng.uniform(0.35, 0.45)), float(room.rng.uniform(-0.15, 0.15))
            chairs.append(table.beside(chair, x, edge + out * back, turn=facing + turn))
    return chairs


def kitchen_row(room: Furnisher) -> list[Placed]:
    """A fridge and units side by side, as many as fit, with tiles, cupboards and a hood above; returns the units.

    Where not even the shortest row fits, the fridge stands elsewhere.
    """
    for number in range(len(kitchen.BASE_UNITS), 1, -1):
        if row := _stand_in_row(room, (kitchen.fridge, *kitchen.BASE_UNITS[:number])):
            _notes_on(room, row[0])
            return row[1:]
    row = _stand_in_row(room, kitchen.BASE_UNITS[:2])
    room.stand(kitchen.fridge)
    return row


def _stand_in_row(room: Furnisher, makers: tuple[Maker, ...]) -> list[Placed]:
    pieces = [room.make(maker) for maker in makers]
    for wall in (room.layout.planned.walls[i] for i in room.rng.permutation(4)):
        for row in _rows(wall, pieces):
            units = [item for item in row if item.piece.kind != "fridge"]
            if any(room.layout.put(*row, *_tiles(room, units, height)) for height in (0.6, 0.22)):
                _above_row(room, units)
                return row
    return []


def _rows(wall: Wall, units: list[Piece]) -> Iterator[list[Placed]]:
    """The units from either end of the wall, or away from it."""
    spots = 0.32 + 0.602 * np.arange(len(units))
    for shift in np.arange(0.0, wall.length - spots[-1] - 0.32, 0.3):
        for along in (spots + shift, wall.length - spots - shift):
            yield [Placed(u, wall.yaw, wall.point(s)) for u, s in zip(units, along, strict=True)]


def _above_row(room: Furnisher, units: list[Placed]) -> None:
    for unit in units:
        maker = kitchen.hood if unit.piece.kind == "oven" else kitchen.wall_cupboard
        room.layout.put(unit.beside(room.make(maker), 0.0, 0.0, 1.5))


def _tiles(room: Furnisher, units: list[Placed], height: float) -> list[Placed]:
    """Tiles above the worktops, under cupboards or only up to a window sill."""
    return [unit.beside(kitchen.backsplash(room.palette, height), 0.0, 0.0) for unit in units]


def _notes_on(room: Furnisher, fridge: Placed) -> None:
    """Notes stick to the sides of a fridge too."""
    notes = room.make(fixtures.pinned_notes)
    low, high = fridge.piece.bounds
    sides = (
        fridge.beside(notes, float(x), 0.33, 1.4, turn)
        for x, turn in ((low[0] - 0.001, np.pi / 2), (high[0] + 0.001, -np.pi / 2))
    )
    any(room.layout.put(item) for item in sides)


def bed_group(room: Furnisher, *makers: Maker) -> None:
    """The first bed that fits, nightstands beside it and a rug at its foot."""
    for maker in makers:
        for bed in room.stand(maker):
            half = float(bed.piece.bounds[1, 0])
            stands = [bed.beside(room.make(tables.nightstand), side * (half + 0.24), 0.0) for side in (-1, 1)]
            room.scatter([s for s in stands if room.layout.put(s)], clutter.ON_NIGHTSTANDS, 2)
            room.rug_at(bed, 0.0, 2.0, (2.2, 1.4))
            return


def work_place(room: Furnisher) -> None:
    """A desk with a chair, a screen and a keyboard, often a board above it."""
    seat, turn = room.make(seating.office_chair), np.pi + float(room.rng.uniform(-0.6, 0.6))
    piece = room.make(tables.desk)
    desk = room.layout.against_wall(piece, room.rng, company=lambda desk: [desk.beside(seat, -0.15, 1.25, turn=turn)])
    if desk:
        top = float(piece.bounds[1, 2]) + 5e-4
        for x in (-0.1, -0.4)[: int(room.rng.integers(1, 3))]:
            room.layout.put(
                desk.beside(
                    room.make(desktop.monitor), x if x > -0.2 else -0.5, 0.2, top, float(room.rng.normal(0, 0.08))
                )
            )
        room.layout.put(desk.beside(room.make(desktop.keyboard), -0.1, 0.48, top))
        room.scatter([desk], clutter.ON_DESKS, 7)
        room.layout.put(desk.beside(room.make(fixtures.pinboard), 0.0, -0.012, 1.65))
