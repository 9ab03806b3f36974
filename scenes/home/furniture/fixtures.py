"""What electricians and their kind leave on walls, and what people pin there. Origins are centres, on the wall."""

import numpy as np

from slamgym.scenes.home.furniture.decor import framed
from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.furniture.shelves import BOX_FRONT, in_atlas
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.prints import NOTES
from slamgym.scenes.home.solids import Mesh, bevelled, border, box, cylinder, lathe, merge, placed, tilted

TO_THE_ROOM = -np.pi / 2  # pitch that turns the upright axis of a lathe towards +y


def _plate(width: float, height: float, depth: float = 0.01) -> Mesh:
    return bevelled((-width / 2, width / 2), (0.0, depth), (-height / 2, height / 2), 0.004)


def light_switch(palette: Palette, rng: np.random.Generator) -> Piece:
    """One or two rockers, one above the other."""
    number = int(rng.integers(1, 3))
    rockers = [
        tilted(_plate(0.056, 0.056, 0.008), 0.06, (0.0, 0.009, 0.082 * (i - (number - 1) / 2))) for i in range(number)
    ]
    return Piece(
        "switch",
        (
            Component("plate", palette.porcelain, _plate(0.084, 0.084 * number)),
            Component("rockers", palette.white, merge(rockers)),
        ),
    )


def socket(palette: Palette, rng: np.random.Generator) -> Piece:
    """One to three outlets in a row."""
    number = int(rng.integers(1, 4))
    spots = [0.082 * (i - (number - 1) / 2) for i in range(number)]
    ring = lathe([(0.017, 0.0), (0.021, 0.0), (0.021, 0.004), (0.017, 0.004), (0.017, 0.0)], sides=12)
    well = cylinder(0.017, (0.0, 0.002))
    return Piece(
        "socket",
        (
            Component("plate", palette.porcelain, _plate(0.084 * number, 0.084)),
            Component("outlets", palette.metal, merge(tilted(ring, TO_THE_ROOM, (x, 0.009, 0.0)) for x in spots)),
            Component("wells", palette.black, merge(tilted(well, TO_THE_ROOM, (x, 0.009, 0.0)) for x in spots)),
        ),
    )


def thermostat(palette: Palette, _: np.random.Generator) -> Piece:
    dial = tilted(cylinder(0.026, (0.0, 0.012), sides=16), TO_THE_ROOM, (0.0, 0.022, -0.012))
    return Piece(
        "thermostat",
        (
            Component("case", palette.porcelain, _plate(0.085, 0.12, 0.022)),
            Component("display", palette.glass, box((-0.025, 0.025), (0.022, 0.0235), (0.025, 0.045))),
            Component("dial", palette.metal, dial),
        ),
    )


def intercom(palette: Palette, _: np.random.Generator) -> Piece:
    receiver = bevelled((-0.075, -0.02), (0.03, 0.062), (-0.1, 0.1), 0.012)
    buttons = [box((0.02, 0.06), (0.03, 0.034), (z, z + 0.016)) for z in (-0.07, -0.04, -0.01)]
    return Piece(
        "intercom",
        (
            Component("case", palette.porcelain, _plate(0.17, 0.22, 0.03)),
            Component("receiver", palette.white, receiver),
            Component("buttons", palette.black, merge(buttons)),
        ),
    )


def vent(palette: Palette, _: np.random.Generator) -> Piece:
    slats = [box((-0.08, 0.08), (0.006, 0.012), (z, z + 0.006)) for z in np.linspace(-0.075, 0.069, 9)]
    return Piece(
        "vent",
        (
            Component("frame", palette.trim, border((-0.1, 0.1), (0.0, 0.014), (-0.1, 0.1), 0.02)),
            Component("back", palette.black, box((-0.08, 0.08), (0.0, 0.004), (-0.08, 0.08))),
            Component("slats", palette.trim, merge(slats)),
        ),
    )


def smoke_alarm(palette: Palette, _: np.random.Generator) -> Piece:
    """Hangs from the ceiling."""
    body = [(0.0, -0.035), (0.04, -0.035), (0.055, -0.02), (0.055, 0.0), (0.0, 0.0)]
    return Piece("smoke_alarm", (Component("body", palette.porcelain, lathe(body, sides=16)),))


def _sheet(rng: np.random.Generator, row: int, width: float, height: float, x: float, y: float, z: float) -> Mesh:
    """A sheet of paper from the palette's `notes`, a little askew, its middle at (x, z)."""
    paper = box((-width / 2, width / 2), (0.0, 0.0015), (-height / 2, height / 2))
    mesh = in_atlas(paper, BOX_FRONT, (row, int(rng.integers(NOTES[1]))), NOTES)
    turn = float(rng.normal(0.0, 0.06))
    c, s = np.cos(turn), np.sin(turn)
    turned = mesh.vertices @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return Mesh(turned + np.array([x, y, z]), mesh.faces, mesh.uv)


def calendar(palette: Palette, rng: np.random.Generator) -> Piece:
    return Piece("calendar", (Component("page", palette.notes, _sheet(rng, 0, 0.3, 0.42, 0.0, 0.001, 0.0)),))


def pinned_notes(palette: Palette, rng: np.random.Generator) -> Piece:
    """Three to five sheets on a wall or a door, each above the last where they lie over one another."""
    spots = rng.uniform((-0.22, -0.2), (0.22, 0.2), (int(rng.integers(3, 6)), 2)).tolist()
    sheets = [_sheet(rng, int(rng.integers(1, 3)), 0.15, 0.21, x, 0.0, z) for x, z in spots]
    stacked = [placed(sheet, at=(0.0, 0.001 + 0.002 * i, 0.0)) for i, sheet in enumerate(sheets)]
    return Piece("pinned_notes", (Component("sheets", palette.notes, merge(stacked)),))


def pinboard(palette: Palette, rng: np.random.Generator) -> Piece:
    """A framed board of cork with notes."""
    notes = pinned_notes(palette, rng).placed(0.0, (0.0, 0.011, 0.0)).components
    return Piece(
        "pinboard",
        (
            Component("frame", palette.oak, border((-0.42, 0.42), (0.0, 0.02), (-0.36, 0.36), 0.025)),
            Component("cork", palette.card, box((-0.395, 0.395), (0.0, 0.01), (-0.335, 0.335))),
            *notes,
        ),
    )


def wall_mirror(palette: Palette, rng: np.random.Generator) -> Piece:
    """What it shows is dim and never changes: rays are not followed."""
    frame = (palette.walnut, palette.metal, palette.oak)[int(rng.integers(3))]
    return framed("mirror", palette.mirror, frame, 0.45, float(rng.uniform(0.7, 1.2)), 0.035)


def key_hooks(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small board with hooks, keys and straps."""
    spots = np.linspace(-0.14, 0.14, 5)
    hooks = [box((x - 0.004, x + 0.004), (0.012, 0.035), (-0.02, -0.012)) for x in spots]
    straps = [
        box((x - 0.012, x + 0.012), (0.016, 0.022), (-0.02 - z, -0.02))
        for x, z in zip(spots, rng.uniform(0.06, 0.2, 5), strict=True)
    ]
    plastics = palette.plastics
    return Piece(
        "key_hooks",
        (
            Component("board", palette.oak, _plate(0.36, 0.09, 0.014)),
            Component("hooks", palette.metal, merge(hooks)),
            Component("straps", plastics[int(rng.integers(len(plastics)))], merge(straps[:3])),
        ),
    )


def wall_lamp(palette: Palette, _: np.random.Generator) -> Piece:
    """A shade on an arm; off by day."""
    shade = [(0.08, -0.07), (0.055, 0.07), (0.05, 0.07), (0.075, -0.07), (0.08, -0.07)]
    return Piece(
        "wall_lamp",
        (
            Component("rose", palette.metal, _plate(0.08, 0.12, 0.015)),
            Component("arm", palette.metal, box((-0.008, 0.008), (0.015, 0.13), (-0.008, 0.008))),
            Component("shade", palette.linen, lathe(shade, (0.0, 0.13, 0.03), 16)),
        ),
    )
