"""Small things that stand on worktops, each centred on its origin."""

import numpy as np

from slamgym.scenes.home.furniture.clutter import bottles, fruit_bowl, mug, packages, plates, small_plant
from slamgym.scenes.home.furniture.piece import Component, Maker, Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import bevelled, box, cylinder, lathe, merge, tilted


def kettle(palette: Palette, rng: np.random.Generator) -> Piece:
    body = [(0.0, 0.0), (0.085, 0.0), (0.085, 0.03), (0.06, 0.19), (0.05, 0.205), (0.0, 0.21)]
    handle = [
        bevelled((-0.012, 0.012), (0.06, 0.11), (0.175, 0.195)),
        bevelled((-0.012, 0.012), (0.095, 0.115), (0.06, 0.18)),
    ]
    finish = (palette.metal, palette.porcelain, palette.black, palette.plastics[0])[int(rng.integers(4))]
    return Piece(
        "kettle",
        (
            Component("body", finish, lathe(body, sides=20)),
            Component("handle", palette.black, merge(handle)),
            Component("spout", finish, tilted(cylinder(0.016, (0.0, 0.06), sides=8), 0.9, (0.0, -0.055, 0.14))),
        ),
    )


def toaster(palette: Palette, rng: np.random.Generator) -> Piece:
    finish = (palette.metal, palette.porcelain, *palette.plastics[:2])[int(rng.integers(4))]
    slots = [box((-0.11, 0.11), (y - 0.015, y + 0.015), (0.18, 0.182)) for y in (-0.035, 0.035)]
    return Piece(
        "toaster",
        (
            Component("body", finish, bevelled((-0.15, 0.15), (-0.085, 0.085), (0.008, 0.18), 0.025)),
            Component("slots", palette.black, merge(slots)),
            Component("lever", palette.black, bevelled((0.15, 0.17), (-0.02, 0.02), (0.11, 0.125))),
            Component("foot", palette.black, box((-0.13, 0.13), (-0.07, 0.07), (0.0, 0.008))),
        ),
    )


def microwave(palette: Palette, _: np.random.Generator) -> Piece:
    return Piece(
        "microwave",
        (
            Component("body", palette.porcelain, bevelled((-0.24, 0.24), (-0.17, 0.17), (0.01, 0.28))),
            Component("window", palette.glass, box((-0.11, 0.22), (0.17, 0.174), (0.04, 0.25))),
            Component("panel", palette.black, box((-0.22, -0.13), (0.17, 0.173), (0.04, 0.25))),
            Component("handle", palette.metal, bevelled((-0.125, -0.112), (0.172, 0.2), (0.05, 0.24))),
            Component("feet", palette.black, box((-0.2, 0.2), (-0.13, 0.13), (0.0, 0.01))),
        ),
    )


def knife_block(palette: Palette, _: np.random.Generator) -> Piece:
    handles = [
        bevelled((x - 0.008, x + 0.008), (y - 0.012, y + 0.012), (0.2, 0.3))
        for x in (-0.025, 0.0, 0.025)
        for y in (-0.04, 0.02)
    ]
    return Piece(
        "knife_block",
        (
            Component("block", palette.walnut, bevelled((-0.05, 0.05), (-0.08, 0.08), (0.0, 0.2))),
            Component("handles", palette.black, merge(handles)),
        ),
    )


def cutting_board(palette: Palette, _: np.random.Generator) -> Piece:
    """With a loaf on it."""
    loaf = [(0.0, 0.022), (0.055, 0.022), (0.065, 0.05), (0.045, 0.085), (0.0, 0.095)]
    return Piece(
        "cutting_board",
        (
            Component("board", palette.oak, bevelled((-0.18, 0.18), (-0.12, 0.12), (0.0, 0.022))),
            Component("loaf", palette.clay, lathe(loaf, (0.05, 0.0, 0.0), 14)),
        ),
    )


def pan(palette: Palette, _: np.random.Generator) -> Piece:
    body = [(0.0, 0.0), (0.1, 0.0), (0.115, 0.11), (0.11, 0.11), (0.096, 0.008), (0.0, 0.008)]
    grips = [bevelled((x - 0.03, x + 0.03), (-0.012, 0.012), (0.085, 0.1)) for x in (-0.135, 0.135)]
    return Piece(
        "pan",
        (Component("body", palette.metal, lathe(body, sides=20)), Component("grips", palette.black, merge(grips))),
    )


def dish_rack(palette: Palette, _: np.random.Generator) -> Piece:
    wires = [box((x, x + 0.004), (-0.13, 0.13), (0.01, 0.1)) for x in np.linspace(-0.18, 0.176, 10)]
    dishes = [tilted(cylinder(0.105, (0.0, 0.008), sides=18), 1.4, (0.0, -0.09 + 0.05 * i, 0.13)) for i in range(3)]
    return Piece(
        "dish_rack",
        (
            Component("tray", palette.metal, bevelled((-0.2, 0.2), (-0.15, 0.15), (0.0, 0.012))),
            Component("wires", palette.metal, merge(wires)),
            Component("dishes", palette.porcelain, merge(dishes)),
        ),
    )


ON_KITCHEN_TOPS: tuple[Maker, ...] = (
    *(packages, bottles, kettle, toaster, fruit_bowl, knife_block, mug, microwave, cutting_board),
    *(packages, pan, dish_rack, small_plant, plates),
)
