"""Procedural houses: a furnished home for every seed."""

from collections import Counter
from collections.abc import Iterable, Iterator

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.home.division import make_floor_plan
from slamgym.scenes.home.furnish import furnish
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.home.palette import make_palette
from slamgym.scenes.home.shell import shell_pieces
from slamgym.scenes.house import House, Part


def procedural_house(seed: int) -> House:
    """A furnished home of 4 to 7 rooms, the same to the last bit for the same seed; raises SceneError below 0.

    Light is not baked yet, except in parts that shine by themselves (windows, bulbs, screens).
    """
    if seed < 0:
        raise SceneError(f"procedural house: expected a seed of 0 or more, got {seed}; choose another seed")
    plan_rng, palette_rng, shell_rng, furniture_rng = np.random.default_rng(seed).spawn(4)
    plan = make_floor_plan(plan_rng)
    palette = make_palette(palette_rng)
    furniture, lamps = furnish(plan, palette, furniture_rng)
    pieces = [*shell_pieces(plan, palette, shell_rng), *(item.in_world() for item in furniture)]
    rooms = tuple(planned.room for planned in plan.rooms)
    return House(f"procedural:{seed}", tuple(_numbered(pieces)), rooms, tuple(lamps))


def _numbered(pieces: Iterable[Piece]) -> Iterator[Part]:
    """The parts of all pieces, named kind_number/component."""
    seen: Counter[str] = Counter()
    for piece in pieces:
        seen[piece.kind] += 1
        yield from piece.parts(f"{piece.kind}_{seen[piece.kind]}")
