"""Chairs and stools."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh, bevelled, box, cushion, cylinder, lathe, merge, placed, tilted


def legs(width: float, y: tuple[float, float], height: float, thickness: float = 0.045) -> Mesh:
    """Four square legs at the corners of a rectangle centred on x = 0."""
    half = width / 2
    xs = ((-half, -half + thickness), (half - thickness, half))
    ys = ((y[0], y[0] + thickness), (y[1] - thickness, y[1]))
    return merge(box(leg_x, leg_y, (0.0, height)) for leg_x in xs for leg_y in ys)


def chair(palette: Palette, rng: np.random.Generator) -> Piece:
    """Its back is at y = 0, one sits facing +y; slats, upholstered, or a shell on rods."""
    return (_slatted_chair, _upholstered_chair, _shell_chair)[int(rng.integers(3))](palette, rng)


def _slatted_chair(palette: Palette, rng: np.random.Generator) -> Piece:
    wood = palette.oak if rng.random() < 0.5 else palette.walnut
    posts = [box((x, x + 0.035), (0.0, 0.035), (0.44, 0.9)) for x in (-0.21, 0.175)]
    slats = [bevelled((-0.175, 0.175), (0.008, 0.026), (z, z + 0.07)) for z in (0.56, 0.68, 0.8)]
    if rng.random() < 0.4:
        slats = [box((x, x + 0.025), (0.01, 0.025), (0.455, 0.82)) for x in np.linspace(-0.15, 0.125, 5)]
        slats.append(bevelled((-0.175, 0.175), (0.005, 0.03), (0.82, 0.9)))
    return Piece(
        "chair",
        (
            Component("legs", wood, legs(0.42, (0.0, 0.42), 0.43, 0.035)),
            Component("seat", wood, bevelled((-0.22, 0.22), (0.0, 0.43), (0.43, 0.455))),
            Component("pad", palette.cushions[1], cushion((-0.19, 0.19), (0.04, 0.41), (0.45, 0.49))),
            Component("back", wood, merge([*posts, *slats])),
        ),
    )


def _upholstered_chair(palette: Palette, rng: np.random.Generator) -> Piece:
    cloth = (palette.cushions[2], palette.linen, palette.sofa)[int(rng.integers(3))]
    back = tilted(cushion((-0.22, 0.22), (-0.035, 0.035), (0.0, 0.5), 0.25), 0.1, (0.0, 0.09, 0.46))
    return Piece(
        "chair",
        (
            Component("legs", palette.walnut, legs(0.42, (0.03, 0.45), 0.4, 0.035)),
            Component("seat", cloth, cushion((-0.235, 0.235), (0.02, 0.47), (0.37, 0.49), 0.22)),
            Component("back", cloth, back),
        ),
    )


def _shell_chair(palette: Palette, rng: np.random.Generator) -> Piece:
    shell = (palette.porcelain, palette.black, *palette.plastics)[int(rng.integers(7))]
    rods = [
        placed(tilted(cylinder(0.011, (0.003, 0.44), sides=8), -0.16), yaw, (x, y, 0.0))
        for x, y, yaw in ((-0.2, 0.06, -0.78), (0.2, 0.06, 0.78), (-0.2, 0.44, -2.36), (0.2, 0.44, 2.36))
    ]
    back = tilted(cushion((-0.22, 0.22), (-0.018, 0.018), (0.0, 0.42), 0.35), 0.2, (0.0, 0.1, 0.44))
    return Piece(
        "chair",
        (
            Component("legs", palette.oak, merge(rods)),
            Component("seat", shell, cushion((-0.23, 0.23), (0.05, 0.48), (0.425, 0.47), 0.35)),
            Component("back", shell, back),
        ),
    )


def office_chair(palette: Palette, rng: np.random.Generator) -> Piece:
    arms = [placed(box((-0.02, 0.28), (-0.02, 0.02), (0.05, 0.09)), a, (0, 0.3, 0)) for a in np.arange(5) * 0.4 * np.pi]
    wheels = [
        cylinder(0.025, (0.0, 0.05), (0.27 * float(np.cos(a)), 0.3 + 0.27 * float(np.sin(a))), 8)
        for a in np.arange(5) * 0.4 * np.pi
    ]
    cloth = (palette.cushions[2], palette.black, palette.sofa)[int(rng.integers(3))]
    back = tilted(
        cushion((-0.21, 0.21), (-0.035, 0.035), (0.0, float(rng.uniform(0.5, 0.65)))), 0.12, (0.0, 0.09, 0.52)
    )
    rests = [bevelled((x, x + 0.05), (0.14, 0.42), (0.66, 0.69)) for x in (-0.28, 0.23)]
    posts = [box((x, x + 0.03), (0.25, 0.29), (0.44, 0.66)) for x in (-0.27, 0.24)]
    return Piece(
        "office_chair",
        (
            Component("base", palette.black, merge(arms + wheels)),
            Component("column", palette.metal, cylinder(0.03, (0.07, 0.44), (0.0, 0.3))),
            Component("seat", cloth, cushion((-0.24, 0.24), (0.07, 0.54), (0.42, 0.52))),
            Component("back", cloth, back),
            Component("arms", palette.black, merge(rests + posts)),
        ),
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
