"""From a house.json to a House: nodes placed, turned to z up, cleaned, and set on the floor."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.house import House, Part
from slamgym.scenes.importing.cleaning import clean, triangles_of
from slamgym.scenes.importing.data_root import DataRoot
from slamgym.scenes.importing.levels import lowest_storey
from slamgym.scenes.importing.orientation import placed
from slamgym.scenes.importing.pieces import MAX_TRIANGLES, Piece
from slamgym.scenes.suncg import SuncgOptions
from slamgym.scenes.suncg.categories import DOOR, PATH, read_categories
from slamgym.scenes.suncg.contents import lamps_of, rooms_of
from slamgym.scenes.suncg.house_file import HouseFile, Node, read_house_file
from slamgym.scenes.suncg.models import Models
from slamgym.scenes.suncg.placing import group_of, level_frame, placed_pieces
from slamgym.types import FloatArray


@np.errstate(all="ignore")  # what is not finite is cleaned away
def read_suncg(path: Path, options: SuncgOptions) -> House:
    """`Suncg.load` in this process. Raises SceneError, and MemoryError for files that ask for too much."""
    try:
        return _read(path, options)
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from None


def _read(path: Path, options: SuncgOptions) -> House:
    root = _data_root(path)
    file = read_house_file(path, options.level)
    defects = [*file.defects]
    categories = read_categories(root, defects)
    doors = {id(node) for node in file.nodes if options.doors == "open" and categories.get(node.model) == DOOR}
    nodes = [node for node in file.nodes if id(node) not in doors]
    T_level_scene = level_frame(file.frame, defects)
    models = Models(root, file.id)
    pieces = _pieces(nodes, models, T_level_scene, defects)
    floors = {group_of("floor", node) for node in nodes if node.type == "Room"}
    T_world_level, told_floor = _floor(pieces, floors)
    parts, turned = _parts(pieces, floors, T_world_level)
    defects += turned
    groups: defaultdict[str, list[Part]] = defaultdict(list)
    for part in parts:
        groups[_group(part)].append(part)
    rooms = tuple(rooms_of(nodes, T_world_level @ T_level_scene, groups, defects))
    told = (*_assumptions(file, options, len(doors), bool(categories)), told_floor, *models.assumptions)
    named = tuple(f"{path.name}: {defect}" for defect in defects)
    return House(str(path), tuple(parts), rooms, tuple(lamps_of(nodes, categories, groups)), (), told, named)


def _data_root(path: Path) -> DataRoot:
    """Three folders above house.json; raises SceneError for a file that is not in such a place."""
    folders = path.absolute().parents
    if len(folders) < 3 or folders[1].name != "house":
        raise SceneError("expected ROOT/house/ID/house.json, got another place; put it where its dataset is")
    return DataRoot(folders[2])


def _pieces(nodes: Iterable[Node], models: Models, T_level_scene: FloatArray, defects: list[str]) -> list[Piece]:
    """What the nodes show, cleaned, in the level's frame; raises SceneError when there is too much of it, or nothing.

    defects: gets a line for what is left out.
    """
    placed: list[Piece] = []
    triangles = 0
    for node in nodes:
        for piece in placed_pieces(node, models, T_level_scene, defects):
            triangles += len(piece.faces)
            if triangles > MAX_TRIANGLES:  # a small file can name a model often
                raise SceneError(f"expected at most {MAX_TRIANGLES} triangles, got more; leave models out")
            placed.append(piece)
    pieces, cleaned = clean(placed)
    defects += [*models.defects, *cleaned]
    if not pieces:
        raise SceneError(f"expected triangles, got none that can be used; {'; '.join(defects[:3]) or 'add some'}")
    return pieces


def _group(item: Piece | Part) -> str:
    return item.name.split("/")[0]


def _parts(pieces: Sequence[Piece], floors: set[str], T_world_level: FloatArray) -> tuple[list[Part], list[str]]:
    """The parts in the world, and a line of the rooms' floors that looked down: those are turned."""
    turned, told = placed([piece for piece in pieces if _group(piece) in floors], T_world_level)
    others = [piece.part(T_world_level) for piece in pieces if _group(piece) not in floors]
    return turned + others, told


def _floor(pieces: Sequence[Piece], floors: set[str]) -> tuple[FloatArray, str]:
    """T_world_level (4, 4), which brings the floor to z = 0, and how it was found; raises SceneError without one."""
    of_rooms = [piece for piece in pieces if _group(piece) in floors]
    storey = lowest_storey(triangles_of(of_rooms or pieces), axis=2)
    if storey is None:
        raise SceneError("no floor found: expected something level, got nothing; add a Room with a floor")
    T_world_level = np.eye(4)
    T_world_level[2, 3] = -storey.floor.height
    source = "of the rooms" if of_rooms else "seen in the geometry, as no room has one"
    return T_world_level, f"floor: at {round(storey.floor.height, 3) + 0.0:g} m, {source}"


def _assumptions(file: HouseFile, options: SuncgOptions, doors: int, known: bool) -> list[str]:
    up = ", ".join(f"{value:g}" for value in file.frame.up)
    told = [f"up: ({up}), unit: {file.frame.scale:g} m, as the file has them"]
    if len(file.levels) > 1:
        told.append(f"level: {options.level} of {', '.join(map(str, file.levels))}, by the scene option level")
    if doors:
        told.append(f"doors: {doors} left out, so that the robot can pass; scene option doors=kept keeps them")
    if not known:
        told.append(f"lamps and doors: not known, as the data root has no {PATH}")
    return told
