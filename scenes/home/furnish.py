"""Furnishing a house: doors, curtains, furniture, pictures and lamps, room by room."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from slamgym.scenes.home import fittings
from slamgym.scenes.home.floorplan import DOOR_WIDTH, FloorPlan
from slamgym.scenes.home.furnisher import Furnisher, Household
from slamgym.scenes.home.furniture import lamps, openings
from slamgym.scenes.home.furniture.piece import Made
from slamgym.scenes.home.palette import Palette
from slamgym.scenes.home.placement import Placed, RoomLayout
from slamgym.scenes.home.programmes import PROGRAMMES
from slamgym.scenes.house import Lamp

_AREA_PER_LAMP = 15.0


@dataclass(frozen=True, slots=True)
class Taste:
    """How a house is furnished. clutter: small things, 1 as in most homes. richness: pictures, likewise."""

    clutter: float
    richness: float
    made: Made


def furnish(
    plan: FloorPlan, palette: Palette, rng: np.random.Generator, taste: Taste
) -> tuple[list[Placed], list[Lamp]]:
    """All furniture of a house, and the lamps that shine in it."""
    items: list[Placed] = []
    shining: list[Lamp] = []
    leaf = openings.door_leaf(palette, rng, DOOR_WIDTH - 0.03, 2.03)
    household = Household(palette, iter(palette.pictures), taste.clutter, taste.made)
    kinds = [planned.room.kind for planned in plan.rooms]
    entrance = kinds.index("hall" if "hall" in kinds else "living_room")
    for i, planned in enumerate(plan.rooms):
        room = Furnisher(RoomLayout(planned, plan.height), household, *rng.spawn(2))
        fittings.doors(room, leaf)
        if i == entrance:
            fittings.front_door(room)
        fittings.windows(room)
        PROGRAMMES[planned.room.kind](room)
        fittings.radiators(room)
        shining += _ceiling_lamps(room)
        fittings.electrics(room)
        room.add_clutter()
        fittings.pictures(room, taste.richness)
        items += room.layout.items
    return items, shining


def _ceiling_lamps(room: Furnisher) -> Iterator[Lamp]:
    """Hanging lamps in a line along the room; the light is just under each shade."""
    bounds, height = room.layout.planned.room, room.layout.height
    size = np.array([bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min])
    number = max(1, round(room.layout.area / _AREA_PER_LAMP), round(size.max() / 5.0))
    lamp = room.make(lamps.ceiling_lamp)
    for i in range(number):
        share = np.where(size == size.max(), (i + 0.5) / number, 0.5)
        x, y = (np.array([bounds.x_min, bounds.y_min]) + share * size).tolist()
        room.layout.lay(Placed(lamp, 0.0, (x, y, height)))
        yield Lamp((x, y, height - lamps.CEILING_LAMP_DROP))
