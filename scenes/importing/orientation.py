"""Which way a scene is up, how long its unit is and where its floor is: as given, or as its geometry shows."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.house import Part
from slamgym.scenes.importing.cleaning import triangles_of
from slamgym.scenes.importing.levels import Storey, level_share, lowest_storey
from slamgym.scenes.importing.pieces import Piece
from slamgym.scenes.importing.placed_options import UNITS, PlacedOptions
from slamgym.types import FloatArray

AXES = "xyz"
SURE = 1.25
"""How much better than the format's another axis must look."""
WALLS_ONLY = 0.1
"""Share of the area that is level, below which a scene has walls and no floor."""
LEAST_COVERAGE = 0.05
LEAST_BELOW_M = 1.0
BARE = 0.1
LOW = 0.5
"""Height of a storey by what lies below it: less than BARE, it is a roof; less than LOW and seen from below, too."""
STOREY_M = (1.5, 6.5)
USUAL_STOREY_M = 2.7
TALLEST_OF_METRES = 20.0
"""What a .glb, which is in metres by its specification, may have as a hall."""
UNIT_NAMES = {"cm": "centimetre", "mm": "millimetre", "inch": "inch", "foot": "foot"}
FAR_M = 1000.0
"""From where on float32 is too coarse."""
FLOOR_M = 0.03
FLOOR_COSINE = 0.7
FLOOR_SHARE = 0.1


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
    walls = _walls(triangles, AXES.index(up)) if options.up == "auto" else ""
    if options.floor == "auto" and (instead := _instead_of_floor(storey, unit) or walls):
        raise SceneError(
            f"no floor found: expected a level surface with {up} up ({told_up}), got {instead}; give the scene options "
            "up, unit and floor"
        )
    floor_m = storey.floor.height * unit if options.floor == "auto" and storey else float(options.floor)
    told_floor = (
        "as given" if options.floor != "auto" else f"a level surface of {_coverage(storey):.0%} of the rectangle"
    )
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
    """The parts in the world, and a line of those that were turned inside out.

    A part with much of the floor is, when its floor looks down: the robot needs one that looks up.
    """
    parts = [piece.part(T_world_file) for piece in pieces]
    downs, ups = np.array([_floor_areas(part) for part in parts]).reshape(-1, 2).T
    inverted = (downs > ups) & (downs > FLOOR_SHARE * (downs + ups).sum())
    names = [part.name for part, wrong in zip(parts, inverted, strict=True) if wrong]
    turned = [_inside_out(part) if wrong else part for part, wrong in zip(parts, inverted, strict=True)]
    return turned, [f"turned inside out, as its floor looked down: {name!r}" for name in names]


def _up(
    storeys: Sequence[Storey | None], triangles: FloatArray, options: PlacedOptions, form: Format
) -> tuple[Literal["x", "y", "z"], str]:
    """The axis and why: one whose storey is low, and whose floor fills the rectangle around the scene."""
    if options.up != "auto":
        return options.up, "as given"
    extents = np.maximum(np.ptp(triangles, axis=(0, 1)), 1e-12)
    flatness = np.exp(np.log(extents).mean()) / extents
    scores = np.array([_coverage(storey) for storey in storeys]) * flatness
    best = int(scores.argmax())
    if AXES[best] != form.up and scores[best] > SURE * scores[AXES.index(form.up)]:
        seen: Literal["x", "y", "z"] = ("x", "y", "z")[best]
        return seen, f"seen in the geometry ({form.name} says {form.up})"
    return form.up, f"as {form.name} has it"


def _walls(triangles: FloatArray, up: int) -> str:
    """That the scene may be walls without a floor, with another axis than `up` up; nothing when it may not.

    It is one when nearly nothing is level then; but not one that is flat with `up` up, as a corridor or a hall is.
    """
    extents = np.ptp(triangles, axis=(0, 1))
    others = [k for k in range(3) if k != up and extents[up] > LOW * extents[k]]
    axes = [AXES[k] for k in others if level_share(triangles, k) < WALLS_ONLY]
    return f"what may be walls with {axes[0]} up" if axes else ""


def _instead_of_floor(storey: Storey | None, unit: float) -> str:
    """What there is when it is no floor, a ceiling for example; else nothing. unit: metres."""
    if storey is None or storey.coverage < LEAST_COVERAGE:
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
    tallest = TALLEST_OF_METRES if form.metres else STOREY_M[1]
    if STOREY_M[0] <= height <= tallest:
        return 1.0, f"as a storey is {height:.2f} high"
    names = {UNITS[word]: name for word, name in UNIT_NAMES.items()}
    fitting = {unit: name for unit, name in names.items() if STOREY_M[0] <= height * unit <= STOREY_M[1]}
    if not fitting:
        return 1.0, f"though a storey is {height:.2g} high, as no other unit fits"
    unit = min(fitting, key=lambda metres: abs(np.log(height * metres / USUAL_STOREY_M)))
    return unit, f"the {fitting[unit]}, as a storey is {height:.4g} high"


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


def _floor_areas(part: Part) -> tuple[float, float]:
    """Area of the part's faces at z = 0 that look down, and up."""
    triangles = part.vertices[part.faces].astype(np.float64)
    at_floor = triangles[np.abs(triangles[..., 2]).max(axis=1) < FLOOR_M]
    normals = np.cross(at_floor[:, 1] - at_floor[:, 0], at_floor[:, 2] - at_floor[:, 0]) / 2.0
    upward = normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
    return -float(normals[upward < -FLOOR_COSINE, 2].sum()), float(normals[upward > FLOOR_COSINE, 2].sum())


def _inside_out(part: Part) -> Part:
    return replace(part, faces=part.faces[:, ::-1])
