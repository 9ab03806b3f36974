"""Things on the floor by the walls: shoes, bags, boxes, toys. Their backs are at y = 0."""

import numpy as np

from slamgym.scenes.home.furniture.clutter import book_stack
from slamgym.scenes.home.furniture.piece import Component, Maker, Piece
from slamgym.scenes.home.furniture.shelves import BOX_FRONT, in_atlas
from slamgym.scenes.home.palette import Finish, Palette
from slamgym.scenes.home.prints import LABELS
from slamgym.scenes.home.solids import (
    Mesh,
    ball,
    bevelled,
    border,
    box,
    cushion,
    cylinder,
    lathe,
    merge,
    placed,
    tilted,
)


def _any_cloth(palette: Palette, rng: np.random.Generator) -> Finish:
    return (*palette.cushions, palette.sofa, palette.black)[int(rng.integers(5))]


def shoes(palette: Palette, rng: np.random.Generator) -> Piece:
    """A pair, not quite parallel."""
    sole = bevelled((-0.045, 0.045), (-0.14, 0.14), (0.0, 0.025), 0.02)
    upper = merge(
        [
            cushion((-0.042, 0.042), (-0.135, 0.135), (0.02, 0.09), 0.6),
            cushion((-0.038, 0.038), (-0.135, 0.0), (0.05, 0.13), 0.5),
        ]
    )
    spots = [(x, float(rng.normal(0.0, 0.15)), float(rng.uniform(0.16, 0.22))) for x in (-0.07, 0.07)]
    return Piece(
        "shoes",
        (
            Component("soles", palette.porcelain, merge(placed(sole, yaw, (x, y, 0.0)) for x, yaw, y in spots)),
            Component(
                "uppers", _any_cloth(palette, rng), merge(placed(upper, yaw, (x, y, 0.0)) for x, yaw, y in spots)
            ),
        ),
    )


def cardboard_box(palette: Palette, rng: np.random.Generator) -> Piece:
    """Taped and labelled, sometimes with another one on top."""
    boxes, tapes, z = [], [], 0.0
    for _ in range(int(rng.integers(1, 3))):
        w, d, h = (float(v) for v in rng.uniform((0.3, 0.22, 0.18), (0.45, 0.34, 0.34)))
        boxes.append(bevelled((-w / 2, w / 2), (0.02, d), (z, z + h), 0.004))
        tapes.append(box((-0.025, 0.025), (0.02, d + 0.001), (z + h - 0.06, z + h + 0.001)))
        z += h + 0.0015
    label = in_atlas(
        box((0.04, 0.13), (d, d + 0.001), (z - 0.17, z - 0.07)), BOX_FRONT, (1, int(rng.integers(LABELS[1]))), LABELS
    )
    return Piece(
        "cardboard_box",
        (
            Component("boxes", palette.card, merge(boxes)),
            Component("tapes", palette.linen, merge(tapes)),
            Component("label", palette.labels, label),
        ),
    )


def waste_bin(palette: Palette, rng: np.random.Generator) -> Piece:
    """Open, with crumpled paper; or closed, with a pedal."""
    y, r, h = 0.16, float(rng.uniform(0.11, 0.14)), float(rng.uniform(0.28, 0.4))
    finish = (palette.metal, palette.black, palette.wicker, palette.plastics[1])[int(rng.integers(4))]
    if rng.random() < 0.5:
        pedal = [lathe([(0, h), (r, h), (0.9 * r, h + 0.05), (0, h + 0.07)], (0, y, 0), 18)]
        pedal += [bevelled((-0.03, 0.03), (y + 0.9 * r, y + r + 0.03), (0.015, 0.03))]
        body = lathe([(0, 0), (r, 0), (r, h), (0, h)], (0, y, 0), 18)
        return Piece("bin", (Component("body", finish, body), Component("lid", palette.black, merge(pedal))))
    shell = [(0.0, 0.0), (0.75 * r, 0.0), (r, h), (0.95 * r, h), (0.7 * r, 0.01), (0.0, 0.01)]
    crumpled = [ball(0.045, (float(x), y + float(dy), h - 0.07)) for x, dy in rng.uniform(-0.045, 0.045, (4, 2))]
    return Piece(
        "bin",
        (Component("body", finish, lathe(shell, (0, y, 0), 18)), Component("paper", palette.linen, merge(crumpled))),
    )


def bag(palette: Palette, rng: np.random.Generator) -> Piece:
    """A rucksack leaning on the wall."""
    body = cushion((-0.16, 0.16), (0.0, 0.2), (0.0, 0.46), 0.45)
    pocket = cushion((-0.11, 0.11), (0.15, 0.25), (0.05, 0.24), 0.4)
    zips = [box((-0.1, 0.1), (0.235, 0.245), (0.2, 0.207)), box((-0.02, 0.02), (0.05, 0.07), (0.44, 0.49))]
    return Piece(
        "bag",
        (
            Component("body", _any_cloth(palette, rng), body),
            Component("pocket", _any_cloth(palette, rng), pocket),
            Component("zips", palette.metal, merge(zips)),
        ),
    )


def suitcase(palette: Palette, rng: np.random.Generator) -> Piece:
    ribs = [bevelled((x, x + 0.02), (0.232, 0.24), (0.1, 0.58)) for x in np.linspace(-0.17, 0.15, 6)]
    handle = [box((x, x + 0.012), (0.1, 0.112), (0.62, 0.8)) for x in (-0.09, 0.078)]
    handle += [bevelled((-0.1, 0.1), (0.095, 0.117), (0.8, 0.825))]
    wheels = [cylinder(0.02, (0.0, 0.04), (x, y), 8) for x in (-0.17, 0.17) for y in (0.05, 0.2)]
    shell = palette.plastics[int(rng.integers(len(palette.plastics)))]
    return Piece(
        "suitcase",
        (
            Component("shell", shell, bevelled((-0.21, 0.21), (0.02, 0.232), (0.04, 0.62), 0.03)),
            Component("ribs", shell, merge(ribs)),
            Component("handle", palette.metal, merge(handle)),
            Component("wheels", palette.black, merge(wheels)),
        ),
    )


def toys(palette: Palette, rng: np.random.Generator) -> Piece:
    """Bricks, built up and scattered, and a ball."""
    parts: list[list[Mesh]] = [[] for _ in palette.plastics]
    for i in range(12):
        x, y = rng.uniform((-0.22, 0.06), (0.22, 0.3))
        at = (-0.12, 0.12, 0.052 * i) if i < 4 else (float(x), float(y), 0.0)
        brick = bevelled((-0.025, 0.025), (-0.025, 0.025), (0.0, 0.05), 0.003)
        parts[i % len(parts)].append(placed(brick, float(rng.uniform(0.0, 1.5)), at))
    parts[1].append(ball(0.08, (0.2, 0.12, 0.08)))
    bricks = zip(palette.plastics, parts, strict=True)
    return Piece("toys", tuple(Component(f"bricks_{i}", finish, merge(m)) for i, (finish, m) in enumerate(bricks)))


def teddy(palette: Palette, rng: np.random.Generator) -> Piece:
    spheres = [
        (0.0, 0.12, 0.11, 0.11),
        (0.0, 0.12, 0.27, 0.08),
        (-0.06, 0.12, 0.34, 0.03),
        (0.06, 0.12, 0.34, 0.03),
        (-0.11, 0.16, 0.16, 0.045),
        (0.11, 0.16, 0.16, 0.045),
        (-0.07, 0.24, 0.05, 0.05),
        (0.07, 0.24, 0.05, 0.05),
    ]
    body = [cushion((x - r, x + r), (y - r, y + r), (z - r, z + r), 1.0) for x, y, z, r in spheres]
    eyes = [ball(0.01, (x, 0.193, 0.29)) for x in (-0.03, 0.03)]
    finish = (palette.card, palette.clay, palette.cushions[1])[int(rng.integers(3))]
    return Piece("teddy", (Component("body", finish, merge(body)), Component("eyes", palette.black, merge(eyes))))


def basket(palette: Palette, rng: np.random.Generator) -> Piece:
    """Woven, with a blanket or magazines in it."""
    y = 0.2
    shell = [(0.0, 0.0), (0.16, 0.0), (0.19, 0.26), (0.175, 0.26), (0.15, 0.02), (0.0, 0.02)]
    return Piece(
        "basket",
        (
            Component("shell", palette.wicker, lathe(shell, (0.0, y, 0.0), 20)),
            Component(
                "blanket", _any_cloth(palette, rng), cushion((-0.13, 0.13), (y - 0.13, y + 0.13), (0.12, 0.34), 0.7)
            ),
        ),
    )


def power_strip(palette: Palette, _: np.random.Generator) -> Piece:
    """With plugs, and a cable along the skirting board."""
    plugs = [bevelled((x - 0.02, x + 0.02), (0.03, 0.065), (0.04, 0.075), 0.008) for x in (-0.1, 0.02, 0.08)]
    cable = [box((-0.6, -0.15), (0.02, 0.027), (0.0, 0.007)), box((0.02, 0.027), (0.06, 0.2), (0.0, 0.007))]
    return Piece(
        "power_strip",
        (
            Component("strip", palette.porcelain, bevelled((-0.15, 0.15), (0.02, 0.07), (0.0, 0.04))),
            Component("plugs", palette.black, merge(plugs)),
            Component("cables", palette.black, merge(cable)),
        ),
    )


def leaning_picture(palette: Palette, rng: np.random.Generator) -> Piece:
    """A framed picture that never got a nail."""
    w, h = float(rng.uniform(0.4, 0.6)), float(rng.uniform(0.5, 0.8))
    shown = palette.pictures[int(rng.integers(len(palette.pictures)))]
    front = placed(box((-w / 2 + 0.03, w / 2 - 0.03), (0.0, 0.012), (0.03, h - 0.03)))
    frame = border((-w / 2, w / 2), (0.0, 0.022), (0.0, h), 0.03)
    lean = 0.16
    base = (0.0, 0.02 + h * float(np.sin(lean)), 0.001)
    uv = np.array([(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)])
    front.uv[:] = 0.02
    front.uv[4 * BOX_FRONT : 4 * BOX_FRONT + 4] = uv
    return Piece(
        "leaning_picture",
        (
            Component("frame", palette.black, tilted(frame, lean, base)),
            Component("back", shown, tilted(front, lean, base)),
        ),
    )


def floor_books(palette: Palette, rng: np.random.Generator) -> Piece:
    """A stack of books that found no shelf."""
    return book_stack(palette, rng).placed(0.0, (0.0, 0.2, 0.0))


ANYWHERE: tuple[Maker, ...] = (basket, cardboard_box, bag, leaning_picture, power_strip, floor_books)
IN_HALLS: tuple[Maker, ...] = (shoes, shoes, bag, cardboard_box, suitcase, shoes)
FOR_CHILDREN: tuple[Maker, ...] = (toys, teddy, toys, bag, cardboard_box, floor_books)
AT_WORK: tuple[Maker, ...] = (waste_bin, bag, cardboard_box, power_strip, floor_books)
IN_KITCHENS: tuple[Maker, ...] = (waste_bin, cardboard_box, basket)
IN_BEDROOMS: tuple[Maker, ...] = (shoes, basket, suitcase, bag, leaning_picture, shoes)
