"""What lies and stands on desks, each centred on its origin."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.prints import NOTES
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
    sheet,
    tilted,
)


def monitor(palette: Palette, _: np.random.Generator) -> Piece:
    return Piece(
        "monitor",
        (
            Component("foot", palette.black, box((-0.12, 0.12), (-0.09, 0.09), (0.0, 0.012))),
            Component("neck", palette.black, box((-0.025, 0.025), (-0.05, -0.02), (0.012, 0.3))),
            Component("case", palette.black, box((-0.28, 0.28), (-0.02, 0.015), (0.14, 0.5))),
            Component("screen", palette.screen, picture(0.53, (0.155, 0.485), 0.017), glow=True),
        ),
    )


def keyboard(palette: Palette, _: np.random.Generator) -> Piece:
    rows = [box((-0.2, 0.2), (y, y + 0.014), (0.012, 0.018)) for y in (-0.05, -0.03, -0.01, 0.01, 0.03)]
    mouse = cushion((0.27, 0.33), (-0.05, 0.05), (0.0, 0.035), 0.6)
    return Piece(
        "keyboard",
        (
            Component("body", palette.black, box((-0.22, 0.22), (-0.065, 0.06), (0.0, 0.012))),
            Component("keys", palette.white, merge(rows)),
            Component("mouse", palette.black, mouse),
        ),
    )


def papers(palette: Palette, rng: np.random.Generator) -> Piece:
    """Some sheets of print, fanned out."""
    sheets = []
    for i in range(int(rng.integers(2, 5))):
        cell = (1, int(rng.integers(NOTES[1])))
        v, u = 1.0 - (cell[0] + 1) / NOTES[0], cell[1] / NOTES[1]
        paper = sheet((-0.105, 0.105), (-0.148, 0.148), 0.001 + 0.0015 * i)
        shown = Mesh(paper.vertices, paper.faces, (u, v) + paper.uv / (NOTES[1], NOTES[0]))
        sheets.append(placed(shown, float(rng.normal(0.0, 0.25)), (*rng.uniform(-0.04, 0.04, 2), 0.0)))
    return Piece("papers", (Component("cover", palette.notes, merge(sheets)),))


def pen_cup(palette: Palette, rng: np.random.Generator) -> Piece:
    pens = [
        tilted(cylinder(0.004, (0.02, 0.16), sides=6), float(rng.normal(0.0, 0.1)), (x, 0.0, 0.0))
        for x in np.linspace(-0.02, 0.02, 5)
    ]
    return Piece(
        "pen_cup",
        (
            Component(
                "cup", palette.metal, lathe([(0, 0), (0.04, 0), (0.04, 0.1), (0.036, 0.1), (0.036, 0.006), (0, 0.006)])
            ),
            Component("pens", palette.plastics[int(rng.integers(4))], merge(pens[:3])),
            Component("pencils", palette.oak, merge(pens[3:])),
        ),
    )


def laptop(palette: Palette, _: np.random.Generator) -> Piece:
    lid = tilted(box((-0.16, 0.16), (-0.006, 0.0), (0.0, 0.22)), 0.3, (0.0, -0.11, 0.016))
    screen = tilted(picture(0.3, (0.012, 0.208), 0.0008), 0.3, (0.0, -0.11, 0.016))
    keys = [box((-0.14, 0.14), (y, y + 0.015), (0.016, 0.018)) for y in (-0.08, -0.06, -0.04, -0.02)]
    return Piece(
        "laptop",
        (
            Component("body", palette.metal, bevelled((-0.16, 0.16), (-0.11, 0.11), (0.0, 0.016), 0.004)),
            Component("lid", palette.metal, lid),
            Component("keys", palette.black, merge(keys)),
            Component("screen", palette.screen, screen, glow=True),
        ),
    )
