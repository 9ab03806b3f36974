"""Tables, desks and sideboards: things with a top to put things on."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.furniture.seating import legs
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import Interval, Mesh, bevelled, box, cylinder, lathe, merge, picture, placed


def _table(kind: str, wood: Finish, size: tuple[float, float, float], leg: float, rng: np.random.Generator) -> Piece:
    """A table of width, depth and height: on four legs with aprons, on trestles, or a thick top on slim metal legs."""
    width, depth, height = size
    half, inset, top = width / 2, 0.05, height - 0.035
    design = int(rng.integers(3))
    if design == 1:
        stand = [
            bevelled((x - 0.04, x + 0.04), (0.08, depth - 0.08), z)
            for x in (-half + 0.22, half - 0.22)
            for z in ((0.0, 0.05), (top - 0.05, top))
        ]
        stand += [
            bevelled((x - 0.03, x + 0.03), (depth / 2 - 0.1, depth / 2 + 0.1), (0.05, top - 0.05))
            for x in (-half + 0.22, half - 0.22)
        ]
        stand += [box((-half + 0.25, half - 0.25), (depth / 2 - 0.02, depth / 2 + 0.02), (0.3 * top, 0.3 * top + 0.08))]
    else:
        leg = leg if design == 0 else 0.6 * leg
        stand = [legs(width - 2 * inset, (inset, depth - inset), top, leg)]
        z = (height - 0.12, top)
        stand += [box((-half + inset + leg, half - inset - leg), (y, y + 0.02), z) for y in (0.06, depth - 0.08)]
        stand += [box((x, x + 0.02), (inset + leg, depth - inset - leg), z) for x in (-half + 0.06, half - 0.08)]
    return Piece(
        kind,
        (
            Component("stand", wood, merge(stand)),
            Component("top", wood, bevelled((-half, half), (0.0, depth), (top, height))),
        ),
        tops=(Top((-half + 0.1, half - 0.1), (0.1, depth - 0.1), height),),
    )


def _wood(palette: Palette, rng: np.random.Generator) -> Finish:
    return (palette.oak, palette.walnut, palette.oak, palette.white)[int(rng.integers(4))]


def dining_table(palette: Palette, rng: np.random.Generator) -> Piece:
    return _table("table", _wood(palette, rng), (float(rng.uniform(1.2, 1.7)), 0.85, 0.75), 0.06, rng)


def kitchen_table(palette: Palette, rng: np.random.Generator) -> Piece:
    return _table("table", _wood(palette, rng), (float(rng.uniform(0.8, 1.0)), 0.75, 0.75), 0.055, rng)


def coffee_table(palette: Palette, rng: np.random.Generator) -> Piece:
    """Rectangular with a shelf, or round on a drum."""
    if rng.random() < 0.35:
        return _drum_table(palette)
    wood = _wood(palette, rng)
    table = _table("coffee_table", wood, (float(rng.uniform(0.8, 1.05)), 0.52, 0.42), 0.05, rng)
    low, high = table.bounds
    shelf = bevelled((low[0] + 0.3, high[0] - 0.3), (0.12, 0.4), (0.18, 0.2))
    return Piece(table.kind, (*table.components, Component("shelf", wood, shelf)), table.tops)


def _drum_table(palette: Palette) -> Piece:
    y = 0.38
    drum = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.02), (0.13, 0.1), (0.13, 0.3), (0.2, 0.4), (0.0, 0.4)]
    top = [(0.0, 0.4), (0.37, 0.4), (0.38, 0.41), (0.38, 0.43), (0.37, 0.44), (0.0, 0.44)]
    return Piece(
        "coffee_table",
        (
            Component("drum", palette.walnut, lathe(drum, (0.0, y, 0.0), 24)),
            Component("top", palette.walnut, lathe(top, (0.0, y, 0.0), 32)),
        ),
        tops=(Top((-0.22, 0.22), (y - 0.22, y + 0.22), 0.44),),
    )


def round_table(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small side table on one foot, or a stool-like one on legs."""
    y = 0.25
    wood = _wood(palette, rng)
    if rng.random() < 0.5:
        stand = Component(
            "foot",
            palette.metal,
            merge(
                [
                    lathe([(0, 0), (0.17, 0), (0.17, 0.015), (0, 0.03)], (0, y, 0), 20),
                    cylinder(0.02, (0.02, 0.5), (0.0, y)),
                ]
            ),
        )
    else:
        stand = Component("legs", wood, legs(0.32, (y - 0.16, y + 0.16), 0.5, 0.03))
    return Piece(
        "side_table",
        (stand, Component("top", wood, cylinder(0.24, (0.5, 0.525), (0.0, y), 24))),
        tops=(Top((-0.14, 0.14), (y - 0.14, y + 0.14), 0.525),),
    )


def _fronts(x: Interval, z: Interval, y: float, columns: int, rows: int) -> tuple[Mesh, Mesh]:
    """Doors or drawers on a grid with gaps, and a handle on each."""
    xs, zs = np.linspace(*x, columns + 1), np.linspace(*z, rows + 1)
    panels, handles = [], []
    for x0, x1 in pairwise(xs.tolist()):
        for z0, z1 in pairwise(zs.tolist()):
            panels.append(bevelled((x0 + 0.004, x1 - 0.004), (y, y + 0.018), (z0 + 0.004, z1 - 0.004), 0.004))
            handles.append(_handle(x0, x1, z0, z1, y + 0.018))
    return merge(panels), merge(handles)


def _handle(x0: float, x1: float, z0: float, z1: float, y: float) -> Mesh:
    """A bar: upright near the edge of a tall door, level near the top of a drawer."""
    if z1 - z0 > x1 - x0:
        middle = (z0 + z1) / 2
        return box((x1 - 0.06, x1 - 0.045), (y, y + 0.025), (middle - 0.07, middle + 0.07))
    middle = (x0 + x1) / 2
    return box((middle - 0.07, middle + 0.07), (y, y + 0.025), (z1 - 0.06, z1 - 0.045))


def cabinet(
    kind: str,
    size: tuple[float, float, float],
    grid: tuple[int, int],
    wood: Finish,
    front: Finish,
    metal: Finish,
    plinth: float = 0.07,
) -> Piece:
    """A closed cabinet of width, depth, height with columns and rows of doors or drawers."""
    width, depth, height = size
    half, body = width / 2, depth - 0.043
    panels, handles = _fronts((-half, half), (plinth, height - 0.03), body, *grid)
    return Piece(
        kind,
        (
            Component("plinth", wood, box((-half + 0.02, half - 0.02), (0.0, body - 0.04), (0.0, plinth))),
            Component("body", wood, box((-half, half), (0.0, body), (plinth, height - 0.03))),
            Component(
                "top", wood, bevelled((-half - 0.005, half + 0.005), (0.0, body + 0.02), (height - 0.03, height))
            ),
            Component("fronts", front, panels),
            Component("handles", metal, handles),
        ),
        tops=(Top((-half + 0.08, half - 0.08), (0.06, body - 0.06), height),),
        front=0.4,
    )


def wardrobe(palette: Palette, rng: np.random.Generator) -> Piece:
    doors, wood = int(rng.integers(2, 5)), _wood(palette, rng)
    front = (palette.lacquer, palette.white, palette.walnut)[int(rng.integers(3))]
    unit = cabinet("wardrobe", (0.5 * doors, 0.58, 2.1), (doors, 1), wood, front, palette.metal)
    if rng.random() < 0.6:
        return unit
    x = float(rng.integers(doors)) * 0.5 - 0.25 * doors
    glass = placed(picture(0.36, (0.2, 1.95), 0.5775), at=(x + 0.25, 0.0, 0.0))
    return replace(unit, components=(*unit.components, Component("picture", palette.mirror, glass)))


def dresser(palette: Palette, rng: np.random.Generator) -> Piece:
    wood = _wood(palette, rng)
    size = (float(rng.uniform(0.8, 1.2)), 0.45, float(rng.uniform(0.75, 0.95)))
    return cabinet("dresser", size, (2, int(rng.integers(3, 5))), wood, wood, palette.metal)


def nightstand(palette: Palette, rng: np.random.Generator) -> Piece:
    wood = _wood(palette, rng)
    return cabinet("nightstand", (0.42, 0.38, float(rng.uniform(0.45, 0.55))), (1, 2), wood, wood, palette.metal)


def sideboard(palette: Palette, rng: np.random.Generator) -> Piece:
    width, front = float(rng.uniform(1.2, 1.6)), _wood(palette, rng)
    return cabinet("sideboard", (width, 0.42, 0.8), (3, 1), palette.oak, front, palette.metal)


def shoe_cabinet(palette: Palette, rng: np.random.Generator) -> Piece:
    return cabinet("shoe_cabinet", (0.75, 0.25, 0.9), (1, 3), palette.white, _wood(palette, rng), palette.metal)


def tv_bench(palette: Palette, rng: np.random.Generator) -> Piece:
    return cabinet("tv_bench", (1.6, 0.42, 0.46), (3, 1), palette.walnut, _wood(palette, rng), palette.metal)


def desk(palette: Palette, rng: np.random.Generator) -> Piece:
    """A table top on a drawer unit and two legs."""
    width, depth, height = float(rng.uniform(1.2, 1.45)), 0.65, 0.74
    half = width / 2
    unit = box((half - 0.42, half - 0.02), (0.04, depth - 0.06), (0.05, height - 0.03))
    panels, handles = _fronts((half - 0.42, half - 0.02), (0.05, height - 0.03), depth - 0.06, 1, 3)
    frame = [box((-half + 0.03, -half + 0.08), (y, y + 0.05), (0.0, height - 0.03)) for y in (0.04, depth - 0.1)]
    back = box((-half + 0.08, half - 0.42), (0.05, 0.07), (0.35, height - 0.03))
    return Piece(
        "desk",
        (
            Component("legs", palette.metal, merge(frame)),
            Component("drawers", palette.white, unit),
            Component("fronts", palette.oak, panels),
            Component("handles", palette.metal, handles),
            Component("back", palette.oak, back),
            Component("top", palette.oak, bevelled((-half, half), (0.0, depth), (height - 0.03, height))),
        ),
        tops=(Top((-half + 0.06, half - 0.06), (0.05, depth - 0.12), height),),
        front=0.6,
    )
