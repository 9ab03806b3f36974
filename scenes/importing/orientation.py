"""Which way a scene is up, how long its unit is and where its floor is: as given, or as its geometry shows."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.house import Part
from slamgym.scenes.importing.cleaning import triangles_of
from slamgym.scenes.importing.inside_out import inside_out
from slamgym.scenes.importing.levels import Storey, level_share, lowest_storey
from slamgym.scenes.importing.pieces import Piece
from slamgym.scenes.importing.placed_options import UNITS, PlacedOptions
from slamgym.scenes.importing.up_axis import LOW, Units, room_height, seen_up
from slamgym.types import FloatArray

AXES = "xyz"
WALLS_ONLY = 0.1
"""Share of the area that is level, below which a scene has walls and no floor."""
NO_FLOOR = 0.5
LEAST_COVERAGE = 0.05
"""Shares of the scene's rectangle: where a floor is doubted, and where there is none."""
LEAST_BELOW_M = 1.0
BARE = 0.1
"""Height of a storey by what lies below it, below which it is a roof."""
STOREY_M = (1.5, 6.5)
IMPERIAL_STOREY_M = (2.2, 3.5)
HALL_M = 12.0
TALLEST_OF_METRES = 20.0
"""What a .glb, which is in metres by its specification, may have as a hall."""
UNIT_NAMES = {"m": "metre", "cm": "centimetre", "mm": "millimetre", "inch": "inch", "foot": "foot"}
STOREYS_OF_UNITS = (
    ("m", STOREY_M),
    ("inch", IMPERIAL_STOREY_M),
    ("foot", IMPERIAL_STOREY_M),
    ("cm", STOREY_M),
    ("mm", STOREY_M),
    ("m", (STOREY_M[1], HALL_M)),
    ("inch", STOREY_M),
    ("foot", STOREY_M),
)
"""The first in which a storey has a fitting height, in metres, is the unit."""
FAR_M = 1000.0
"""From where on float32 is too coarse."""


class Format(NamedTuple):
    """What the specification or the use of a file format says. metres: whether its unit is the metre."""

    name: str
    up: Literal["x", "y", "z"]
    metres: bool = False


FORMATS = {
    "glb": Format("glTF", "y", metres=True),
    "gltf": Format("glTF", "y", metres=True),
    "obj": Format(".obj", "y"),
    "ply": Format(".ply", "z"),
    "stl": Format(".stl", "z"),
}
"""By the ending of the file's name. Those of .obj, .ply and .stl say nothing; it is what most programs write."""


class Placement(NamedTuple):
    """T_world_file (4, 4): turns, scales and moves. assumptions: one line each."""

    T_world_file: FloatArray
    assumptions: list[str]


def placement(pieces: Sequence[Piece], options: PlacedOptions, form: Format) -> Placement:
    """How to place cleaned pieces, of which there is one at least; raises SceneError when no floor can be found."""
    triangles = triangles_of(pieces)
    storeys = [lowest_storey(triangles, axis) for axis in range(3)]
    up, told_up = _up(storeys, triangles, options, form)
    storey = storeys[AXES.index(up)]
    unit, told_unit = _unit(storey, options, form)
    walls = _walls(storey, triangles, AXES.index(up)) if options.up == "auto" else ""
    if options.floor == "auto" and (instead := _instead_of_floor(storey, unit) or walls):
        raise SceneError(
            f"no floor found: expected a level surface with {up} up ({told_up}), got {instead}; give the scene options "
            "up, unit and floor"
        )
    floor_m = storey.floor.height * unit if options.floor == "auto" and storey else float(options.floor)
    told_floor = "as given" if options.floor != "auto" or storey is None else _floor_words(storey, unit)
    T_world_file = _turn(up)
    T_world_file[:3] *= unit
    T_world_file[2, 3] = -floor_m
    moved = _to_origin(triangles, T_world_file)
    return Placement(
        T_world_file,
        [
            f"up axis: {up}, {told_up}",
            f"unit: {unit:g} m, {told_unit}",
            f"floor: at {round(floor_m, 3) + 0.0:g} m, {told_floor}",
            *moved,
        ],
    )


def placed(pieces: Sequence[Piece], T_world_file: FloatArray) -> tuple[list[Part], list[str]]:
    """The parts in the world, with floors that look up, and a line of those that were turned inside out."""
    parts = [piece.part(T_world_file) for piece in pieces]
    inverted = inside_out(parts)
    names = [part.name for part, wrong in zip(parts, inverted, strict=True) if wrong]
    turned = [
        replace(part, faces=part.faces[:, ::-1]) if wrong else part for part, wrong in zip(parts, inverted, strict=True)
    ]
    return turned, [f"turned inside out, as its floor looked down: {name!r}" for name in names]


def _up(
    storeys: Sequence[Storey | None], triangles: FloatArray, options: PlacedOptions, form: Format
) -> tuple[Literal["x", "y", "z"], str]:
    """The axis and why."""
    if options.up != "auto":
        return options.up, "as given"
    usual = [UNITS["m"]] if form.metres else [UNITS[word] for word in ("m", "cm", "mm")]
    units = Units(usual, list(UNITS.values())) if options.unit == "auto" else Units([float(options.unit)])
    own = AXES.index(form.up)
    seen = seen_up(storeys, np.ptp(triangles, axis=(0, 1)), own, units)
    if seen == own:
        return form.up, f"as {form.name} has it"
    height = 0.0 if (storey := storeys[own]) is None else storey.height
    why = f"a storey would be {height:.3g} high with {form.up} up, not {room_height(storeys[seen]):.3g}"
    up: Literal["x", "y", "z"] = ("x", "y", "z")[seen]
    return up, f"seen in the geometry ({form.name} says {form.up}, but {why})"


def _walls(storey: Storey | None, triangles: FloatArray, up: int) -> str:
    """That the scene may be walls without a floor; nothing when it may not.

    It is when nearly nothing is level, and no floor either, with `up` up; or nearly nothing with another axis up,
    unless the storeys are flat with `up` up, as of a tower.
    """
    if storey is None:
        return ""
    flat = LOW * np.ptp(triangles, axis=(0, 1)) >= room_height(storey)
    possible = [storey.ground < NO_FLOOR if k == up else not flat[k] for k in range(3)]
    axes = [AXES[k] for k in range(3) if possible[k] and level_share(triangles, k) < WALLS_ONLY]
    return f"what may be walls with {axes[0]} up" if axes else ""


def _instead_of_floor(storey: Storey | None, unit: float) -> str:
    """What there is when it is no floor, a ceiling for example; else nothing. unit: metres."""
    if storey is None or storey.ground < LEAST_COVERAGE:
        return f"{_coverage(storey):.0%} of the scene's rectangle"
    least = (LOW if storey.floor.upward < 0.0 else BARE) * storey.below
    if storey.below * unit >= LEAST_BELOW_M and storey.height <= least:
        return f"one with {storey.height * unit:.3g} m above it and {storey.below * unit:.3g} m below it"
    return ""


def _unit(storey: Storey | None, options: PlacedOptions, form: Format) -> tuple[float, str]:
    """Metres of one unit, and why."""
    if options.unit != "auto":
        return float(options.unit), "as given"
    height = storey.height if storey else 0.0
    own = [("m", (STOREY_M[0], TALLEST_OF_METRES))] if form.metres else []
    for word, (lowest, highest) in (*own, *STOREYS_OF_UNITS):
        if lowest <= height * UNITS[word] <= highest:
            what = f"{height:.2f} high" if word == "m" else f"{height:.4g} high"
            name = "" if word == "m" else f"the {UNIT_NAMES[word]}, "
            return UNITS[word], f"{name}as a storey is {what}"
    return 1.0, f"though a storey is {height:.2g} high, as no other unit fits"


def _floor_words(storey: Storey, unit: float) -> str:
    others = " and ".join(f"{height * unit:.3g}" for height in storey.others)
    also = f"; another is at {others} m: scene option floor chooses" if others else ""
    return f"a level surface of {_coverage(storey):.0%} of the rectangle{also}"


def _coverage(storey: Storey | None) -> float:
    return 0.0 if storey is None else storey.coverage


def _turn(up: Literal["x", "y", "z"]) -> FloatArray:
    """Rotation (4, 4) that brings an axis to z: y by a quarter turn about x, as for glTF, x by one about y."""
    T = np.eye(4)
    if up == "y":
        T[:3, :3] = [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
    elif up == "x":
        T[:3, :3] = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]
    return T


def _to_origin(triangles: FloatArray, T_world_file: FloatArray) -> list[str]:
    """Move a scene that is kilometres away, as with coordinates of a map, in T_world_file; what was done."""
    middle = (triangles.min(axis=(0, 1)) + triangles.max(axis=(0, 1))) / 2.0
    centre_xy = (T_world_file[:3, :3] @ middle)[:2]
    if np.abs(centre_xy).max() < FAR_M:
        return []
    T_world_file[:2, 3] = -centre_xy
    return [f"moved by ({-centre_xy[0]:.2f}, {-centre_xy[1]:.2f}) m, to the origin"]
