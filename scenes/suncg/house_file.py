"""house.json, as the toolbox of SUNCG's authors reads it; bounded, and checked node by node."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import read_plain

MAX_JSON_BYTES = 64 << 20
MAX_NODES = 20_000
VERSION = "suncg@1.0.0"
LONGEST = 60

Text = Annotated[str, Field(max_length=200, pattern=r"^[ -~]*$")]
Vector = Annotated[tuple[FiniteFloat, ...], Field(min_length=3, max_length=3)]
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
ESSENTIAL = ("type", "modelId", "transform", "dimensions", "state")
"""A node is left out when one of these is bad; others fall back to their defaults."""


def _affine(matrix: tuple[float, ...]) -> tuple[float, ...]:
    if max(abs(a - b) for a, b in zip(matrix[3::4], IDENTITY[3::4], strict=True)) > 1e-6:
        raise ValueError("The last row should be 0, 0, 0, 1")
    return matrix


Matrix = Annotated[tuple[FiniteFloat, ...], Field(min_length=16, max_length=16), AfterValidator(_affine)]


class _Strict(BaseModel):
    model_config = ConfigDict(frozen=True, coerce_numbers_to_str=True)


class Frame(_Strict):
    """Directions in the file's frame, and metres of one unit."""

    up: Vector = (0.0, 1.0, 0.0)
    front: Vector = (0.0, 0.0, 1.0)
    scale: Annotated[FiniteFloat, Field(gt=0.0)] = Field(1.0, alias="scaleToMeters")


class Override(_Strict):
    """What replaces a part of a model's material. diffuse: as "#a0522d". texture: a file's name without its suffix."""

    diffuse: Text | None = None
    texture: Text | None = None


class Box(_Strict):
    """Opposite corners in the file's frame and unit."""

    low: Vector = Field(alias="min")
    high: Vector = Field(alias="max")


class Node(_Strict):
    """Something in a house. transform: T_scene_model, by columns. materials: by the places of the model's in its .mtl.

    state: whether a model has its other form, such as an open cupboard.
    """

    type: Literal["Room", "Object", "Ground", "Box"]
    id: Text = ""
    model: Text = Field("", alias="modelId")
    transform: Matrix = IDENTITY
    dimensions: Vector = (1.0, 1.0, 1.0)
    state: bool = False
    mirrored: bool = Field(False, alias="isMirrored")
    materials: tuple[Override, ...] = ()
    bbox: Box | None = None
    room_types: tuple[Text, ...] = Field((), alias="roomTypes")
    hide_floor: bool = Field(False, alias="hideFloor")
    hide_walls: bool = Field(False, alias="hideWalls")
    hide_ceiling: bool = Field(False, alias="hideCeiling")


class HouseFile(NamedTuple):
    """One level of a house.json. levels: all that it has. defects: each names a node."""

    id: str
    frame: Frame
    levels: tuple[int, ...]
    nodes: tuple[Node, ...]
    defects: tuple[str, ...]


def read_house_file(path: Path, level: int) -> HouseFile:
    """A level, the first being 0; nodes that are not `valid` are passed over, as they are meant to be.

    Raises SceneError for a file that is no house, and for a level that it does not have.
    """
    house = _parsed(path)
    levels = _levels(house)
    if level not in levels:
        known = ", ".join(map(str, levels))[:LONGEST] or "in a file that has some"
        raise SceneError(f"expected level {known}, got {level}; choose it by the scene option level")
    if len(levels[level]) > MAX_NODES:
        raise SceneError(f"expected at most {MAX_NODES} nodes, got {len(levels[level])}; split the house")
    defects: list[str] = []
    frame = _checked(Frame, house, "the house", (), defects) or Frame()
    nodes = [node for number, raw in enumerate(levels[level]) if (node := _node(number, raw, defects))]
    house_id = house.get("id")
    known_id = house_id if isinstance(house_id, str) and house_id else path.absolute().parent.name
    return HouseFile(known_id, frame, tuple(levels), tuple(nodes), tuple(defects))


def _parsed(path: Path) -> dict[str, Any]:
    data = read_plain(path)
    if len(data) > MAX_JSON_BYTES:
        raise SceneError(f"expected at most {MAX_JSON_BYTES} bytes, got {len(data)}; split the house")
    try:
        house = json.loads(data)
    except (ValueError, RecursionError) as error:
        why = " ".join(str(error).split())[:100]
        raise SceneError(f"expected JSON, got something broken ({why}); copy or export it again") from None
    if not isinstance(house, dict):
        raise SceneError(f"expected a JSON object, got {_short(house)}; give a house.json of SUNCG")
    if (house.get("version") or VERSION) != VERSION:
        raise SceneError(f"expected version {VERSION!r}, got {_short(house['version'])}; convert the file")
    return house


def _levels(house: Mapping[str, Any]) -> dict[int, list[Any]]:
    """The nodes of each level that is valid and has some, by its place in the file."""
    levels = house.get("levels")
    if not isinstance(levels, list):
        raise SceneError(f"expected a list of levels, got {_short(levels)}; give a house.json of SUNCG")
    usable = {number: level for number, level in enumerate(levels) if isinstance(level, dict) and _is_valid(level)}
    nodes = {number: level.get("nodes") for number, level in usable.items()}
    return {number: found for number, found in nodes.items() if isinstance(found, list) and found}


def _is_valid(item: Mapping[str, Any]) -> bool:
    return item.get("valid") not in (0, "0")  # False, too, is equal to 0


def _node(number: int, raw: object, defects: list[str]) -> Node | None:
    if not isinstance(raw, dict):
        defects.append(f"node {number}: expected a JSON object, got {_short(raw)}; it is left out")
        return None
    if not _is_valid(raw):
        return None
    label = f"node {_short(raw.get('id', number))}".replace("'", "")
    return _checked(Node, {"id": number, **raw}, label, ESSENTIAL, defects)


M = TypeVar("M", bound=_Strict)


def _checked(
    kind: type[M], raw: Mapping[str, Any], label: str, essential: tuple[str, ...], defects: list[str]
) -> M | None:
    """The checked values; without those that are bad, which are told; None when one of them is essential."""
    given = {name: value for name, value in raw.items() if value is not None}
    try:
        return kind.model_validate(given)
    except ValidationError as error:
        problems = {str(problem["loc"][0]): problem for problem in reversed(error.errors())}  # the first of each
    for name, problem in problems.items():
        end = "it is left out" if name in essential else f"its {name} is not used"
        defects.append(f"{label}: {name}: {problem['msg']}, got {_short(problem['input'])}; {end}")
    if not problems.keys().isdisjoint(essential):
        return None
    return kind.model_validate({name: value for name, value in given.items() if name not in problems})


def _short(value: object) -> str:
    """A value for a message. Lists may be long and nested deeply: only their length is told."""
    if isinstance(value, (list, dict)):
        return f"a {type(value).__name__} of {len(value)}"
    text = ascii(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
