"""Scenes by name or file, and the registry of what loads them."""

import os
import sys
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from slamgym.errors import ConfigError, SceneError, SceneWarning, unknown_word
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
MOST_DIGITS = 18
OURS = ("slamgym", "gymnasium")
"""Packages whose lines a warning does not point at."""
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
    if not (Path(spec).suffix or "/" in spec or os.path.lexists(spec)):
        raise SceneError(unknown_word("scene", name, targets))
    endings: list[str] = []
    broken: list[str] = []
    for known, target in targets.items():
        try:
            loader = _load_class(known, target)
        except ConfigError as error:  # another one may read it
            broken.append(f" ({error})")
            continue
        if loader.suffixes and spec.lower().endswith(loader.suffixes):
            return SceneSource(spec, loader, _file(spec, spec), loader.Options.checked(options or {}))
        endings += loader.suffixes
    raise SceneError(
        f"scene {spec!r}: expected a file ending in one of {', '.join(endings)}; convert it to one of these"
        + "".join(broken)
    )


def load_scene(spec: str, options: Mapping[str, Any] | None = None) -> House:
    """The house that `spec` names, see `find_scene`; warns with SceneWarning of what was repaired or left out.

    Raises SceneError, and ConfigError for options.
    """
    found = find_scene(spec, options)
    house = found.loader.load(found.source, found.options)
    told = list(house.defects[:DEFECTS_TOLD])
    if (more := len(house.defects) - DEFECTS_TOLD) > 0:
        told.append(f"scene {spec!r}: {more} more defects; `slamgym scene` lists all")
    for defect in told:
        warnings.warn(defect, SceneWarning, stacklevel=_users_level())
    return house


def _seed(spec: str, name: str, seed: str) -> int:
    if not (seed.isascii() and seed.isdigit() and len(seed) <= MOST_DIGITS):
        raise SceneError(f"scene {spec!r}: expected a seed of 0 or more, got {seed!r}; write for example {name}:7")
    return int(seed)


def _file(spec: str, file: str) -> Path:
    if not file:
        raise SceneError(f"scene {spec!r}: expected a file; write for example {spec.partition(':')[0]}:FILE")
    # As Path.expanduser, which raises when there is no such user.
    path = Path(os.path.expanduser(file))  # noqa: PTH111
    try:
        there = path.is_file()
    except OSError as error:
        why = error.strerror
        raise SceneError(f"scene {spec[:80]!r}: expected a file, got a name that cannot be one ({why})") from None
    if not there:
        what = "which is not there" if not path.exists() else "a folder" if path.is_dir() else "which is no plain file"
        raise SceneError(f"scene {spec!r}: expected a file, got {str(path)!r}, {what}; check the path")
    return path


def _users_level() -> int:
    """How many calls up from the caller's the line is that asked for a scene: beyond slamgym and gymnasium."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] in OURS:
        level, frame = level + 1, frame.f_back
    return level


def _load_class(name: str, target: str) -> type[SceneLoader]:
    loader = load_class(f"scene loader {name!r}", target, PARTS, "slamgym.scenes.loader.SceneLoader", SceneOptions)
    if not isinstance(loader.suffixes, tuple):
        raise ConfigError(f"scene loader {name!r}: expected suffixes as a tuple of texts, got {loader.suffixes!r}")
    return loader
