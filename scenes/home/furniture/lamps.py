"""Lamps that stand, and lamps that hang from the ceiling; several designs of each."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import Mesh, bevelled, box, cylinder, lathe, merge, placed, tilted

Profile = list[tuple[float, float]]


def _shade(rng: np.random.Generator, radius: float, bottom: float, height: float) -> Mesh:
    """A cone, a drum or a dome, open above and below."""
    taper = (0.65, 1.0, 0.45)[int(rng.integers(3))]
    top, thin = bottom + height, radius - 0.005
    outside: Profile = [(radius, bottom), (taper * radius, top)]
    if taper < 0.5:
        outside = [(radius, bottom), (0.9 * radius, bottom + 0.45 * height), (taper * radius, top)]
    inside = [(r * thin / radius, z) for r, z in outside[::-1]]
    return lathe([*outside, *inside, outside[0]], sides=20)


def _bulb(bottom: float, radius: float = 0.032) -> Mesh:
    return lathe([(0.0, bottom), (radius, bottom + 0.04), (0.0, bottom + 0.1)], sides=10)


def _cloth(palette: Palette, rng: np.random.Generator) -> Finish:
    return (palette.linen, palette.white, palette.cushions[1])[int(rng.integers(3))]


def floor_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """On a disc, or on three slanting legs."""
    at, height = (0.0, 0.24, 0.0), float(rng.uniform(1.15, 1.4))
    if rng.random() < 0.5:
        foot = [lathe([(0, 0), (0.15, 0), (0.15, 0.02), (0, 0.035)], sides=20)]
        foot += [cylinder(0.012, (0.03, height + 0.1), sides=8)]
    else:
        leg = placed(tilted(box((-0.012, 0.012), (-0.012, 0.012), (0.0, height)), 0.16), at=(0.0, 0.195, 0.004))
        foot = [placed(leg, yaw) for yaw in (0.0, 2.0 * np.pi / 3.0, 4.0 * np.pi / 3.0)]
        foot += [cylinder(0.03, (height - 0.03, height + 0.1), sides=10)]
    return Piece(
        "floor_lamp",
        (
            Component("stand", palette.metal, merge(foot)),
            Component("shade", _cloth(palette, rng), _shade(rng, 0.21, height, 0.3)),
            Component("bulb", palette.glow, _bulb(height + 0.08), glow=True),
        ),
    ).placed(0.0, at)


def table_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """Centred; stands on a table."""
    feet: tuple[Profile, ...] = (
        [(0.0, 0.0), (0.07, 0.0), (0.085, 0.08), (0.02, 0.2), (0.012, 0.3), (0.0, 0.3)],
        [(0.0, 0.0), (0.08, 0.0), (0.08, 0.015), (0.01, 0.02), (0.01, 0.3), (0.0, 0.3)],
        [(0.0, 0.0), (0.05, 0.0), (0.09, 0.07), (0.05, 0.14), (0.012, 0.17), (0.012, 0.3), (0.0, 0.3)],
    )
    return Piece(
        "table_lamp",
        (
            Component(
                "foot",
                (palette.clay, palette.metal, palette.porcelain)[int(rng.integers(3))],
                lathe(feet[int(rng.integers(3))]),
            ),
            Component("shade", _cloth(palette, rng), _shade(rng, 0.13, 0.24, 0.18)),
            Component("bulb", palette.glow, _bulb(0.29, 0.028), glow=True),
        ),
    )


def desk_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """Two arms and a tilted cone; centred on its foot."""
    colour = (palette.black, palette.metal, *palette.plastics[:2])[int(rng.integers(4))]
    lower = tilted(box((-0.008, 0.008), (-0.008, 0.008), (0.0, 0.3)), 0.4, (0.0, 0.0, 0.015))
    joint = np.array([0.0, -0.3 * np.sin(0.4), 0.015 + 0.3 * np.cos(0.4)])
    upper = tilted(box((-0.008, 0.008), (-0.008, 0.008), (0.0, 0.28)), -0.9, joint)
    tip = joint + np.array([0.0, 0.28 * np.sin(0.9), 0.28 * np.cos(0.9)])
    cone = [(0.0, 0.01), (0.025, -0.005), (0.065, -0.1), (0.07, -0.1), (0.03, 0.0), (0.0, 0.02)]
    return Piece(
        "desk_lamp",
        (
            Component("foot", colour, cylinder(0.08, (0.0, 0.018), sides=16)),
            Component("arms", palette.metal, merge([lower, upper])),
            Component("cone", colour, placed(lathe(cone, sides=14), at=tip)),
        ),
    )


CEILING_LAMP_DROP = 0.42
"""The light hangs this far below the ceiling, just under the shade."""


def ceiling_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """Hangs from the origin downwards; open below, so that the light under it shines everywhere."""
    design = int(rng.integers(3))
    if design == 2:
        return _spots(palette)
    finish = (palette.white, palette.linen, palette.metal)[int(rng.integers(3))]
    width = (0.2, 0.26)[design]
    return Piece(
        "ceiling_lamp",
        (
            Component("rose", palette.white, cylinder(0.05, (-0.03, 0.0))),
            Component("cord", palette.black, cylinder(0.004, (-0.27, -0.03), sides=6)),
            Component("shade", finish, _shade(rng, width, -0.37, 0.15)),
            Component(
                "bulb", palette.glow, lathe([(0, -0.36), (0.04, -0.33), (0.03, -0.28), (0, -0.26)], sides=12), glow=True
            ),
        ),
    )


def _spots(palette: Palette) -> Piece:
    """Three spots on a bar."""
    spots = (-0.3, 0.0, 0.3)
    drops = [box((x - 0.006, x + 0.006), (-0.006, 0.006), (-0.16, -0.04)) for x in spots]
    can = [(0.0, -0.165), (0.036, -0.165), (0.036, -0.27), (0.04, -0.27), (0.04, -0.16), (0.0, -0.16)]
    cans = [lathe(can, (x, 0.0, 0.0), 12) for x in spots]
    bulbs = [placed(cylinder(0.034, (-0.255, -0.25), sides=10), at=(x, 0.0, 0.0)) for x in spots]
    return Piece(
        "ceiling_lamp",
        (
            Component("bar", palette.metal, bevelled((-0.4, 0.4), (-0.03, 0.03), (-0.04, 0.0))),
            Component("drops", palette.metal, merge(drops)),
            Component("cans", palette.metal, merge(cans)),
            Component("bulbs", palette.glow, merge(bulbs), glow=True),
        ),
    )
