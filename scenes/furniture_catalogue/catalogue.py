"""Catalogues of furniture in Sweet Home 3D's form: .sh3f files, zip archives of models with a properties file.

The keys are described in the user's guide of Sweet Home 3D's Furniture Library Editor; sizes are centimetres there.
"""

import math
import posixpath
from collections import defaultdict
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import javaproperties

from slamgym.errors import SceneError
from slamgym.scenes.furniture_catalogue.archive import open_archive, read_entry
from slamgym.scenes.furniture_catalogue.licences import short_name

PROPERTIES = "PluginFurnitureCatalog.properties"
MAX_PROPERTIES_BYTES = 4_000_000
MAX_SIDE_M = 100.0
MAX_WORDS = 200
_REMEMBERED = 64
"""Archives whose lists are kept."""

Rotation = tuple[float, float, float, float, float, float, float, float, float]


class Model(NamedTuple):
    """One model of a catalogue; nothing of its mesh is read yet.

    id, name, category: as in the catalogue. size_m: width, depth, height. elevation_m: of its lower side above the
    floor. drop_on_top_m: height above its lower side at which smaller things stand on it; None: nothing may.
    licence: begins with a word of LICENCES. archive, changed_ns: the .sh3f file and when it was written. path,
    mesh_bytes: the .obj file in it and its size. rotation: rows of the 3x3 matrix that turns the mesh before it is
    stretched to its size (y up, front to +z).
    """

    id: str
    name: str
    category: str
    size_m: tuple[float, float, float]
    elevation_m: float
    drop_on_top_m: float | None
    licence: str
    creator: str
    archive: Path
    changed_ns: int
    path: str
    mesh_bytes: int
    rotation: Rotation | None


class Catalogue(NamedTuple):
    """All models of a folder in the order of file and entry, and one line for each that cannot be used."""

    models: tuple[Model, ...]
    defects: tuple[str, ...]


def read_catalogue(folder: Path) -> Catalogue:
    """The models of the .sh3f files in `folder`; a broken file or entry is a defect.

    Raises SceneError where there is no such file.
    """
    paths = sorted(path for path in folder.glob("*.sh3f") if path.exists())
    if not paths:
        raise SceneError(
            f"scene sweethome: expected .sh3f files in {folder}, got none; install them with `apt install "
            "sweethome3d-furniture`, or give their folder as scene option 'catalogue'"
        )
    read = [_read_archive(path, path.stat().st_mtime_ns) for path in paths]
    return Catalogue(tuple(m for one in read for m in one.models), tuple(d for one in read for d in one.defects))


@lru_cache(maxsize=_REMEMBERED)
def _read_archive(path: Path, changed_ns: int) -> Catalogue:
    try:
        with open_archive(path) as archive:
            text = read_entry(archive, PROPERTIES, MAX_PROPERTIES_BYTES).decode("latin-1")
            sizes = {entry.filename: entry.file_size for entry in archive.infolist()}
        general, entries = _sorted_out(javaproperties.loads(text))
    except (SceneError, javaproperties.InvalidUEscapeError) as error:
        return Catalogue((), (f"catalogue {path.name} left out: {error}",))
    models, defects = [], []
    for number, entry in entries.items():
        try:
            models.append(_model({**general, **entry}, path, changed_ns, sizes))
        except (KeyError, ValueError) as error:
            defects.append(f"{path.name}: model {number[:40]!r} left out: {_why(error)}")
    return Catalogue(tuple(models), tuple(defects))


def _sorted_out(properties: Mapping[str, str]) -> tuple[dict[str, str], dict[str, dict[str, str]]]:
    """What a catalogue says of all its models (licence, provider), and of each: keys are written key#number."""
    general: dict[str, str] = {}
    entries: dict[str, dict[str, str]] = defaultdict(dict)
    for key, value in properties.items():
        word, mark, number = key.partition("#")
        if mark:
            entries[number][word] = value.strip()
        elif word == "license":
            general[word] = value
    return general, {number: entry for number, entry in entries.items() if entry.get("model")}


def _model(entry: Mapping[str, str], path: Path, changed_ns: int, sizes: Mapping[str, int]) -> Model:
    name = _inside(entry["model"])
    drop = _metres(entry.get("dropOnTopElevation", entry["height"]))
    return Model(
        id=_line(entry.get("id", name)),
        name=_line(entry["name"]),
        category=_line(entry.get("category", "")),
        size_m=(_length(entry["width"]), _length(entry["depth"]), _length(entry["height"])),
        elevation_m=max(_metres(entry.get("elevation", "0")), 0.0),
        drop_on_top_m=drop if drop > 0.0 else None,
        licence=short_name(entry.get("license", "")),
        creator=_line(entry.get("creator", "unknown")),
        archive=path,
        changed_ns=changed_ns,
        path=name,
        mesh_bytes=sizes[name],
        rotation=_rotation(entry["modelRotation"]) if "modelRotation" in entry else None,
    )


def _inside(name: str) -> str:
    """The path of an archive's entry, in its plain form; ValueError where it leaves the archive."""
    path = posixpath.normpath(name.lstrip("/"))
    if path.startswith("..") or not path.lower().endswith(".obj"):
        raise ValueError(f"expected a .obj file of the archive, got {name[:80]!r}")
    return path


def _metres(text: str) -> float:
    value = float(text) / 100.0
    if not math.isfinite(value):
        raise ValueError(f"expected a length in centimetres, got {text[:40]!r}")
    return value


def _length(text: str) -> float:
    value = _metres(text)
    if not 0.0 < value <= MAX_SIDE_M:
        raise ValueError(f"expected a size from 0 to {100 * MAX_SIDE_M:g} cm, got {text[:40]!r}")
    return value


def _rotation(text: str) -> Rotation:
    values = tuple(float(word) for word in text.split())
    if len(values) != 9 or not all(abs(value) <= 1.0 + 1e-6 for value in values):
        raise ValueError(f"expected 9 numbers of a rotation, got {text[:80]!r}")
    return values  # type: ignore[return-value]


def _line(text: str) -> str:
    return " ".join(text.split())[:MAX_WORDS]


def _why(error: Exception) -> str:
    """KeyError: a key, or the model's file, is not there."""
    return _line(
        f"expected {error.args[0]!r}, which is not there; add it" if isinstance(error, KeyError) else str(error)
    )
