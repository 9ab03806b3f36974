"""Shelves with books and other things."""

import numpy as np

from slamgym.scenes.home import prints
from slamgym.scenes.home.furniture.piece import Component, Piece, Top
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.solids import Interval, Mesh, bevelled, box, lathe, merge


def in_atlas(mesh: Mesh, front: int, cell: tuple[int, int], cells: tuple[int, int]) -> Mesh:
    """A box whose quad number `front` shows one cell of an atlas; the other sides get the cell's paper colour."""
    row, column = cell
    rows, columns = cells
    u, v = np.array([column, column + 1]) / columns, 1.0 - np.array([row + 1, row]) / rows
    uv = np.tile([u[0] + 0.12 / columns, v[0] + 0.02 / rows], (len(mesh.vertices), 1))
    # The front of a box is given right bottom, right top, left top, left bottom, seen from outside.
    uv[4 * front : 4 * front + 4] = [(u[1], v[0]), (u[1], v[1]), (u[0], v[1]), (u[0], v[0])]
    return Mesh(mesh.vertices, mesh.faces, uv)


BOX_FRONT = 3
"""Number of a box's quad that faces +y."""


def book(rng: np.random.Generator, x: Interval, y: Interval, z: Interval) -> Mesh:
    """An upright book, its spine towards +y, drawn from the palette's `books`."""
    rows, columns = prints.SPINES
    cell = int(rng.integers(rows)), int(rng.integers(columns))
    return in_atlas(box(x, y, z), BOX_FRONT, cell, prints.SPINES)


def row_of_books(rng: np.random.Generator, x: Interval, y: Interval, z: float, room: float) -> list[Mesh]:
    """Books side by side from x[0], at most `room` high, with a gap now and then."""
    books, at = [], x[0]
    while at < x[1] - 0.05:
        width, height = float(rng.uniform(0.018, 0.05)), float(rng.uniform(0.62, 0.95)) * room
        if rng.random() < 0.06:
            at += float(rng.uniform(0.04, 0.14))
        else:
            front = y[1] - float(rng.uniform(0.0, 0.03))
            books.append(book(rng, (at, at + width), (y[0], front), (z, z + height)))
            at += width + 0.001
    return books


def bookshelf(palette: Palette, rng: np.random.Generator) -> Piece:
    """Open shelves: books, and on some boards boxes, jars and whatever else ends up there."""
    width, depth = float(rng.uniform(0.7, 1.1)), 0.3
    levels = int(rng.integers(3, 7))
    height = 0.08 + 0.34 * levels
    half, board = width / 2, 0.02
    heights = 0.06 + 0.34 * np.arange(levels + 1)
    wood = (palette.oak, palette.white, palette.walnut)[int(rng.integers(3))]
    sides = [bevelled((x, x + board), (0.0, depth), (0.0, height), 0.003) for x in (-half, half - board)]
    boards = [bevelled((-half + board, half - board), (0.0, depth), (z, z + board), 0.003) for z in heights]
    inner = (-half + board + 0.005, half - board)
    books, objects = [], []
    for level, z in enumerate((heights[:-1] + board).tolist()):
        end = inner[1] if rng.random() < 0.5 or level == 1 else inner[0] + float(rng.uniform(0.15, 0.7)) * width
        books += row_of_books(rng, (inner[0], end), (0.03, 0.25), z, 0.3)
        objects += _odds_and_ends(palette, rng, (end + 0.02, inner[1]), z)
    back = box((-half + board, half - board), (0.0, 0.008), (0.06, height - 0.02))
    return Piece(
        "bookshelf",
        (
            Component("sides", wood, merge(sides)),
            Component("boards", wood, merge(boards)),
            Component("back", wood, back),
            Component("books", palette.books, merge(books)),
            *(Component(f"object_{i}", finish, mesh) for i, (finish, mesh) in enumerate(objects)),
        ),
        tops=(Top((-half + 0.1, half - 0.1), (0.08, 0.22), height),) if levels < 5 else (),
        front=0.4,
    )


def _odds_and_ends(palette: Palette, rng: np.random.Generator, x: Interval, z: float) -> list[tuple[Finish, Mesh]]:
    """Boxes, jars and vases from x[0] to x[1]."""
    found: list[tuple[Finish, Mesh]] = []
    at = x[0]
    while at < x[1] - 0.12:
        kind, height = int(rng.integers(3)), float(rng.uniform(0.08, 0.26))
        if kind == 0:
            width = min(float(rng.uniform(0.12, 0.3)), x[1] - at)
            finish = (palette.card, palette.wicker, *palette.plastics)[int(rng.integers(7))]
            found.append((finish, bevelled((at, at + width), (0.04, 0.26), (z, z + height), 0.008)))
        else:
            r = float(rng.uniform(0.03, 0.055))
            width = 2.0 * r
            neck = r * float(rng.uniform(0.4, 1.0))
            profile = [
                (0.0, 0.0),
                (0.7 * r, 0.0),
                (r, 0.4 * height),
                (neck, 0.85 * height),
                (neck, height),
                (0.0, height),
            ]
            finish = (palette.clay, palette.porcelain, palette.metal, *palette.plastics)[int(rng.integers(8))]
            found.append((finish, lathe(profile, (at + r, 0.14, z), 12)))
        at += width + float(rng.uniform(0.015, 0.06))
    return found


def wall_shelf(palette: Palette, rng: np.random.Generator) -> Piece:
    """A board with a few books, to hang on a wall."""
    brackets = [box((x, x + 0.02), (0.0, 0.18), (-0.03, 0.0)) for x in (-0.35, 0.33)]
    return Piece(
        "wall_shelf",
        (
            Component("board", palette.oak, box((-0.45, 0.45), (0.0, 0.2), (0.0, 0.022))),
            Component("brackets", palette.metal, merge(brackets)),
            Component("books", palette.books, merge(row_of_books(rng, (-0.42, 0.42), (0.01, 0.17), 0.022, 0.27))),
        ),
    )
