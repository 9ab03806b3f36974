"""Combinations of parameters, checked and written as the ids of what is planned and as the runs need them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from slamgym.agents import AGENTS
from slamgym.camera import PinholeCamera
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, SlamgymError, unknown_word
from slamgym.params import DriveParams, SlamParams
from slamgym.scenes.registry import SceneSource
from slamgym.slam.backend import check_config
from slamgym.study.names import STUDY_AGENTS, DriveConditions, SlamConditions, nested
from slamgym.study.spec import StudySpec
from slamgym.study.yaml_file import Place

Values = Mapping[str, Any]
Setting = TypeVar("Setting")


@dataclass(frozen=True, slots=True, eq=False)
class DriveSetting:
    """How the robot drives through a scene, whichever the path.

    values: as they were understood, by dotted names. depends_on: all that decides what is rendered, but for the seed.
    """

    values: dict[str, Any]
    depends_on: dict[str, Any]
    params: DriveParams
    conditions: DriveConditions
    source: SceneSource


@dataclass(frozen=True, slots=True, eq=False)
class SlamSetting:
    """How a SLAM runs over a drive. values, depends_on: as those of `DriveSetting`."""

    values: dict[str, Any]
    depends_on: dict[str, Any]
    params: SlamParams
    conditions: SlamConditions


def keywords(setting: DriveSetting | SlamSetting) -> dict[str, Any]:
    """The parameters that were given, without the conditions, as `DriveParams` and `SlamParams` take them."""
    conditions = type(setting.conditions).model_fields
    return nested({name: value for name, value in setting.values.items() if name not in conditions})


def drive_setting(scene: str, values: Values) -> DriveSetting:
    """Parameters and conditions of a drive, by dotted names, in one scene. Raises ConfigError and SceneError."""
    conditions, rest = _split(DriveConditions, values)
    if conditions.agent in AGENTS.keys() - set(STUDY_AGENTS):
        valid = ", ".join(STUDY_AGENTS)
        raise ConfigError(
            f"agent: expected one that drives without a SLAM, one of {valid}, got {conditions.agent!r}; a study "
            "renders each drive once for all SLAMs"
        )
    if conditions.agent not in STUDY_AGENTS:
        raise ConfigError(unknown_word("agent", conditions.agent, STUDY_AGENTS))
    params = DriveParams.checked({"scene": scene, **rest})
    source = params.scene_source()
    understood = {**_by_name(params), **_by_name(conditions), **_by_name(source.options, "scene_options")}
    depends_on = {
        **_told(params, "scene_options"),
        **_told(conditions),
        "scene": scene,
        "scene_options": _told(source.options),
    }
    return DriveSetting(_taken(values, understood), depends_on, params, conditions, source)


def slam_setting(values: Values, camera: PinholeCamera, fps: float) -> SlamSetting:
    """Parameters and conditions of a SLAM run, by dotted names, for frames of a camera that takes `fps` a second.

    Raises ConfigError and SlamError.
    """
    conditions, rest = _split(SlamConditions, values)
    params = SlamParams.checked(rest)
    config = params.config(camera, fps)
    options = check_config(params.slam, config).Options.checked(config.options)
    understood = {**_by_name(params), **_by_name(conditions), **_by_name(options, "slam_options")}
    depends_on = {
        **_told(params, "slam_options"),
        **_told(conditions),
        "slam": params.slam,
        "slam_options": _told(options),
    }
    return SlamSetting(_taken(values, understood), depends_on, params, conditions)


def checked(spec: StudySpec, values: Values, check: Callable[[Values], Setting], else_at: Place) -> Setting:
    """What `check` makes of the values; its errors with the line of the value that is to blame, or of `else_at`."""
    try:
        return check(values)
    except SlamgymError as error:
        message = str(error)
        blamed = (name for name in values if _failure(values, name, check) != message)
        place = next(map(spec.place_of, blamed), else_at)
        raise spec.error(message, *place) from None


def _failure(values: Values, left_out: str, check: Callable[[Values], Any]) -> str | None:
    """What is wrong with all other values; None when nothing is."""
    try:
        check({name: value for name, value in values.items() if name != left_out})
    except SlamgymError as error:
        return str(error)
    return None


def _split(kind: type[Any], values: Values) -> tuple[Any, dict[str, Any]]:
    """The conditions among the values, checked, and the other values as keywords."""
    own = {name: value for name, value in values.items() if name in kind.model_fields}
    return kind.checked(own), nested({name: value for name, value in values.items() if name not in own})


def _by_name(params: Params, group: str = "") -> dict[str, Any]:
    prefix = f"{group}." if group else ""
    return {f"{prefix}{name}": getattr(params, name) for name in type(params).model_fields}


def _told(params: Params, *but: str) -> dict[str, Any]:
    """Values other than the defaults: a new parameter, or a default that is written out, changes no id."""
    return params.model_dump(exclude_defaults=True, exclude=set(but))


def _taken(values: Values, understood: Values) -> dict[str, Any]:
    """The values given, as they were understood where that is one of YAML's, else as given: a camera by its name."""
    return {
        name: understood[name] if isinstance(understood[name], bool | int | float | str | None) else value
        for name, value in values.items()
    }
