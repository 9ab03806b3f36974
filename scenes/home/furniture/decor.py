"""What makes a home: pictures, rugs, plants, a television."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import (
    Mesh,
    border,
    box,
    cylinder,
    lathe,
    merge,
    picture,
    placed,
    sheet,
    stretched,
    tilted,
)
from slamgym.types import FloatArray


def framed(kind: str, finish: Finish, frame: Finish, width: float, height: float, bar: float = 0.025) -> Piece:
    """A picture with a frame, hung by its middle."""
    half, z = width / 2, (-height / 2, height / 2)
    return Piece(
        kind,
        (
            Component("frame", frame, border((-half, half), (0.0, 0.025), z, bar)),
            Component("back", frame, box((-half + bar, half - bar), (0.0, 0.008), (z[0] + bar, z[1] - bar))),
            Component("picture", finish, picture(width - 2 * bar, (z[0] + bar, z[1] - bar), 0.012)),
        ),
    )


def wall_picture(palette: Palette, rng: np.random.Generator, finish: Finish, small: bool = False) -> Piece:
    """A framed picture in its own proportions; small: beside a larger one."""
    texture = finish.material.texture
    aspect = 1.0 if texture is None else texture.shape[1] / texture.shape[0]
    side = float(rng.uniform(0.28, 0.42) if small else rng.uniform(0.5, 0.85))
    frame = (palette.black, palette.oak, palette.white)[int(rng.integers(3))]
    return framed("picture", finish, frame, side * aspect**0.5, side / aspect**0.5)


def clock(palette: Palette, _: np.random.Generator) -> Piece:
    return framed("clock", palette.clock, palette.walnut, 0.32, 0.32)


def rug(palette: Palette, rng: np.random.Generator, width: float, depth: float) -> Piece:
    """8 mm thick, centred; a robot drives over it."""
    half, y = width / 2, (-depth / 2, depth / 2)
    finish = palette.rugs[int(rng.integers(len(palette.rugs)))]
    return Piece(
        "rug",
        (
            Component("pile", finish, sheet((-half, half), y, 0.008), solid=False),
            Component("edge", palette.linen, box((-half, half), y, (0.001, 0.0075)), solid=False),
        ),
    )


def plant(palette: Palette, rng: np.random.Generator) -> Piece:
    """A pot with stems and broad leaves, 0.7 to 1.4 m high."""
    radius, y = float(rng.uniform(0.13, 0.18)), 0.3
    pot = [(0.0, 0.0), (0.75 * radius, 0.0), (radius, 0.3), (0.9 * radius, 0.3), (0.85 * radius, 0.26), (0.0, 0.26)]
    height = float(rng.uniform(0.5, 1.0))
    stems, foliage = [], []
    for angle in rng.uniform(0.0, 2.0 * np.pi, int(rng.integers(4, 8))):
        lean, top = float(rng.uniform(0.02, 0.09)), 0.26 + height * float(rng.uniform(0.5, 1.0))
        base = np.array([lean * np.cos(angle), y + lean * np.sin(angle)])
        stems.append(cylinder(0.008, (0.26, top), (float(base[0]), float(base[1])), 6))
        foliage += [_leaf(rng, base, float(h)) for h in np.linspace(0.45, top, 5)]
    return Piece(
        "plant",
        (
            Component("pot", palette.clay, lathe(pot, (0.0, y, 0.0))),
            Component("soil", palette.soil, cylinder(0.86 * radius, (0.25, 0.265), (0.0, y))),
            Component("stems", palette.leaves, merge(stems)),
            Component("leaves", palette.leaves, merge(foliage)),
        ),
    )


def _leaf(rng: np.random.Generator, base: FloatArray, z: float) -> Mesh:
    """A flat pointed leaf that starts at (base, z)."""
    length, half, turn = float(rng.uniform(0.14, 0.24)), float(rng.uniform(0.03, 0.05)), float(rng.uniform(0.0, 6.28))
    outline = [(0.0, 0.0), (half, 0.4 * length), (0.7 * half, 0.75 * length), (0.0, length)]
    blade = stretched(lathe(outline, sides=4), y=0.08)
    return placed(tilted(blade, -float(rng.uniform(0.3, 1.4))), turn, (base[0], base[1], z))


def television(palette: Palette, _: np.random.Generator) -> Piece:
    """Centred on its foot; stands on a bench."""
    return Piece(
        "television",
        (
            Component("foot", palette.black, box((-0.25, 0.25), (-0.1, 0.1), (0.0, 0.015))),
            Component("neck", palette.black, box((-0.05, 0.05), (-0.03, 0.0), (0.015, 0.1))),
            Component("case", palette.black, box((-0.56, 0.56), (-0.04, 0.0), (0.08, 0.72))),
            Component("screen", palette.glass, box((-0.545, 0.545), (0.0, 0.003), (0.1, 0.705))),
        ),
    )
