"""Sofas and armchairs: one construction in many proportions."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.furniture.seating import legs
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import cushion, merge, tilted


@dataclass(frozen=True, slots=True)
class _Cut:
    """Proportions, metres: of the arms, the back and the legs; softness of the cushions as in `solids.cushion`."""

    arm: float
    arm_top: float
    back_top: float
    leg: float
    softness: float
    depth: float


_CUTS = (
    _Cut(0.16, 0.62, 0.84, 0.08, 0.25, 0.85),  # round and deep
    _Cut(0.22, 0.56, 0.72, 0.05, 0.12, 0.92),  # a low block
    _Cut(0.09, 0.6, 0.82, 0.16, 0.2, 0.8),  # on high legs, thin arms
    _Cut(0.18, 0.68, 0.98, 0.1, 0.4, 0.86),  # puffy, with a high back
)


def sofa(palette: Palette, rng: np.random.Generator) -> Piece:
    seats = int(rng.integers(2, 4))
    cut = _CUTS[int(rng.integers(len(_CUTS)))]
    return _seat("sofa", 2 * cut.arm + 0.66 * seats, seats, cut, palette, rng)


def armchair(palette: Palette, rng: np.random.Generator) -> Piece:
    cut = _CUTS[int(rng.integers(len(_CUTS)))]
    return _seat("armchair", 2 * cut.arm + 0.58, 1, cut, palette, rng)


def _seat(kind: str, width: float, seats: int, cut: _Cut, palette: Palette, rng: np.random.Generator) -> Piece:
    half, arm, depth, soft = width / 2, cut.arm, cut.depth, cut.softness
    edges = np.linspace(-half + arm, half - arm, seats + 1)
    spans = list(pairwise(edges.tolist()))
    arms = [cushion((x, x + arm), (0.02, depth), (cut.leg - 0.01, cut.arm_top), soft) for x in (-half, half - arm)]
    size = float(rng.uniform(0.38, 0.46))
    spots = [-half + arm + size / 2 + 0.02, half - arm - size / 2 - 0.02][: max(1, int(rng.integers(1, seats + 1)))]
    pillows = [
        tilted(cushion((x - size / 2, x + size / 2), (-0.07, 0.07), (0.0, size), 0.5), 0.35, (0.0, 0.46, 0.45))
        for x in spots
    ]
    cloth = palette.cushions[2] if kind == "armchair" and rng.random() < 0.5 else palette.sofa
    base = cushion((-half + 0.04, half - 0.04), (0.02, depth - 0.03), (cut.leg - 0.01, 0.3), 0.1)
    return Piece(
        kind,
        (
            Component("feet", palette.walnut, legs(width - 0.1, (0.05, depth - 0.05), cut.leg)),
            Component("base", cloth, base),
            Component("back", cloth, cushion((-half + 0.03, half - 0.03), (0.0, 0.22), (cut.leg, cut.back_top), soft)),
            Component("arms", cloth, merge(arms)),
            Component("seats", cloth, merge(cushion(s, (0.2, depth), (0.29, 0.46), soft) for s in spans)),
            Component(
                "rests", cloth, merge(cushion(s, (0.18, 0.36), (0.44, cut.back_top - 0.02), soft + 0.05) for s in spans)
            ),
            Component("pillows", palette.cushions[int(rng.integers(2))], merge(pillows)),
        ),
        front=0.3,
    )
