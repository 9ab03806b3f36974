"""Scene options that loaders of meshes share."""

import math
from typing import Literal

from pydantic import field_validator

from slamgym.scenes.loader import SceneOptions

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}
"""Metres."""
UNIT_RANGE = (1e-6, 1e4)
FARTHEST_FLOOR_M = 1e4


class PlacedOptions(SceneOptions):
    """How a mesh lies in the world; each is told by the geometry unless given.

    up: the axis of the file that points up. unit: metres of one unit of the file, or a word of UNITS. floor: height of
    the floor, metres.
    """

    up: Literal["auto", "x", "y", "z"] = "auto"
    unit: Literal["auto"] | float = "auto"
    floor: Literal["auto"] | float = "auto"

    # Of a choice of types pydantic would tell what is wrong for each of them, and no word of what may be given.
    @field_validator("unit", mode="before")
    @classmethod
    def _unit(cls, given: object) -> object:
        metres = UNITS.get(given, given) if isinstance(given, str) else given
        words = f"auto, {', '.join(UNITS)} or metres as 0.01"
        return cls._auto_or_number("unit", metres, words, *UNIT_RANGE)

    @field_validator("floor", mode="before")
    @classmethod
    def _floor(cls, given: object) -> object:
        return cls._auto_or_number("floor", given, "auto or metres as -0.3", -FARTHEST_FLOOR_M, FARTHEST_FLOOR_M)

    @classmethod
    def _auto_or_number(cls, name: str, given: object, words: str, low: float, high: float) -> object:
        if given == "auto":
            return given
        number = _number(given)
        if not low <= number <= high:
            between = "" if math.isnan(number) else f" from {low:g} to {high:g}"
            raise ValueError(f"{cls._label(name)}: expected {words}{between}, got {str(given)[:60]!r}")
        return number


def _number(given: object) -> float:
    """The number, also one in words as "0.01"; not a number for anything else."""
    try:
        return float(given) if isinstance(given, (str, int, float)) else math.nan
    except (ValueError, OverflowError):
        return math.nan
