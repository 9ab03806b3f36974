"""Classes by name: those of slamgym, and those that installed packages add by entry points."""

import sys
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any

from slamgym.checked_params import Params
from slamgym.errors import ConfigError


def named_targets(registry: Mapping[str, str], group: str) -> dict[str, str]:
    """Name -> "module:class" of the registry, which goes before, and of the installed packages' entry points."""
    return {**registry, **{name: target for name, target in _installed(group, tuple(sys.path)) if name not in registry}}


@cache
def _installed(group: str, _: tuple[str, ...]) -> list[tuple[str, str]]:
    """Names and targets of entry points; looking through all packages takes a while, so once for each search path."""
    return [(entry.name, entry.value) for entry in entry_points(group=group)]


def load_class(what: str, target: str, parts: Sequence[str], protocol: str, options: type[Params]) -> type[Any]:
    """The class at "module:class", when it has the attributes `parts`, and `Options` derived from `options`.

    what: how a message begins; protocol: where it is told what such a class is. Raises ConfigError.
    """
    module, _, attribute = target.partition(":")
    try:
        found = getattr(import_module(module), attribute)
    except Exception as error:  # the module may be anybody's, and fail in any way
        why = f"{type(error).__name__}: {error}".splitlines()[0]
        raise ConfigError(
            f"{what}: expected an importable 'module:class', got {why}; install its package, or set PYTHONPATH to its "
            "folder"
        ) from error
    if missing := [part for part in parts if not hasattr(found, part)]:
        raise ConfigError(f"{what}: expected a class as {protocol}, without {missing}")
    if not (isinstance(found.Options, type) and issubclass(found.Options, options)):
        raise ConfigError(
            f"{what}: expected Options derived from {options.__module__}.{options.__name__}, got {found.Options!r}; "
            "derive it from that, which is a pydantic model"
        )
    loaded: type[Any] = found
    return loaded
