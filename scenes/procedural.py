"""Procedural houses: a furnished home for every seed."""

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from slamgym.errors import SceneError
from slamgym.scenes.home.division import make_floor_plan
from slamgym.scenes.home.furnish import Taste, furnish
from slamgym.scenes.home.furniture.piece import Made, Piece, made_by_code
from slamgym.scenes.home.palette import make_palette
from slamgym.scenes.home.shell import daylight, shell_pieces
from slamgym.scenes.house import House, Part
from slamgym.scenes.loader import SceneOptions


class HomeOptions(SceneOptions):
    """What a home is like. Its floor plan and main furniture depend on seed and size alone.

    size: small, 4 rooms; medium, 4 to 7; large, 9 to 11. clutter: how many small things lie about, 1 as in most
    homes. texture: how rich surfaces are, from plain paint (0) over what is usual (1) to strong patterns (2).
    """

    size: Literal["small", "medium", "large"] = "medium"
    clutter: Annotated[float, Field(ge=0.0, le=2.0)] = 1.0
    texture: Annotated[float, Field(ge=0.0, le=2.0)] = 1.0


class Procedural:
    """Homes made by code."""

    Options: ClassVar[type[SceneOptions]] = HomeOptions
    suffixes: ClassVar[tuple[str, ...]] = ()

    @staticmethod
    def load(source: int | Path, options: SceneOptions) -> House:
        """The home of a seed; see `furnished_house`."""
        assert isinstance(source, int)
        assert isinstance(options, HomeOptions)
        return furnished_house(f"procedural:{source}", source, options)


def furnished_house(name: str, seed: int, options: HomeOptions, made: Made = made_by_code) -> House:
    """A furnished home, the same to the last bit for the same seed, options and `made`; raises SceneError below 0.

    Light is not baked yet, except in parts that shine by themselves (windows, bulbs, screens).
    """
    if seed < 0:
        raise SceneError(f"procedural house: expected a seed of 0 or more, got {seed}; choose another seed")
    plan_rng, palette_rng, shell_rng, furniture_rng = np.random.default_rng(seed).spawn(4)
    plan = make_floor_plan(plan_rng, options.size)
    palette = make_palette(palette_rng, options.texture, _PICTURES[options.size])
    furniture, lamps = furnish(plan, palette, furniture_rng, Taste(options.clutter, options.texture, made))
    shell = shell_pieces(plan, palette, shell_rng, options.texture)
    rooms = tuple(planned.room for planned in plan.rooms)
    parts = tuple(_numbered([*shell, *(item.in_world() for item in furniture)]))
    return House(name, parts, rooms, tuple(lamps), tuple(daylight(plan)))


_PICTURES = {"small": 22, "medium": 36, "large": 60}


def _numbered(pieces: Iterable[Piece]) -> Iterator[Part]:
    """The parts of all pieces, named kind_number/component."""
    seen: Counter[str] = Counter()
    for piece in pieces:
        seen[piece.kind] += 1
        yield from piece.parts(f"{piece.kind}_{seen[piece.kind]}")
