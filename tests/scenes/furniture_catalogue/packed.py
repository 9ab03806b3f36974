"""What the fuzzing program reads: a catalogue as it is, or one packed of the files in a folder, all its models."""

import os
import zipfile
from itertools import count

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.catalogue import read_catalogue
from slamgym.scenes.furniture_catalogue.meshes import shape_of
from slamgym.scenes.home.furniture.piece import Piece
from slamgym.scenes.house import House

FRESH = count(1)


def read_models(path, _options):
    """The models of the .sh3f file `path`, or of the folder of the list `path`, as a house of the unit boxes."""
    try:
        folder = path.parent if path.suffix == ".sh3f" else pack(path)
        for catalogue in folder.glob("*.sh3f"):
            os.utime(catalogue, ns=(1, next(FRESH)))  # as changed: what was read before is remembered
        catalogue = read_catalogue(folder)
        shapes = [shape_of(model) for model in catalogue.models]
    except SceneError as error:
        raise SceneError(f"{path.name}: {error}") from None
    if not shapes:
        raise SceneError(f"{path.name}: {catalogue.defects}")
    pieces = [Piece(f"model_{number}", shape.components) for number, shape in enumerate(shapes)]
    parts = tuple(part for piece in pieces for part in piece.parts(piece.kind))
    return House(path.name, parts, defects=catalogue.defects)


def pack(path):
    """A folder with a catalogue of all other plain files beside the list; these are not compressed."""
    folder = path.parent / "packed"
    folder.mkdir(exist_ok=True)
    with zipfile.ZipFile(folder / "all.sh3f", "w") as archive:
        for file in path.parent.iterdir():
            if file.is_file() and not file.is_symlink() and file.suffix != ".sh3f":
                archive.write(file, file.name)
    return folder
