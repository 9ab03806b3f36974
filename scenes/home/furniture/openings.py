"""What belongs to doorways and windows: door leaves, curtains, blinds, radiators."""

import numpy as np

from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Mesh, bevelled, border, box, cylinder, merge, placed, ribbon

LEAF = 0.035  # thickness of a door


def door_leaf(palette: Palette, rng: np.random.Generator, width: float, height: float) -> Piece:
    """A door that extends along x from its hinges at the origin, with handles on both sides; one of three designs."""
    half = LEAF / 2
    panels = _panels(int(rng.integers(3)), width, height)
    both = [placed(mesh, yaw, (at, 0.0, 0.0)) for mesh in panels for yaw, at in ((0.0, 0.0), (np.pi, width))]
    lever = [
        bevelled((width - 0.085, width - 0.045), (half, half + 0.008), (0.94, 1.16)),
        box((width - 0.072, width - 0.058), (half + 0.008, half + 0.04), (1.05, 1.065)),
        bevelled((width - 0.18, width - 0.055), (half + 0.03, half + 0.045), (1.047, 1.068)),
    ]
    levers = [*lever, *(_behind(mesh) for mesh in lever)]
    hinges = [cylinder(0.008, (z, z + 0.09), (-0.004, -half), 8) for z in (0.2, 1.75)]
    components = [Component("leaf", palette.lacquer, bevelled((0.0, width), (-half, half), (0.008, height), 0.003))]
    components += [Component("panels", palette.lacquer, merge(both))] if both else []
    components += [
        Component("handles", palette.metal, merge(levers)),
        Component("hinges", palette.metal, merge(hinges)),
    ]
    return Piece("door", tuple(components))


def _panels(design: int, width: float, height: float) -> list[Mesh]:
    """Mouldings on the +y side: four panels, two, or none."""
    y = (LEAF / 2, LEAF / 2 + 0.01)
    rows = [(0.14, 0.88), (1.22, height - 0.14)]
    columns = [(0.12, width / 2 - 0.05), (width / 2 + 0.05, width - 0.12)] if design == 0 else [(0.14, width - 0.14)]
    return [border(x, y, z, 0.03) for x in columns for z in rows] if design < 2 else []


def _behind(mesh: Mesh) -> Mesh:
    """The mesh as reflected in the xz plane."""
    return Mesh(mesh.vertices * (1.0, -1.0, 1.0), mesh.faces[:, ::-1], mesh.uv)


def front_door(leaf: Piece, palette: Palette, width: float, height: float) -> Piece:
    """The leaf, shut, with a frame against a wall, centred."""
    half, z = width / 2, (0.0, height + 0.08)
    frame = [
        bevelled((-half - 0.08, -half), (0.0, 0.05), z),
        bevelled((half, half + 0.08), (0.0, 0.05), z),
        box((-half, half), (0.0, 0.05), (height + 0.005, height + 0.08)),
    ]
    shut = leaf.placed(0.0, (-half, 0.065, 0.0))
    return Piece("front_door", (*shut.components, Component("frame", palette.trim, merge(frame))), front=0.8)


def curtain(palette: Palette, rng: np.random.Generator, width: float, top: float, bottom: float) -> Piece:
    """A pair of curtains for a window `width` wide, drawn aside, on a rod."""
    reach, drawn = width / 2 + 0.22, float(rng.uniform(0.24, 0.34))
    folds = np.linspace(0.0, 1.0, 25)
    swing = rng.uniform(0.7, 1.2, 25)
    wave = np.column_stack([drawn * folds, 0.075 + 0.028 * swing * np.sin(folds * rng.uniform(7.0, 9.0) * np.pi)])
    cloths = [ribbon(wave + np.array([x, 0.0]), 0.01, (bottom, top - 0.02)) for x in (-reach, reach - drawn)]
    brackets = [box((x - 0.01, x + 0.01), (0.0, 0.08), (top - 0.01, top + 0.02)) for x in (-reach + 0.1, reach - 0.1)]
    return Piece(
        "curtain",
        (
            Component("cloths", palette.curtain, merge(cloths)),
            Component("rod", palette.metal, box((-reach - 0.05, reach + 0.05), (0.06, 0.08), (top - 0.01, top + 0.01))),
            Component("brackets", palette.metal, merge(brackets)),
        ),
    )


def blind(palette: Palette, rng: np.random.Generator, width: float, top: float) -> Piece:
    """A slatted blind, pulled up for the most part."""
    half, number = width / 2 + 0.04, int(rng.integers(5, 14))
    z = top + 0.02 - 0.032 * np.arange(1, number + 1)
    slats = [box((-half, half), (0.02, 0.045), (low, low + 0.004)) for low in z.tolist()]
    cords = [box((x, x + 0.004), (0.031, 0.035), (z[-1], top + 0.02)) for x in (-half + 0.15, half - 0.15)]
    return Piece(
        "blind",
        (
            Component("case", palette.trim, bevelled((-half, half), (0.0, 0.06), (top + 0.02, top + 0.07))),
            Component("slats", palette.linen, merge(slats)),
            Component("cords", palette.white, merge(cords)),
            Component("rail", palette.trim, box((-half, half), (0.02, 0.045), (z[-1] - 0.02, z[-1]))),
        ),
    )


def radiator(palette: Palette, width: float, height: float) -> Piece:
    """A ribbed panel with a grille on top, hung under a window."""
    x, top = (-width / 2, width / 2), 0.14 + height
    ribs = [box((at, at + 0.03), (0.13, 0.136), (0.17, top - 0.03)) for at in np.arange(x[0] + 0.03, x[1] - 0.05, 0.05)]
    at = (width / 2 - 0.02, 0.085)
    valve = [cylinder(0.02, (0.08, 0.13), at), cylinder(0.012, (0.0, 0.08), at)]
    hooks = [box((h, h + 0.02), (0.0, 0.05), (top - 0.1, top - 0.07)) for h in (-0.2, 0.2)]
    return Piece(
        "radiator",
        (
            Component("panel", palette.white, merge([bevelled(x, (0.04, 0.13), (0.14, top)), *ribs])),
            Component("grille", palette.metal, box(x, (0.045, 0.125), (top, top + 0.015))),
            Component("valve", palette.metal, merge(valve)),
            Component("hooks", palette.metal, merge(hooks)),
        ),
    )
