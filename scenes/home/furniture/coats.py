"""A rack with coats."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh, box, lathe, merge, placed, stretched, tilted

_BODY = (
    (0.0, -1.0),
    (0.12, -1.0),
    (0.15, -0.97),
    (0.14, -0.7),
    (0.11, -0.45),
    (0.12, -0.3),
    (0.09, -0.15),
    (0.045, -0.05),
    (0.048, 0.01),
    (0.036, 0.01),
    (0.0, -0.02),
)
_SLEEVE = ((0.0, -0.6), (0.036, -0.6), (0.04, -0.58), (0.047, -0.3), (0.055, -0.08), (0.03, 0.0), (0.0, 0.01))
_SHOULDER = (0.085, -0.16)  # x, z
_HOOKS = np.linspace(-0.4, 0.4, 5)


def coat(rng: np.random.Generator, length: float) -> Mesh:
    """A coat that hangs from its collar at the origin, `length` metres long: sleeves, folds, an uneven hem."""
    turn = float(rng.uniform(0.0, 2.0 * np.pi))
    body = stretched(_in_folds(lathe(_BODY, sides=20), turn), y=0.55, z=length)
    x, z = _SHOULDER
    sleeves = [
        placed(tilted(lathe(_SLEEVE, sides=8), float(rng.uniform(0.04, 0.13))), -side * np.pi / 2, (side * x, 0.0, z))
        for side in (-1, 1)
    ]
    return merge([body, *sleeves])


def _in_folds(mesh: Mesh, turn: float) -> Mesh:
    """Cloth hung by its middle: folds that deepen downwards, a hem higher here and lower there. turn: radians."""
    x, y, z = mesh.vertices.T
    angle, depth = np.arctan2(y, x), np.clip(-z - 0.1, 0.0, 1.0)
    wide = 1.0 + depth * (0.13 * np.sin(5.0 * angle + turn) + 0.06 * np.sin(3.0 * angle - turn))
    fall = 0.3 * np.hypot(x, y) * depth * np.sin(2.0 * angle + turn)
    return Mesh(np.column_stack([wide * x, wide * y, z + fall]), mesh.faces, mesh.uv)


def coat_rack(palette: Palette, rng: np.random.Generator) -> Piece:
    """Hooks with coats; its origin is on the floor."""
    hooks = [box((x - 0.01, x + 0.01), (0.02, 0.09), (1.66, 1.69)) for x in _HOOKS]
    spots = rng.permutation(_HOOKS)[:3].tolist()
    coats = [placed(coat(rng, float(rng.uniform(0.65, 1.05))), 0.0, (x, 0.11, 1.64)) for x in spots]
    cloths = [palette.cushions[1], palette.cushions[2], palette.sofa]
    return Piece(
        "coat_rack",
        (
            Component("board", palette.oak, box((-0.48, 0.48), (0.0, 0.02), (1.6, 1.74))),
            Component("hooks", palette.metal, merge(hooks)),
            *(Component(f"coat_{i}", c, m) for i, (c, m) in enumerate(zip(cloths, coats, strict=True))),
        ),
    )
