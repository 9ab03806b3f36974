"""Small things that stand on furniture, each centred on its origin."""

import numpy as np

from slamgym.scenes.home.furniture.desktop import laptop, papers, pen_cup
from slamgym.scenes.home.furniture.lamps import desk_lamp, table_lamp
from slamgym.scenes.home.furniture.piece import Component, Maker, Piece
from slamgym.scenes.home.furniture.shelves import BOX_FRONT, book, in_atlas
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.prints import LABELS
from slamgym.scenes.home.solids import (
    Mesh,
    ball,
    bevelled,
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


def book_stack(palette: Palette, rng: np.random.Generator) -> Piece:
    """Two to four books lying on each other."""
    books: list[Mesh] = []
    z = 0.0
    for _ in range(int(rng.integers(2, 5))):
        thickness, length = float(rng.uniform(0.02, 0.04)), float(rng.uniform(0.18, 0.24))
        upright = book(rng, (-thickness / 2, thickness / 2), (-0.08, 0.08), (-length / 2, length / 2))
        books.append(placed(_laid(upright), float(rng.uniform(-0.3, 0.3)), (0.0, 0.0, z + thickness / 2)))
        z += thickness
    return Piece("book_stack", (Component("books", palette.books, merge(books)),))


def _laid(mesh: Mesh) -> Mesh:
    """The mesh turned by 90 degrees about y: what was upright lies along x."""
    x, y, z = mesh.vertices.T
    return Mesh(np.column_stack([z, y, -x]), mesh.faces, mesh.uv)


def mug(palette: Palette, rng: np.random.Generator) -> Piece:
    cup = [(0.0, 0.0), (0.038, 0.0), (0.042, 0.09), (0.037, 0.09), (0.034, 0.01), (0.0, 0.01)]
    handle = box((0.04, 0.065), (-0.007, 0.007), (0.025, 0.07))
    finish = (palette.porcelain, palette.clay, *palette.plastics)[int(rng.integers(7))]
    return Piece(
        "mug",
        (
            Component("cup", finish, lathe(cup)),
            Component("handle", finish, handle),
            Component("coffee", palette.soil, cylinder(0.036, (0.06, 0.07))),
        ),
    )


def vase(palette: Palette, rng: np.random.Generator) -> Piece:
    """A vase with flowers."""
    body = [(0.0, 0.0), (0.05, 0.0), (0.075, 0.09), (0.03, 0.2), (0.04, 0.23), (0.032, 0.23), (0.02, 0.19), (0.0, 0.05)]
    stems, heads = [], []
    for _ in range(5):
        x, y = rng.uniform(-0.03, 0.03, 2)
        top = float(rng.uniform(0.3, 0.42))
        stems.append(cylinder(0.003, (0.15, top), (float(x), float(y)), 5))
        heads.append(ball(0.028, (float(x), float(y), top)))
    return Piece(
        "vase",
        (
            Component("body", palette.clay, lathe(body)),
            Component("stems", palette.leaves, merge(stems)),
            Component("flowers", palette.cushions[int(rng.integers(3))], merge(heads)),
        ),
    )


def fruit_bowl(palette: Palette, _: np.random.Generator) -> Piece:
    bowl = [(0.0, 0.0), (0.06, 0.0), (0.14, 0.07), (0.13, 0.07), (0.05, 0.012), (0.0, 0.012)]
    spots = [(0.06 * float(np.cos(a)), 0.06 * float(np.sin(a))) for a in np.arange(5) * 0.4 * np.pi]
    fruit = [ball(0.037, (x, y, 0.055)) for x, y in spots]
    return Piece(
        "fruit_bowl",
        (
            Component("bowl", palette.white, lathe(bowl, sides=20)),
            Component("fruit", palette.clay, merge(fruit[:3])),
            Component("limes", palette.leaves, merge(fruit[3:])),
        ),
    )


def packages(palette: Palette, rng: np.random.Generator) -> Piece:
    """Two or three printed boxes side by side."""
    boxes, x = [], -0.15
    for _ in range(int(rng.integers(2, 4))):
        width, height = float(rng.uniform(0.06, 0.11)), float(rng.uniform(0.1, 0.26))
        cell = int(rng.integers(LABELS[0])), int(rng.integers(LABELS[1]))
        boxes.append(in_atlas(box((x, x + width), (-0.04, 0.04), (0.0, height)), BOX_FRONT, cell, LABELS))
        x += width + 0.008
    return Piece("packages", (Component("boxes", palette.labels, merge(boxes)),))


def bottles(palette: Palette, rng: np.random.Generator) -> Piece:
    """Three bottles and jars."""
    finishes = (palette.leaves, palette.clay, palette.porcelain)
    parts = []
    for i, finish in enumerate(finishes):
        r, h = float(rng.uniform(0.025, 0.04)), float(rng.uniform(0.12, 0.26))
        profile = [(0.0, 0.0), (r, 0.0), (r, 0.65 * h), (0.35 * r, 0.8 * h), (0.35 * r, h), (0.0, h)]
        parts.append(Component(f"bottle_{i}", finish, lathe(profile, (0.1 * i - 0.1, 0.0, 0.0), 12)))
    return Piece("bottles", tuple(parts))


def magazine(palette: Palette, rng: np.random.Generator) -> Piece:
    """Lies flat, showing its cover."""
    cover = palette.pictures[int(rng.integers(len(palette.pictures)))]
    turn = float(rng.uniform(-0.4, 0.4))
    return Piece(
        "magazine",
        (
            Component("pages", palette.white, placed(box((-0.1, 0.1), (-0.14, 0.14), (0.0, 0.006)), turn)),
            Component("cover", cover, placed(sheet((-0.1, 0.1), (-0.14, 0.14), 0.0075), turn)),
        ),
    )


def photo(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small framed photo, leaning back."""
    shown = palette.pictures[int(rng.integers(len(palette.pictures)))]
    lean = 0.2
    return Piece(
        "photo",
        (
            Component(
                "frame", palette.oak, tilted(box((-0.08, 0.08), (-0.012, 0.0), (0.0, 0.2)), lean, (0, 0.02, 0.003))
            ),
            Component("picture", shown, tilted(picture(0.14, (0.01, 0.19), 0.002), lean, (0.0, 0.02, 0.003))),
            Component("prop", palette.oak, box((-0.02, 0.02), (-0.07, -0.04), (0.0, 0.1))),
        ),
    )


def remote(palette: Palette, _: np.random.Generator) -> Piece:
    keys = [
        box((x - 0.005, x + 0.005), (y, y + 0.008), (0.018, 0.02))
        for x in (-0.012, 0.0, 0.012)
        for y in (-0.07, -0.05, -0.03, -0.01)
    ]
    return Piece(
        "remote",
        (
            Component("body", palette.black, bevelled((-0.024, 0.024), (-0.09, 0.09), (0.0, 0.018), 0.005)),
            Component("keys", palette.porcelain, merge(keys)),
        ),
    )


def small_plant(palette: Palette, rng: np.random.Generator) -> Piece:
    pot = [(0.0, 0.0), (0.05, 0.0), (0.065, 0.1), (0.058, 0.1), (0.055, 0.085), (0.0, 0.085)]
    blades = [
        placed(
            tilted(stretched(lathe([(0, 0), (0.016, 0.06), (0.012, 0.12), (0, length)], sides=4), y=0.25), -lean),
            yaw,
            (0, 0, 0.08),
        )
        for length, lean, yaw in zip(
            rng.uniform(0.14, 0.26, 11), rng.uniform(0.1, 1.0, 11), rng.uniform(0.0, 6.28, 11), strict=True
        )
    ]
    finish = (palette.clay, palette.porcelain, *palette.plastics)[int(rng.integers(7))]
    return Piece(
        "small_plant",
        (Component("pot", finish, lathe(pot)), Component("leaves", palette.leaves, merge(blades))),
    )


def candles(palette: Palette, rng: np.random.Generator) -> Piece:
    sticks = [cylinder(0.02, (0.01, float(rng.uniform(0.06, 0.18))), (x, 0.0)) for x in (-0.055, 0.0, 0.055)]
    plate = lathe([(0, 0), (0.1, 0), (0.105, 0.01), (0, 0.01)], sides=20)
    return Piece(
        "candles", (Component("plate", palette.metal, plate), Component("sticks", palette.linen, merge(sticks)))
    )


def plates(palette: Palette, rng: np.random.Generator) -> Piece:
    """A place that somebody has laid, or left."""
    glass = lathe([(0, 0), (0.028, 0), (0.032, 0.11), (0.029, 0.11), (0.026, 0.008), (0, 0.008)], (0.16, 0.06, 0))
    plate = lathe([(0, 0), (0.08, 0), (0.125, 0.018), (0.12, 0.02), (0.075, 0.008), (0, 0.008)], sides=24)
    knife = [bevelled((x, x + 0.014), (-0.1, 0.09), (0.0, 0.004), 0.002) for x in (0.145, -0.165)]
    return Piece(
        "plates",
        (
            Component("plate", (palette.porcelain, palette.clay, *palette.plastics[1:3])[int(rng.integers(4))], plate),
            Component("glass", palette.metal, glass),
            Component("cutlery", palette.metal, merge(knife)),
        ),
    )


ON_LIVING_TABLES: tuple[Maker, ...] = (
    book_stack,
    mug,
    vase,
    fruit_bowl,
    magazine,
    photo,
    remote,
    candles,
    papers,
    small_plant,
)
ON_DINING_TABLES: tuple[Maker, ...] = (plates, mug, vase, fruit_bowl, plates, candles, papers, magazine)
ON_CABINETS: tuple[Maker, ...] = (vase, photo, book_stack, table_lamp, photo, small_plant, candles, papers)
ON_DESKS: tuple[Maker, ...] = (
    desk_lamp,
    book_stack,
    mug,
    papers,
    pen_cup,
    photo,
    papers,
    laptop,
    small_plant,
    magazine,
)
ON_NIGHTSTANDS: tuple[Maker, ...] = (table_lamp, book_stack, mug, small_plant)
IN_BATHROOMS: tuple[Maker, ...] = (bottles, packages, small_plant)
