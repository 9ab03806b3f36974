"""Scenes by name or file, and the registry of what loads them."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from slamgym.errors import SceneError, SceneWarning, unknown_word
from slamgym.plugins import load_class, named_targets
from slamgym.scenes.house import House
from slamgym.scenes.loader import SceneLoader, SceneOptions

SCENES: dict[str, str] = {
    "mesh": "slamgym.scenes.mesh:Mesh",
    "procedural": "slamgym.scenes.procedural:Procedural",
    "suncg": "slamgym.scenes.suncg:Suncg",
    "sweethome": "slamgym.scenes.sweethome:SweetHome",
}
"""Name -> "module:class" of a loader. A new one is one file and one line here."""

ENTRY_POINTS = "slamgym.scenes"
"""Group of entry points by which installed packages add loaders of theirs."""

PARTS = ("Options", "suffixes", "load")
DEFECTS_TOLD = 5
"""Warnings about one scene, before the rest is only counted."""


@dataclass(frozen=True, slots=True)
class SceneSource:
    """What a scene is loaded from: the loader, and the seed or the file that it takes. name: as the user gave it."""

    name: str
    loader: type[SceneLoader]
    source: int | Path
    options: SceneOptions


def find_scene(spec: str, options: Mapping[str, Any] | None = None) -> SceneSource:
    """What `spec` stands for: a loader's name, with ":SEED" or ":FILE", or a file whose ending tells the loader.

    options: of that loader. Nothing is loaded yet. Raises SceneError for an unknown name, a malformed seed or a missing
    file, ConfigError for options that the loader does not take.
    """
    targets = named_targets(SCENES, ENTRY_POINTS)
    name, colon, rest = spec.partition(":")
    if name in targets:
        loader = _load_class(name, targets[name])
        source = _file(spec, rest) if loader.suffixes else _seed(spec, name, rest if colon else "0")
        return SceneSource(spec, loader, source, loader.Options.checked(options or {}))
    endings: list[str] = []
    for known, target in targets.items():
        loader = _load_class(known, target)
        if loader.suffixes and spec.lower().endswith(loader.suffixes):
            return SceneSource(spec, loader, _file(spec, spec), loader.Options.checked(options or {}))
        endings += loader.suffixes
    if Path(spec).suffix or "/" in spec:
        raise SceneError(
            f"scene {spec!r}: expected a file ending in one of {', '.join(endings)}; convert it to one of these"
        )
    raise SceneError(unknown_word("scene", name, targets))


def load_scene(spec: str, options: Mapping[str, Any] | None = None) -> House:
    """The house that `spec` names, see `find_scene`; warns with SceneWarning of what was repaired or left out.

    Raises SceneError, and ConfigError for options.
    """
    found = find_scene(spec, options)
    house = found.loader.load(found.source, found.options)
    for defect in house.defects[:DEFECTS_TOLD]:
        warnings.warn(defect, SceneWarning, stacklevel=2)
    if (more := len(house.defects) - DEFECTS_TOLD) > 0:
        warnings.warn(f"scene {spec!r}: {more} more defects; `slamgym scene` lists all", SceneWarning, stacklevel=2)
    return house


def _seed(spec: str, name: str, seed: str) -> int:
    if not (seed.isascii() and seed.isdigit()):
        raise SceneError(f"scene {spec!r}: expected a seed of 0 or more, got {seed!r}; write for example {name}:7")
    return int(seed)


def _file(spec: str, file: str) -> Path:
    path = Path(file).expanduser()
    if not path.is_file():
        raise SceneError(f"scene {spec!r}: expected a file, got {str(path)!r}, which is not there; check the path")
    return path


def _load_class(name: str, target: str) -> type[SceneLoader]:
    return load_class(f"scene loader {name!r}", target, PARTS, "slamgym.scenes.loader.SceneLoader", SceneOptions)
