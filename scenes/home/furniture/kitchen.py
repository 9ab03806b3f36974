"""Kitchen units, 0.6 m wide, to stand side by side along a wall."""

from collections.abc import Callable

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.furniture.shelves import BOX_FRONT, in_atlas
from slamgym.scenes.home.furniture.tables import cabinet
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.prints import LABELS
from slamgym.scenes.home.solids import bevelled, box, cylinder, merge, tilted

UNIT = 0.6
_HALF, _DEPTH, _HEIGHT = UNIT / 2, 0.6, 0.9


def _carcass(palette: Palette) -> tuple[Component, Component]:
    return (
        Component("plinth", palette.black, box((-_HALF, _HALF), (0.0, 0.5), (0.0, 0.1))),
        Component("body", palette.white, box((-_HALF, _HALF), (0.0, 0.56), (0.1, _HEIGHT - 0.04))),
    )


def _worktop(palette: Palette) -> Component:
    return Component(
        "worktop", palette.counter, bevelled((-_HALF, _HALF), (0.0, _DEPTH + 0.02), (_HEIGHT - 0.04, _HEIGHT))
    )


def cupboard(palette: Palette, rng: np.random.Generator) -> Piece:
    """A base unit with drawers or doors and a worktop."""
    grid = (1, 3) if rng.random() < 0.5 else (2, 1)
    unit = cabinet(
        "cupboard", (UNIT, _DEPTH + 0.02, _HEIGHT - 0.01), grid, palette.white, palette.fronts, palette.metal
    )
    parts = tuple(c for c in unit.components if c.name in ("fronts", "handles"))
    tops = (Top((-0.24, 0.24), (0.08, 0.5), _HEIGHT),)
    return Piece("cupboard", (*_carcass(palette), *parts, _worktop(palette)), tops, front=0.5)


def sink(palette: Palette, rng: np.random.Generator) -> Piece:
    """A cupboard whose worktop has a basin let in, and a tap."""
    unit = cupboard(palette, rng)
    kept = tuple(c for c in unit.components if c.name in ("plinth", "fronts", "handles"))
    body = box((-_HALF, _HALF), (0.0, 0.56), (0.1, 0.7))
    top = (_HEIGHT - 0.04, _HEIGHT)
    rim = [
        box((-_HALF, -0.23), (0.0, 0.62), top),
        box((0.23, _HALF), (0.0, 0.62), top),
        box((-0.23, 0.23), (0.0, 0.118), top),
        box((-0.23, 0.23), (0.5, 0.62), top),
    ]
    basin = [
        box((-0.24, -0.22), (0.1, 0.52), (0.7, _HEIGHT + 0.004)),
        box((0.22, 0.24), (0.1, 0.52), (0.7, _HEIGHT + 0.004)),
        box((-0.22, 0.22), (0.1, 0.12), (0.7, _HEIGHT + 0.004)),
        box((-0.22, 0.22), (0.5, 0.52), (0.7, _HEIGHT + 0.004)),
        box((-0.22, 0.22), (0.12, 0.5), (0.7, 0.715)),
    ]
    tap = [cylinder(0.014, (_HEIGHT, _HEIGHT + 0.26), (0.0, 0.07), 10)]
    tap += [box((-0.012, 0.012), (0.07, 0.26), (_HEIGHT + 0.24, _HEIGHT + 0.265))]
    return Piece(
        "sink",
        (
            *kept,
            Component("body", palette.white, body),
            Component("worktop", palette.counter, merge(rim)),
            Component("basin", palette.metal, merge(basin)),
            Component("tap", palette.metal, merge(tap)),
        ),
        front=0.5,
    )


def oven(palette: Palette, _: np.random.Generator) -> Piece:
    """A built-in oven under a hob."""
    knobs = [tilted(cylinder(0.018, (0.0, 0.02)), -np.pi / 2, (x, 0.585, 0.8)) for x in (-0.2, -0.1, 0.1, 0.2)]
    rings = [
        cylinder(r, (_HEIGHT + 0.006, _HEIGHT + 0.012), (x, y), 16)
        for x, y, r in ((-0.14, 0.17, 0.08), (0.14, 0.17, 0.1), (-0.14, 0.42, 0.1), (0.14, 0.42, 0.08))
    ]
    return Piece(
        "oven",
        (
            *_carcass(palette),
            Component("front", palette.metal, box((-0.297, 0.297), (0.56, 0.585), (0.11, 0.85))),
            Component("window", palette.glass, box((-0.24, 0.24), (0.585, 0.59), (0.3, 0.66))),
            Component("handle", palette.metal, box((-0.25, 0.25), (0.6, 0.62), (0.7, 0.72))),
            Component("knobs", palette.black, merge(knobs)),
            _worktop(palette),
            Component("hob", palette.glass, box((-0.27, 0.27), (0.05, 0.55), (_HEIGHT, _HEIGHT + 0.006))),
            Component("rings", palette.metal, merge(rings)),
        ),
        front=0.5,
    )


def fridge(palette: Palette, _: np.random.Generator) -> Piece:
    doors = [bevelled((-0.296, 0.296), (0.6, 0.64), z) for z in ((0.06, 0.62), (0.63, 1.8))]
    handles = [bevelled((-0.26, -0.235), (0.64, 0.68), z) for z in ((0.36, 0.58), (0.67, 1.1))]
    notes = [
        in_atlas(box((x, x + 0.1), (0.64, 0.643), (z, z + 0.13)), BOX_FRONT, (0, i), LABELS)
        for i, (x, z) in enumerate(((0.02, 1.3), (0.15, 1.36), (-0.12, 1.45), (0.08, 1.52)))
    ]
    return Piece(
        "fridge",
        (
            Component("body", palette.white, bevelled((-0.3, 0.3), (0.02, 0.6), (0.04, 1.82), 0.012)),
            Component("feet", palette.black, box((-0.28, 0.28), (0.06, 0.58), (0.0, 0.04))),
            Component("doors", palette.white, merge(doors)),
            Component("handles", palette.metal, merge(handles)),
            Component("notes", palette.labels, merge(notes)),
        ),
        front=0.5,
    )


def backsplash(palette: Palette, height: float) -> Piece:
    """Tiles above a unit's worktop."""
    tiles = box((-_HALF, _HALF), (0.0, 0.006), (_HEIGHT + 0.001, _HEIGHT + height))
    return Piece("backsplash", (Component("tiles", palette.backsplash, tiles),))


def wall_cupboard(palette: Palette, _: np.random.Generator) -> Piece:
    """Hangs above the worktop; its origin is its lower edge."""
    unit = cabinet("wall_cupboard", (UNIT, 0.34, 0.7), (2, 1), palette.white, palette.fronts, palette.metal, 0.0)
    return Piece(unit.kind, tuple(c for c in unit.components if c.name != "plinth"))


def hood(palette: Palette, _: np.random.Generator) -> Piece:
    """An extractor hood above the oven; its origin is its lower edge."""
    return Piece(
        "hood",
        (
            Component("skirt", palette.metal, box((-_HALF, _HALF), (0.0, 0.48), (0.0, 0.06))),
            Component("filter", palette.black, box((-0.26, 0.26), (0.04, 0.44), (-0.008, 0.0))),
            Component("chimney", palette.metal, box((-0.14, 0.14), (0.0, 0.26), (0.06, 0.8))),
        ),
    )


BASE_UNITS: tuple[Callable[[Palette, np.random.Generator], Piece], ...] = (sink, oven, cupboard, cupboard, cupboard)
"""The row along the wall after the fridge, as far as there is room."""
