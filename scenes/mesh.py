"""Houses from mesh files: .glb, .gltf, .obj, .ply and .stl.

The geometry is cleaned, turned, scaled and moved to the floor; see `House.assumptions` and `House.defects` for what
was done. Nothing outside the file's folder is read.
"""

from dataclasses import replace
from pathlib import Path
from typing import ClassVar, cast

import numpy as np

from slamgym.errors import SceneError
from slamgym.scenes.extras import Extras, read_extras
from slamgym.scenes.house import House, Part
from slamgym.scenes.importing.placed_options import PlacedOptions
from slamgym.scenes.loader import SceneOptions

OURS = PlacedOptions(up="y", unit=1.0, floor=0.0)
"""How the files lie that slamgym writes."""


class Mesh:
    """The registry's loader of mesh files."""

    Options: ClassVar[type[SceneOptions]] = PlacedOptions
    suffixes: ClassVar[tuple[str, ...]] = (".glb", ".gltf", ".obj", ".ply", ".stl")

    @staticmethod
    def load(source: int | Path, options: SceneOptions) -> House:
        """The house of a mesh file, without light, rooms and lamps; surfaces that shine by themselves have theirs. What
        `slamgym.scenes.export.write_glb` wrote has all of them.

        The file is read by a process of its own, with bounded memory and time. Raises SceneError.
        """
        from slamgym.scenes.importing.bounded import call_bounded

        return call_bounded(str(source), read_mesh)(cast(Path, source), cast(PlacedOptions, options))


def read_mesh(path: Path, options: PlacedOptions) -> House:
    """`Mesh.load` in this process. Raises SceneError, and MemoryError for a file that asks for too much."""
    try:
        return _read(path, options)
    except SceneError as error:
        raise SceneError(f"{path}: {error}") from None


def _read(path: Path, options: PlacedOptions) -> House:
    from slamgym.scenes.importing.cleaning import clean
    from slamgym.scenes.importing.data_root import DataRoot, read_plain
    from slamgym.scenes.importing.orientation import FORMATS, placed, placement
    from slamgym.scenes.importing.reader import read_pieces

    kind = path.suffix.lower().lstrip(".")
    read = read_pieces(read_plain(path), kind, DataRoot(path.parent))
    extras, passed_over, unused = _extras(read.extras, options)
    pieces, cleaned = clean(read.pieces)
    if not pieces:
        told = "; ".join((*read.defects, *cleaned)) or "the file has none"
        raise SceneError(f"expected triangles, got none that can be used ({told}); export it again")
    T_world_file, assumptions = placement(pieces, options if extras is None else OURS, FORMATS[kind])
    parts, turned = placed(pieces, T_world_file)
    defects = tuple(f"{path.name}: {defect}" for defect in (*read.defects, *unused, *cleaned, *turned))
    house = House(str(path), tuple(parts), assumptions=(*assumptions, *read.assumptions, *passed_over), defects=defects)
    return house if extras is None else _completed(house, extras)


def _extras(given: object, options: PlacedOptions) -> tuple[Extras | None, list[str], list[str]]:
    """What can be used of a file's extras, and about what cannot an assumption or a defect."""
    try:
        extras = read_extras(given)
    except SceneError as error:
        return None, [], [f"extras: {error}; not used"]
    if extras is None or all(getattr(options, name) in ("auto", ours) for name, ours in OURS):
        return extras, [], []
    # Placed otherwise, its rooms and lamps would lie elsewhere.
    return None, ["rooms, lamps and windows of the file: not used, as up, unit or floor are given otherwise"], []


def _completed(house: House, extras: Extras) -> House:
    parts = tuple(_lit(part) for part in house.parts) if extras.baked else house.parts
    return replace(house, parts=parts, rooms=extras.rooms, lamps=extras.lamps, windows=extras.windows)


def _lit(part: Part) -> Part:
    light = np.ones(part.vertices.shape, np.float32) if part.colour is None else part.colour
    return replace(part, light=light, colour=None)
