"""Beds; their heads are against the wall."""

from itertools import pairwise

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.furniture.seating import legs
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh, bevelled, box, cushion, merge, placed

_LENGTH = 2.08


def double_bed(palette: Palette, rng: np.random.Generator) -> Piece:
    return _bed(palette, rng, float(rng.choice([1.4, 1.6])), 2)


def single_bed(palette: Palette, rng: np.random.Generator) -> Piece:
    return _bed(palette, rng, 0.9, 1)


def _bed(palette: Palette, rng: np.random.Generator, width: float, sleepers: int) -> Piece:
    half, wood = width / 2, (palette.walnut, palette.oak, palette.white)[int(rng.integers(3))]
    rails = [bevelled((x, x + 0.04), (0.05, _LENGTH), (0.14, 0.36)) for x in (-half - 0.04, half)]
    foot_top = float(rng.choice([0.36, 0.46, 0.62]))
    foot = bevelled((-half - 0.04, half + 0.04), (_LENGTH, _LENGTH + 0.04), (0.0, foot_top))
    heads = (np.arange(sleepers) + 0.5) * width / sleepers - half
    pillows = [
        placed(cushion((-0.33, 0.33), (-0.2, 0.2), (0.48, 0.63), 0.5), float(rng.normal(0.0, 0.08)), (x, 0.31, 0.0))
        for x in heads.tolist()
    ]
    return Piece(
        "bed",
        (
            Component("frame", wood, merge([*rails, foot, legs(width, (0.1, _LENGTH), 0.2)])),
            _headboard(palette, rng, half),
            Component("mattress", palette.linen, cushion((-half, half), (0.06, _LENGTH - 0.01), (0.2, 0.52), 0.2)),
            Component("pillows", palette.linen, merge(pillows)),
            *_covers(palette, rng, half),
        ),
        front=0.3,
    )


def _headboard(palette: Palette, rng: np.random.Generator, half: float) -> Component:
    """Panelled, upholstered, or of upright bars."""
    design, x = int(rng.integers(3)), (-half - 0.04, half + 0.04)
    if design == 0:
        panels = [bevelled(x, (0.0, 0.05), (0.0, 0.75)), bevelled((-half, half), (0.0, 0.06), (0.75, 1.02), 0.02)]
        return Component("headboard", palette.walnut, merge(panels))
    if design == 1:
        edges = np.linspace(*x, max(3, round(4 * half)) + 1)
        pads = [cushion((a, b), (0.0, 0.09), (0.1, 1.08), 0.2) for a, b in pairwise(edges.tolist())]
        return Component("headboard", palette.sofa, merge(pads))
    bars: list[Mesh] = [
        box((at, at + 0.02), (0.015, 0.035), (0.3, 0.96)) for at in np.arange(x[0] + 0.1, x[1] - 0.1, 0.11)
    ]
    rails = [bevelled(x, (0.0, 0.05), (0.96, 1.02)), box(x, (0.01, 0.04), (0.25, 0.3))]
    posts = [box((at, at + 0.05), (0.0, 0.05), (0.0, 0.96)) for at in (x[0], x[1] - 0.05)]
    return Component("headboard", palette.oak, merge([*bars, *rails, *posts]))


def _covers(palette: Palette, rng: np.random.Generator, half: float) -> tuple[Component, ...]:
    """A blanket with its upper end turned over; sometimes a thick duvet and a throw across the foot."""
    thick = float(rng.uniform(0.0, 0.06))
    side = half + 0.035
    blanket = cushion((-side, side), (0.7, _LENGTH - 0.005), (0.3, 0.57 + thick), 0.2 + 2.0 * thick)
    folded = cushion((-half - 0.01, half + 0.01), (0.55, 0.88), (0.5, 0.585 + thick), 0.3)
    covers = [Component("blanket", palette.blanket, blanket), Component("sheet", palette.linen, folded)]
    if rng.random() < 0.4:
        throw = cushion((-side - 0.005, side + 0.005), (1.45, 1.85), (0.34, 0.578 + thick), 0.2)
        covers.append(Component("throw", palette.cushions[int(rng.integers(3))], throw))
    return tuple(covers)
