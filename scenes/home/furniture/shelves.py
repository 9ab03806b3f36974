"""Book shelves, full of books."""

import numpy as np

from slamgym.scenes.home import prints
from slamgym.scenes.home.furniture.piece import Component, Piece
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.solids import Interval, Mesh, box, merge


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
    width, depth = float(rng.uniform(0.8, 1.1)), 0.3
    levels = int(rng.integers(4, 7))
    height = 0.08 + 0.34 * levels
    half, board = width / 2, 0.02
    heights = 0.06 + 0.34 * np.arange(levels + 1)
    wood = palette.oak if rng.random() < 0.5 else palette.white
    sides = [box((x, x + board), (0.0, depth), (0.0, height)) for x in (-half, half - board)]
    boards = [box((-half + board, half - board), (0.0, depth), (z, z + board)) for z in heights]
    books = [
        book
        for z in heights[:-1]
        for book in row_of_books(rng, (-half + board + 0.005, half - board), (0.03, 0.25), z + board, 0.3)
    ]
    return Piece(
        "bookshelf",
        (
            Component("sides", wood, merge(sides)),
            Component("boards", wood, merge(boards)),
            Component("back", wood, box((-half + board, half - board), (0.0, 0.008), (0.06, height - 0.02))),
            Component("books", palette.books, merge(books)),
        ),
        front=0.4,
    )


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
