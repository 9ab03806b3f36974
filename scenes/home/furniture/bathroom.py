"""Toilet, basin, bath, shower, washing machine and what hangs beside them."""

import numpy as np

from slamgym.scenes.home.furniture.clutter import bottles
from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.furniture.tables import cabinet
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import (
    Mesh,
    bevelled,
    box,
    cushion,
    cylinder,
    lathe,
    merge,
    picture,
    placed,
    stretched,
    tilted,
)


def toilet(palette: Palette, _: np.random.Generator) -> Piece:
    bowl = [(0.0, 0.0), (0.13, 0.0), (0.12, 0.18), (0.2, 0.38), (0.2, 0.4), (0.14, 0.4), (0.08, 0.22), (0.0, 0.2)]
    seat = [(0.13, 0.4), (0.205, 0.4), (0.205, 0.425), (0.13, 0.425), (0.13, 0.4)]
    lid = tilted(cushion((-0.19, 0.19), (0.0, 0.42), (-0.012, 0.012), 0.3), 1.45, (0.0, 0.22, 0.43))
    return Piece(
        "toilet",
        (
            Component("bowl", palette.porcelain, placed(stretched(lathe(bowl, sides=20), y=1.25), 0.0, (0, 0.44, 0))),
            Component("foot", palette.porcelain, box((-0.1, 0.1), (0.1, 0.36), (0.0, 0.3))),
            Component("seat", palette.white, placed(stretched(lathe(seat, sides=20), y=1.25), 0.0, (0, 0.44, 0))),
            Component("lid", palette.white, lid),
            Component("cistern", palette.porcelain, cushion((-0.2, 0.2), (0.0, 0.17), (0.38, 0.8), 0.2)),
            Component("button", palette.metal, cylinder(0.025, (0.795, 0.808), (0.0, 0.09))),
        ),
        front=0.4,
    )


def washbasin(palette: Palette, rng: np.random.Generator) -> Piece:
    """A basin on a cabinet, with a tap."""
    unit = cabinet("washbasin", (0.6, 0.44, 0.78), (2, 1), palette.white, palette.fronts, palette.metal)
    bowl = [(0.0, 0.0), (0.14, 0.0), (0.21, 0.12), (0.19, 0.12), (0.12, 0.02), (0.0, 0.015)]
    tap = [cylinder(0.013, (0.78, 1.02), (0.0, 0.05), 10), box((-0.011, 0.011), (0.05, 0.18), (1.0, 1.022))]
    cup = [cylinder(0.03, (0.78, 0.88), (0.23, 0.2)), cylinder(0.005, (0.88, 0.97), (0.235, 0.2), 6)]
    return Piece(
        "washbasin",
        (
            *unit.components,
            Component("bowl", palette.porcelain, stretched(lathe(bowl, (0.0, 0.23, 0.78), 20), x=1.2)),
            Component("tap", palette.metal, merge(tap)),
            Component("cup", palette.cushions[int(rng.integers(3))], merge(cup)),
        ),
        front=0.4,
    )


def bath(palette: Palette, _: np.random.Generator) -> Piece:
    """A tub with its long side to the wall, boxed in."""
    length, width, height = 1.6, 0.72, 0.56
    tub = [(0.0, 0.1), (0.7, 0.14), (0.94, height - 0.03), (1.0, height - 0.03), (1.0, height)]
    tub += [(0.84, height), (0.66, 0.18), (0.0, 0.14)]
    apron = [(0.95, 0.0), (0.97, 0.0), (0.97, height - 0.03), (0.95, height - 0.03), (0.95, 0.0)]
    shells = [
        placed(stretched(lathe(profile, sides=32, roundness=0.3), length / 2, width / 2), at=(0.0, width / 2, 0.0))
        for profile in (tub, apron)
    ]
    x = -length / 2 + 0.06
    tap = [cylinder(0.015, (height, height + 0.14), (x, width / 2), 10)]
    tap += [box((x, x + 0.2), (width / 2 - 0.012, width / 2 + 0.012), (height + 0.12, height + 0.142))]
    return Piece(
        "bath",
        (
            Component("tub", palette.porcelain, shells[0]),
            Component("apron", palette.white, shells[1]),
            Component("tap", palette.metal, merge(tap)),
        ),
        front=0.4,
    )


def shower(palette: Palette, _: np.random.Generator) -> Piece:
    """A tray with two glass-framed sides, for a corner; the panes are left out, for they would hide the inside."""
    side = 0.85
    half = side / 2
    posts = [
        box((x, x + 0.03), (y, y + 0.03), (0.05, 1.95))
        for x, y in ((-half, side - 0.03), (half - 0.03, side - 0.03), (-half, 0.0), (half - 0.03, 0.0))
    ]
    rails = [
        box((-half, half), (side - 0.03, side), (1.93, 1.97)),
        box((-half, -half + 0.03), (0.03, side - 0.03), (1.93, 1.97)),
        box((half - 0.03, half), (0.03, side - 0.03), (1.93, 1.97)),
    ]
    head = [box((-0.012, 0.012), (0.0, 0.03), (0.9, 2.05)), box((-0.012, 0.012), (0.03, 0.3), (2.03, 2.05))]
    head += [cylinder(0.09, (2.0, 2.03), (0.0, 0.3))]
    return Piece(
        "shower",
        (
            Component("tray", palette.porcelain, box((-half, half), (0.0, side), (0.0, 0.06))),
            Component("posts", palette.metal, merge([*posts, *rails])),
            Component("head", palette.metal, merge(head)),
        ),
        front=0.4,
    )


def washing_machine(palette: Palette, _: np.random.Generator) -> Piece:
    forward = -np.pi / 2
    ring = [(0.15, 0.0), (0.2, 0.0), (0.19, 0.03), (0.15, 0.03), (0.15, 0.0)]
    return Piece(
        "washing_machine",
        (
            Component("body", palette.white, box((-0.3, 0.3), (0.02, 0.58), (0.02, 0.85))),
            Component("ring", palette.metal, tilted(lathe(ring, sides=20), forward, (0.0, 0.58, 0.42))),
            Component(
                "glass", palette.glass, tilted(cylinder(0.15, (0.0, 0.02), sides=20), forward, (0.0, 0.58, 0.42))
            ),
            Component("panel", palette.black, box((-0.05, 0.28), (0.58, 0.585), (0.73, 0.82))),
            Component("drawer", palette.trim, box((-0.28, -0.08), (0.58, 0.59), (0.73, 0.82))),
            Component("foot", palette.black, box((-0.28, 0.28), (0.06, 0.54), (0.0, 0.02))),
        ),
        tops=(Top((-0.22, 0.22), (0.08, 0.5), 0.85),),
        front=0.4,
    )


def mirror_cabinet(palette: Palette, _: np.random.Generator) -> Piece:
    """Hangs above the basin; its origin is its lower edge."""
    unit = cabinet("mirror_cabinet", (0.6, 0.16, 0.65), (2, 1), palette.white, palette.white, palette.metal, 0.0)
    kept = tuple(c for c in unit.components if c.name != "plinth")
    return Piece(unit.kind, (*kept, Component("picture", palette.mirror, picture(0.57, (0.03, 0.58), 0.136))))


def towel_rail(palette: Palette, rng: np.random.Generator) -> Piece:
    """A heated ladder with towels; its origin is on the floor."""
    posts = [box((x, x + 0.03), (0.04, 0.07), (0.5, 1.6)) for x in (-0.25, 0.22)]
    rungs = [box((-0.22, 0.22), (0.05, 0.065), (z, z + 0.02)) for z in np.linspace(0.55, 1.55, 9)]
    brackets = [box((x, x + 0.02), (0.0, 0.04), (z, z + 0.02)) for x in (-0.245, 0.225) for z in (0.6, 1.5)]
    towels = [cushion((-0.2, 0.18), (0.03, 0.09), (z, z + 0.36), 0.2) for z in (0.62, 1.1)]
    towel = palette.cushions[int(rng.integers(3))]
    return Piece(
        "towel_rail",
        (
            Component("posts", palette.metal, merge(posts)),
            Component("rungs", palette.metal, merge([*rungs, *brackets])),
            Component("towels", towel, merge(towels)),
        ),
    )


def laundry_basket(palette: Palette, _: np.random.Generator) -> Piece:
    y = 0.22
    shell = [(0.0, 0.0), (0.17, 0.0), (0.2, 0.5), (0.185, 0.5), (0.16, 0.03), (0.0, 0.02)]
    bands = [
        lathe(
            [
                (0.176 + 0.06 * z, z),
                (0.188 + 0.06 * z, z),
                (0.188 + 0.06 * z, z + 0.03),
                (0.176 + 0.06 * z, z + 0.03),
                (0.176 + 0.06 * z, z),
            ],
            (0, y, 0),
        )
        for z in (0.1, 0.25, 0.4)
    ]
    return Piece(
        "laundry_basket",
        (
            Component("shell", palette.oak, lathe(shell, (0.0, y, 0.0))),
            Component("bands", palette.walnut, merge(bands)),
            Component("clothes", palette.cushions[0], cushion((-0.14, 0.14), (y - 0.14, y + 0.14), (0.38, 0.56), 0.7)),
        ),
    )


def towel_hooks(palette: Palette, rng: np.random.Generator) -> Piece:
    """A rail with hooks and two towels; its origin is the rail's middle."""
    towels = [
        cushion((x - 0.11, x + 0.11), (0.015, 0.06), (-float(rng.uniform(0.5, 0.75)), 0.01), 0.25)
        for x in (-0.14, 0.14)
    ]
    cloths = [palette.cushions[int(i)] for i in rng.permutation(3)[:2]]
    return Piece(
        "towel_hooks",
        (
            Component("rail", palette.metal, box((-0.3, 0.3), (0.0, 0.014), (-0.015, 0.025))),
            *(
                Component(f"towel_{i}", cloth, towel)
                for i, (cloth, towel) in enumerate(zip(cloths, towels, strict=True))
            ),
        ),
    )


def paper_roll(palette: Palette, _: np.random.Generator) -> Piece:
    roll = cylinder(0.05, (-0.05, 0.05), sides=16)
    x, y, z = roll.vertices.T
    level = Mesh(np.column_stack([z, y + 0.065, -x]), roll.faces, roll.uv)
    return Piece(
        "paper_roll",
        (
            Component("roll", palette.linen, level),
            Component("holder", palette.metal, bevelled((-0.07, 0.07), (0.0, 0.012), (0.03, 0.07), 0.004)),
            Component("sheet", palette.linen, box((-0.048, 0.048), (0.012, 0.0145), (-0.12, 0.0))),
        ),
    )


def bath_shelf(palette: Palette, rng: np.random.Generator) -> Piece:
    """A glass shelf's worth of bottles and a folded towel."""
    jars = bottles(palette, rng).placed(0.0, (-0.1, 0.09, 0.018)).components
    return Piece(
        "bath_shelf",
        (
            Component("board", palette.white, bevelled((-0.3, 0.3), (0.0, 0.16), (-0.0, 0.016))),
            Component(
                "brackets", palette.metal, merge(box((x, x + 0.015), (0.0, 0.1), (-0.05, -0.001)) for x in (-0.2, 0.2))
            ),
            Component(
                "towel", palette.cushions[int(rng.integers(3))], cushion((0.08, 0.28), (0.02, 0.15), (0.016, 0.12), 0.3)
            ),
            *jars,
        ),
    )
