"""Tables, desks and sideboards: things with a top to put things on."""

from itertools import pairwise

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.furniture.seating import legs
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import Interval, Mesh, box, cylinder, lathe, merge


def _table(kind: str, wood: Finish, width: float, depth: float, height: float, leg: float) -> Piece:
    half, inset = width / 2, 0.05
    z = (height - 0.12, height - 0.035)
    aprons = [box((-half + inset + leg, half - inset - leg), (y, y + 0.02), z) for y in (0.06, depth - 0.08)]
    aprons += [box((x, x + 0.02), (inset + leg, depth - inset - leg), z) for x in (-half + 0.06, half - 0.08)]
    return Piece(
        kind,
        (
            Component("legs", wood, legs(width - 2 * inset, (inset, depth - inset), height - 0.035, leg)),
            Component("aprons", wood, merge(aprons)),
            Component("top", wood, box((-half, half), (0.0, depth), (height - 0.035, height))),
        ),
        tops=(Top((-half + 0.1, half - 0.1), (0.1, depth - 0.1), height),),
    )


def dining_table(palette: Palette, rng: np.random.Generator) -> Piece:
    return _table("table", palette.oak, float(rng.uniform(1.2, 1.6)), 0.85, 0.75, 0.06)


def kitchen_table(palette: Palette, rng: np.random.Generator) -> Piece:
    return _table("table", palette.oak, float(rng.uniform(0.8, 1.0)), 0.75, 0.75, 0.055)


def coffee_table(palette: Palette, rng: np.random.Generator) -> Piece:
    table = _table("coffee_table", palette.walnut, float(rng.uniform(0.8, 1.05)), 0.52, 0.42, 0.05)
    low, high = table.bounds
    shelf = box((low[0] + 0.07, high[0] - 0.07), (0.07, 0.45), (0.14, 0.16))
    return Piece(table.kind, (*table.components, Component("shelf", palette.walnut, shelf)), table.tops)


def round_table(palette: Palette, _: np.random.Generator) -> Piece:
    """A small side table on one foot."""
    y = 0.25
    return Piece(
        "side_table",
        (
            Component("foot", palette.metal, lathe([(0, 0), (0.17, 0), (0.17, 0.015), (0, 0.03)], (0, y, 0), 20)),
            Component("column", palette.metal, cylinder(0.02, (0.02, 0.5), (0.0, y))),
            Component("top", palette.oak, cylinder(0.24, (0.5, 0.525), (0.0, y), 24)),
        ),
        tops=(Top((-0.14, 0.14), (y - 0.14, y + 0.14), 0.525),),
    )


def _fronts(x: Interval, z: Interval, y: float, columns: int, rows: int) -> tuple[Mesh, Mesh]:
    """Doors or drawers on a grid with gaps, and a handle on each."""
    xs, zs = np.linspace(*x, columns + 1), np.linspace(*z, rows + 1)
    panels, handles = [], []
    for x0, x1 in pairwise(xs.tolist()):
        for z0, z1 in pairwise(zs.tolist()):
            panels.append(box((x0 + 0.004, x1 - 0.004), (y, y + 0.018), (z0 + 0.004, z1 - 0.004)))
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
            Component("top", wood, box((-half - 0.005, half + 0.005), (0.0, body + 0.02), (height - 0.03, height))),
            Component("fronts", front, panels),
            Component("handles", metal, handles),
        ),
        tops=(Top((-half + 0.08, half - 0.08), (0.06, body - 0.06), height),),
        front=0.4,
    )


def wardrobe(palette: Palette, rng: np.random.Generator) -> Piece:
    doors = int(rng.integers(2, 5))
    return cabinet("wardrobe", (0.5 * doors, 0.58, 2.1), (doors, 1), palette.oak, palette.lacquer, palette.metal)


def dresser(palette: Palette, rng: np.random.Generator) -> Piece:
    return cabinet(
        "dresser", (float(rng.uniform(0.8, 1.1)), 0.45, 0.85), (2, 3), palette.walnut, palette.walnut, palette.metal
    )


def nightstand(palette: Palette, _: np.random.Generator) -> Piece:
    return cabinet("nightstand", (0.42, 0.38, 0.5), (1, 2), palette.walnut, palette.walnut, palette.metal)


def sideboard(palette: Palette, _: np.random.Generator) -> Piece:
    return cabinet("sideboard", (1.4, 0.42, 0.8), (3, 1), palette.oak, palette.white, palette.metal)


def shoe_cabinet(palette: Palette, _: np.random.Generator) -> Piece:
    return cabinet("shoe_cabinet", (0.75, 0.25, 0.9), (1, 3), palette.white, palette.oak, palette.metal)


def tv_bench(palette: Palette, _: np.random.Generator) -> Piece:
    return cabinet("tv_bench", (1.6, 0.42, 0.46), (3, 1), palette.walnut, palette.oak, palette.metal)


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
            Component("top", palette.oak, box((-half, half), (0.0, depth), (height - 0.03, height))),
        ),
        tops=(Top((-half + 0.06, half - 0.06), (0.05, depth - 0.12), height),),
        front=0.6,
    )
