"""Rooms, lamps and windows in a file's `extras`: glTF has no words of its own for them."""

import json
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from itertools import chain
from typing import Any

from pydantic import TypeAdapter, ValidationError

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Lamp, Room, Window

KEY = "slamgym"
"""Under this key of the scene's `extras`. Its values are metres in slamgym's world frame: z up, the floor at 0."""
MOST = 1000
FARTHEST_M = 1e4
BRIGHTEST = 1e3
STRONGEST_COLOUR = 10.0
LARGEST_RADIUS_M = 10.0


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
    """What `extras_of` wrote; None where a file has nothing of the kind.

    Where there is something, the file is one of slamgym's: y up, metres, the floor at 0. Raises SceneError for what is
    broken, or no house has.
    """
    if not (isinstance(extras, dict) and KEY in extras):
        return None
    try:
        found = TypeAdapter(Extras).validate_json(json.dumps(extras[KEY], allow_nan=False))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or KEY
        raise SceneError(f"{where}: {first['msg']}, got {str(first['input'])[:60]!r}; correct it") from None
    except (ValueError, TypeError, RecursionError) as error:
        raise SceneError(f"{KEY}: expected numbers and words, got: {error}; correct it") from None
    for problem in _problems(found):
        raise SceneError(problem)
    return found


def is_usable(room: Room) -> bool:
    """Whether a room has an area, and lies where a house may."""
    bounds = (room.x_min, room.y_min, room.x_max, room.y_max)
    return room.x_min < room.x_max and room.y_min < room.y_max and _all_in(bounds, -FARTHEST_M, FARTHEST_M)


def _problems(extras: Extras) -> Iterator[str]:
    """What no house has; numbers are compared so that one which is not finite is out of range."""
    for what, items in (("rooms", extras.rooms), ("lamps", extras.lamps), ("windows", extras.windows)):
        if len(items) > MOST:
            yield f"expected at most {MOST} {what}, got {len(items)}; simplify the house"
    if bad := [room.name for room in extras.rooms if not is_usable(room)]:
        yield f"room {bad[0][:60]!r}: expected sides, at most {FARTHEST_M:g} m from the origin, got others; correct it"
    sources: tuple[Lamp | Window, ...] = (*extras.lamps, *extras.windows)
    places = [lamp.position for lamp in extras.lamps]
    places += (place for window in extras.windows for place in (window.centre, window.half_u, window.half_v))
    for what, values, low, high in (
        ("coordinates", chain(*places), -FARTHEST_M, FARTHEST_M),
        ("intensities", (source.intensity for source in sources), 0.0, BRIGHTEST),
        ("colours", chain(*(source.colour for source in sources)), 0.0, STRONGEST_COLOUR),
        ("radii", (lamp.radius for lamp in extras.lamps), 0.0, LARGEST_RADIUS_M),
    ):
        if not _all_in(values, low, high):
            yield f"lamps and windows: expected {what} from {low:g} to {high:g}, got others; correct them"


def _all_in(values: Iterable[float], low: float, high: float) -> bool:
    return all(low <= value <= high for value in values)
