"""What hangs on walls and ceilings or lies on the floor: pictures, curtains, lamps, rugs, plants, radiators, doors."""

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
    ribbon,
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


def wall_picture(palette: Palette, rng: np.random.Generator, finish: Finish) -> Piece:
    """A framed picture in its own proportions."""
    texture = finish.material.texture
    aspect = 1.0 if texture is None else texture.shape[1] / texture.shape[0]
    side = float(rng.uniform(0.5, 0.85))
    frame = (palette.black, palette.oak, palette.white)[int(rng.integers(3))]
    return framed("picture", finish, frame, side * aspect**0.5, side / aspect**0.5)


def clock(palette: Palette, _: np.random.Generator) -> Piece:
    return framed("clock", palette.clock, palette.walnut, 0.32, 0.32)


def curtain(palette: Palette, width: float, top: float, bottom: float) -> Piece:
    """A pair of curtains for a window `width` wide, drawn aside, on a rod."""
    reach = width / 2 + 0.22
    folds = np.linspace(0.0, 1.0, 19)
    wave = np.column_stack([0.26 * folds, 0.07 + 0.025 * np.sin(folds * 6.0 * np.pi)])
    cloths = [ribbon(wave + np.array([x, 0.0]), 0.012, (bottom, top - 0.02)) for x in (-reach, reach - 0.26)]
    brackets = [box((x - 0.01, x + 0.01), (0.0, 0.08), (top - 0.01, top + 0.02)) for x in (-reach + 0.1, reach - 0.1)]
    return Piece(
        "curtain",
        (
            Component("cloths", palette.curtain, merge(cloths)),
            Component("rod", palette.metal, box((-reach - 0.05, reach + 0.05), (0.06, 0.08), (top - 0.01, top + 0.01))),
            Component("brackets", palette.metal, merge(brackets)),
        ),
    )


def radiator(palette: Palette, width: float) -> Piece:
    """A flat panel with a grille on top, hung under a window."""
    x = (-width / 2, width / 2)
    panel = [box(x, (0.04, 0.13), (0.14, 0.70)), box((x[0] + 0.02, x[1] - 0.02), (0.13, 0.134), (0.17, 0.67))]
    valve = [
        cylinder(0.02, (0.1, 0.17), (width / 2 - 0.02, 0.085)),
        cylinder(0.012, (0.0, 0.1), (width / 2 - 0.02, 0.085)),
    ]
    return Piece(
        "radiator",
        (
            Component("panel", palette.white, merge(panel)),
            Component("grille", palette.metal, box(x, (0.045, 0.125), (0.70, 0.715))),
            Component("valve", palette.metal, merge(valve)),
            Component("hooks", palette.metal, merge(box((x, x + 0.02), (0.0, 0.05), (0.6, 0.63)) for x in (-0.2, 0.2))),
        ),
    )


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


def floor_lamp(palette: Palette, _: np.random.Generator) -> Piece:
    y = 0.22
    shade = [(0.2, 1.3), (0.14, 1.6), (0.135, 1.6), (0.195, 1.3), (0.2, 1.3)]
    return Piece(
        "floor_lamp",
        (
            Component("foot", palette.metal, lathe([(0, 0), (0.15, 0), (0.15, 0.02), (0, 0.035)], (0, y, 0), 20)),
            Component("pole", palette.metal, cylinder(0.012, (0.03, 1.45), (0.0, y), 8)),
            Component("shade", palette.linen, lathe(shade, (0.0, y, 0.0), 20)),
            Component("bulb", palette.glow, lathe([(0, 1.38), (0.035, 1.42), (0, 1.48)], (0, y, 0), 10), glow=True),
        ),
    )


def table_lamp(palette: Palette, _: np.random.Generator) -> Piece:
    """Centred; stands on a table."""
    foot = [(0.0, 0.0), (0.07, 0.0), (0.085, 0.08), (0.02, 0.2), (0.012, 0.3), (0.0, 0.3)]
    shade = [(0.13, 0.24), (0.09, 0.42), (0.087, 0.42), (0.127, 0.24), (0.13, 0.24)]
    return Piece(
        "table_lamp",
        (
            Component("foot", palette.clay, lathe(foot)),
            Component("shade", palette.linen, lathe(shade, sides=20)),
            Component("bulb", palette.glow, lathe([(0, 0.3), (0.03, 0.33), (0, 0.37)], sides=10), glow=True),
        ),
    )


CEILING_LAMP_DROP = 0.42
"""The light hangs this far below the ceiling, just under the shade."""


def ceiling_lamp(palette: Palette, _: np.random.Generator) -> Piece:
    """Hangs from the origin downwards; the shade is open below, so that the light under it shines everywhere."""
    shade = [(0.2, -0.36), (0.07, -0.24), (0.065, -0.24), (0.19, -0.36), (0.2, -0.36)]
    bulb = [(0.0, -0.36), (0.04, -0.33), (0.03, -0.28), (0.0, -0.26)]
    return Piece(
        "ceiling_lamp",
        (
            Component("rose", palette.white, cylinder(0.05, (-0.03, 0.0))),
            Component("cord", palette.black, cylinder(0.004, (-0.25, -0.03), sides=6)),
            Component("shade", palette.white, lathe(shade, sides=18)),
            Component("bulb", palette.glow, lathe(bulb, sides=12), glow=True),
        ),
    )


def door_leaf(palette: Palette, width: float, height: float) -> Piece:
    """A panelled door with a handle, flat against the wall behind it; also the closed front door."""
    half = width / 2
    rows = ((0.12, 0.9), (1.02, height - 0.12))
    columns = ((-half + 0.1, -0.06), (0.06, half - 0.14))
    panels = [border(x, (0.055, 0.067), z, 0.025) for x in columns for z in rows]
    handle = [
        box((half - 0.1, half - 0.06), (0.055, 0.065), (0.95, 1.15)),
        box((half - 0.09, half - 0.07), (0.065, 0.085), (1.04, 1.06)),
        box((half - 0.19, half - 0.07), (0.085, 0.105), (1.04, 1.06)),
    ]
    return Piece(
        "door",
        (
            Component("leaf", palette.lacquer, box((-half, half), (0.02, 0.055), (0.006, height))),
            Component("panels", palette.lacquer, merge(panels)),
            Component("handle", palette.metal, merge(handle)),
        ),
    )


_COAT = ((0.0, -1.0), (0.15, -1.0), (0.16, -0.6), (0.14, -0.15), (0.05, -0.04), (0.04, 0.0), (0.0, 0.0))


def coat_rack(palette: Palette, rng: np.random.Generator) -> Piece:
    """Hooks with coats; its origin is on the floor."""
    hooks = [box((x - 0.01, x + 0.01), (0.02, 0.09), (1.66, 1.69)) for x in np.linspace(-0.4, 0.4, 5)]
    coats = [
        placed(stretched(lathe(_COAT, sides=12), y=0.5, z=float(rng.uniform(0.6, 0.85))), 0.0, (float(x), 0.1, 1.65))
        for x in rng.permutation(np.linspace(-0.4, 0.4, 5))[:3]
    ]
    cloths = [palette.cushions[1], palette.cushions[2], palette.sofa]
    return Piece(
        "coat_rack",
        (
            Component("board", palette.oak, box((-0.48, 0.48), (0.0, 0.02), (1.6, 1.74))),
            Component("hooks", palette.metal, merge(hooks)),
            *(Component(f"coat_{i}", c, m) for i, (c, m) in enumerate(zip(cloths, coats, strict=True))),
        ),
    )


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
