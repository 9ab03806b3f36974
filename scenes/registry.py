"""Scenes by name."""

from collections.abc import Callable
from importlib import import_module
from typing import cast

from slamgym.errors import SceneError, unknown_word
from slamgym.scenes.house import House

SCENES: dict[str, str] = {
    "procedural": "slamgym.scenes.procedural:procedural_house",
}
"""Name -> "module:function" that makes a house of a seed."""


def check_scene(spec: str) -> tuple[str, int]:
    """The registered name and the seed of `name` or `name:SEED`; the seed is 0 unless given.

    Raises SceneError for an unknown name or a malformed seed.
    """
    name, colon, seed = spec.partition(":")
    if name not in SCENES:
        raise SceneError(unknown_word("scene", name, SCENES))
    if colon and not (seed.isascii() and seed.isdigit()):
        raise SceneError(f"scene {spec!r}: expected a seed of 0 or more, got {seed!r}; write for example {name}:7")
    return name, int(seed or "0")


def load_scene(spec: str) -> House:
    """The house that `spec` names; raises SceneError as `check_scene` does."""
    name, seed = check_scene(spec)
    module, function = SCENES[name].split(":")
    make = cast(Callable[[int], House], getattr(import_module(module), function))
    return make(seed)
