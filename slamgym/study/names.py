"""What a study may vary: every parameter of the drive and of the SLAM, and the conditions that a run takes place in."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import UnionType
from typing import Any, Union, get_args, get_origin

from pydantic import Field

from slamgym.agents import AGENTS
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, unknown_word
from slamgym.params import DriveParams, SlamParams
from slamgym.slam.backend import load_backend

STUDY_AGENTS = tuple(name for name in AGENTS if name != "cautious")
"""A drive is rendered without a SLAM, from which this one would take its speed."""


class DriveConditions(Params):
    """How a drive takes place, beside its parameters."""

    agent: str = Field("follower", description="who drives")
    max_episode_steps: int | None = Field(None, ge=1, description="frames after which the drive is cut off")


class SlamConditions(Params):
    """How a SLAM run takes place, beside its parameters."""

    busy_processes: int = Field(0, ge=0, le=1024, description="processes that keep the computer busy meanwhile")


NAMES_OF_DRIVE = (DriveParams.model_fields.keys() | DriveConditions.model_fields.keys()) - {"scene"}
NAMES_OF_SLAM = SlamParams.model_fields.keys() | SlamConditions.model_fields.keys()
OPTIONS = tuple(
    name
    for params in (DriveParams, SlamParams)
    for name, info in params.model_fields.items()
    if get_origin(info.annotation) is dict
)
"""Groups of options, whose members have dotted names."""


def check_name(name: str) -> None:
    """Raise ConfigError unless it is one that may be fixed or varied."""
    root, dot, option = name.partition(".")
    if name == "scene":
        raise ConfigError("expected scenes in paths, got 'scene': every level of a factor runs on all paths")
    if root not in NAMES_OF_DRIVE | NAMES_OF_SLAM:
        raise ConfigError(unknown_word("parameter", root, NAMES_OF_DRIVE | NAMES_OF_SLAM))
    if bool(dot) != (root in OPTIONS) or bool(dot) != bool(option):
        example = f"{root}.NAME" if root in OPTIONS else root
        raise ConfigError(f"expected the name {example}, got {name!r}")


def is_of_drive(name: str) -> bool:
    """Whether it changes what is rendered."""
    return name.partition(".")[0] in NAMES_OF_DRIVE


def nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Keywords: options with dotted names in a mapping of their own.

    >>> nested({"speed": 1, "scene_options.size": "small"})
    {'speed': 1, 'scene_options': {'size': 'small'}}
    """
    keywords: dict[str, Any] = {}
    for name, value in values.items():
        root, dot, option = name.partition(".")
        if dot:
            keywords.setdefault(root, {})[option] = value
        else:
            keywords[root] = value
    return keywords


def flat(keywords: Mapping[str, Any]) -> dict[str, Any]:
    """The inverse of `nested`."""
    values: dict[str, Any] = {}
    for name, value in keywords.items():
        if name in OPTIONS and isinstance(value, Mapping):
            values |= {f"{name}.{option}": entry for option, entry in value.items()}
        else:
            values[name] = value
    return values


def takes_file(name: str, backends: Iterable[str]) -> bool:
    """Whether its value is the path of a file, as an option of one of the SLAM backends, too."""
    root, dot, option = name.partition(".")
    if not dot:
        return any(_is_path(params, name) for params in (DriveParams, SlamParams))
    return root == "slam_options" and any(_is_path(options, option) for options in _options_of(backends))


def _options_of(backends: Iterable[str]) -> Iterable[type[Params]]:
    for name in backends:
        try:
            yield load_backend(name).Options
        except ConfigError:  # told when the runs are planned
            continue


def _is_path(params: type[Params], name: str) -> bool:
    annotation = params.model_fields[name].annotation if name in params.model_fields else None
    is_union = get_origin(annotation) in (UnionType, Union)
    return annotation is Path or (is_union and Path in get_args(annotation))
