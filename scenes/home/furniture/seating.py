"""Chairs, armchairs, sofas, beds."""

from itertools import pairwise

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh, box, cushion, cylinder, lathe, merge, placed, tilted


def legs(width: float, y: tuple[float, float], height: float, thickness: float = 0.045) -> Mesh:
    """Four square legs at the corners of a rectangle centred on x = 0."""
    half = width / 2
    xs = ((-half, -half + thickness), (half - thickness, half))
    ys = ((y[0], y[0] + thickness), (y[1] - thickness, y[1]))
    return merge(box(leg_x, leg_y, (0.0, height)) for leg_x in xs for leg_y in ys)


def chair(palette: Palette, rng: np.random.Generator) -> Piece:
    """Its back is at y = 0, one sits facing +y."""
    wood = palette.oak if rng.random() < 0.5 else palette.walnut
    posts = [box((x, x + 0.035), (0.0, 0.035), (0.44, 0.9)) for x in (-0.21, 0.175)]
    slats = [box((-0.175, 0.175), (0.008, 0.026), (z, z + 0.07)) for z in (0.56, 0.68, 0.8)]
    return Piece(
        "chair",
        (
            Component("legs", wood, legs(0.42, (0.0, 0.42), 0.43, 0.035)),
            Component("seat", wood, box((-0.22, 0.22), (0.0, 0.43), (0.43, 0.455))),
            Component("pad", palette.cushions[1], cushion((-0.19, 0.19), (0.04, 0.41), (0.45, 0.49))),
            Component("back", wood, merge([*posts, *slats])),
        ),
    )


def office_chair(palette: Palette, _: np.random.Generator) -> Piece:
    arms = [placed(box((-0.02, 0.28), (-0.02, 0.02), (0.05, 0.09)), a, (0, 0.3, 0)) for a in np.arange(5) * 0.4 * np.pi]
    wheels = [
        cylinder(0.025, (0.0, 0.05), (0.27 * float(np.cos(a)), 0.3 + 0.27 * float(np.sin(a))), 8)
        for a in np.arange(5) * 0.4 * np.pi
    ]
    back = tilted(cushion((-0.21, 0.21), (-0.035, 0.035), (0.0, 0.55)), 0.12, (0.0, 0.09, 0.52))
    rests = [box((x, x + 0.05), (0.14, 0.42), (0.66, 0.69)) for x in (-0.28, 0.23)]
    posts = [box((x, x + 0.03), (0.25, 0.29), (0.44, 0.66)) for x in (-0.27, 0.24)]
    return Piece(
        "office_chair",
        (
            Component("base", palette.black, merge(arms + wheels)),
            Component("column", palette.metal, cylinder(0.03, (0.07, 0.44), (0.0, 0.3))),
            Component("seat", palette.cushions[2], cushion((-0.24, 0.24), (0.07, 0.54), (0.42, 0.52))),
            Component("back", palette.cushions[2], back),
            Component("arms", palette.black, merge(rests + posts)),
        ),
    )


def _seat(kind: str, width: float, seats: int, palette: Palette, rng: np.random.Generator) -> Piece:
    half, arm, depth = width / 2, 0.16, 0.85
    edges = np.linspace(-half + arm, half - arm, seats + 1)
    spans = list(pairwise(edges.tolist()))
    arms = [cushion((x, x + arm), (0.02, depth), (0.06, 0.62), 0.25) for x in (-half, half - arm)]
    pillows = [
        tilted(cushion((x, x + 0.42), (-0.07, 0.07), (0.0, 0.42), 0.5), 0.35, (0.0, 0.46, 0.45))
        for x in (-half + arm + 0.02, half - arm - 0.44)[:seats]
    ]
    pillow_cloth = palette.cushions[int(rng.integers(2))]
    return Piece(
        kind,
        (
            Component("feet", palette.walnut, legs(width - 0.1, (0.05, depth - 0.05), 0.08)),
            Component("base", palette.sofa, box((-half + 0.04, half - 0.04), (0.02, depth - 0.03), (0.07, 0.3))),
            Component("back", palette.sofa, cushion((-half + 0.03, half - 0.03), (0.0, 0.22), (0.1, 0.84), 0.25)),
            Component("arms", palette.sofa, merge(arms)),
            Component("seats", palette.sofa, merge(cushion(s, (0.2, depth), (0.29, 0.46), 0.25) for s in spans)),
            Component("rests", palette.sofa, merge(cushion(s, (0.18, 0.36), (0.44, 0.82), 0.3) for s in spans)),
            Component("pillows", pillow_cloth, merge(pillows)),
        ),
        front=0.3,
    )


def sofa(palette: Palette, rng: np.random.Generator) -> Piece:
    seats = int(rng.integers(2, 4))
    return _seat("sofa", 0.42 + 0.66 * seats, seats, palette, rng)


def armchair(palette: Palette, rng: np.random.Generator) -> Piece:
    return _seat("armchair", 0.9, 1, palette, rng)


def double_bed(palette: Palette, rng: np.random.Generator) -> Piece:
    return _bed(palette, float(rng.choice([1.4, 1.6])), 2)


def single_bed(palette: Palette, _: np.random.Generator) -> Piece:
    return _bed(palette, 0.9, 1)


def _bed(palette: Palette, width: float, sleepers: int) -> Piece:
    """Its head is against the wall."""
    half, length = width / 2, 2.08
    rails = [box((x, x + 0.04), (0.05, length), (0.14, 0.36)) for x in (-half - 0.04, half)]
    foot = box((-half - 0.04, half + 0.04), (length, length + 0.04), (0.0, 0.46))
    head = [box((-half - 0.04, half + 0.04), (0.0, 0.05), (0.0, 0.75)), box((-half, half), (0.0, 0.06), (0.75, 1.02))]
    heads = (np.arange(sleepers) + 0.5) * width / sleepers - half
    pillows = [cushion((x - 0.33, x + 0.33), (0.08, 0.5), (0.48, 0.64), 0.5) for x in heads]
    folded = cushion((-half - 0.01, half + 0.01), (0.55, 0.85), (0.5, 0.585), 0.3)
    blanket = cushion((-half - 0.035, half + 0.035), (0.7, length + 0.0), (0.3, 0.57), 0.2)
    return Piece(
        "bed",
        (
            Component("frame", palette.walnut, merge([*rails, foot, legs(width, (0.1, length), 0.2)])),
            Component("headboard", palette.walnut, merge(head)),
            Component("mattress", palette.linen, cushion((-half, half), (0.06, length - 0.01), (0.2, 0.52), 0.2)),
            Component("pillows", palette.linen, merge(pillows)),
            Component("blanket", palette.blanket, blanket),
            Component("sheet", palette.linen, folded),
        ),
        front=0.3,
    )


def ottoman(palette: Palette, _: np.random.Generator) -> Piece:
    """A round upholstered stool."""
    body = lathe([(0.0, 0.08), (0.23, 0.08), (0.24, 0.36), (0.21, 0.4), (0.0, 0.42)], (0.0, 0.25, 0.0))
    return Piece(
        "ottoman",
        (
            Component("feet", palette.oak, legs(0.3, (0.1, 0.4), 0.08)),
            Component("body", palette.cushions[1], body),
            Component("cover", palette.cushions[0], cushion((-0.2, 0.2), (0.05, 0.45), (0.4, 0.47), 0.6)),
        ),
        tops=(Top((-0.1, 0.1), (0.15, 0.35), 0.47),),
    )
