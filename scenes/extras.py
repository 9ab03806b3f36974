"""Rooms, lamps and windows in a file's `extras`: glTF has no words of its own for them."""

import json
from dataclasses import asdict, dataclass
from typing import Any

from pydantic import TypeAdapter

from slamgym.scenes.house import House, Lamp, Room, Window

KEY = "slamgym"
"""Under this key of the scene's `extras`. Its values are metres in slamgym's world frame: z up, the floor at 0."""


@dataclass(frozen=True, slots=True)
class Extras:
    """What a house has besides triangles. baked: whether its vertex colours are the light of all of them."""

    rooms: tuple[Room, ...] = ()
    lamps: tuple[Lamp, ...] = ()
    windows: tuple[Window, ...] = ()
    baked: bool = False


def extras_of(house: House) -> dict[str, Any]:
    """The `extras` to write with a house; ready for JSON."""
    baked = all(part.light is not None for part in house.parts)
    return {KEY: asdict(Extras(house.rooms, house.lamps, house.windows, baked))}


def read_extras(extras: object) -> Extras | None:
    """What `extras_of` wrote; None where a file has nothing of the kind, or something broken.

    Where there is something, the file is one of slamgym's: y up, metres, the floor at 0.
    """
    if not (isinstance(extras, dict) and isinstance(extras.get(KEY), dict)):
        return None
    try:
        text = json.dumps(extras[KEY], allow_nan=False)
        return TypeAdapter(Extras).validate_json(text)
    except (ValueError, TypeError, RecursionError):  # the first is pydantic's, too
        return None
