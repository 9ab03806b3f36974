"""Options of the command line, made from groups of parameters."""

from collections.abc import Collection
from dataclasses import field, make_dataclass
from typing import Annotated, Any, Literal, get_args, get_origin

import tyro
from pydantic.fields import FieldInfo

from slamgym.camera import CAMERAS, PinholeCamera
from slamgym.checked_params import Params
from slamgym.errors import ConfigError, unknown_word

HELP = {
    "camera": "camera to render with, by its name",
    "scene_options": "options of the scene's loader: size clutter texture (procedural), those and catalogue licences "
    "(sweethome), up unit floor (mesh files), level doors (SUNCG)",
}
"""What is said of parameters for which the terminal takes less than Python, or that Python's documentation explains."""


def _option(name: str, info: FieldInfo) -> tuple[str, Any, Any]:
    """One option of the command line for one parameter, taken as text: the parameters check it, not the parser.

    So a bad value gets the same message from the command line as from Python.
    """
    default = info.get_default(call_default_factory=True)
    choices = get_args(info.annotation) if get_origin(info.annotation) is Literal else ("VALUE",)
    annotation: Any = str
    shown: Any = str(default)
    hint = None
    if info.annotation is PinholeCamera:
        shown, choices = "default", tuple(CAMERAS)
    elif isinstance(default, dict):
        annotation, shown, choices, hint = dict[str, str], default, ("NAME VALUE",), "(default: none)"
    elif default is None:
        annotation, shown = str | None, None
    told = tyro.conf.arg(
        help=HELP.get(name, info.description), metavar="|".join(map(str, choices)), help_behavior_hint=hint
    )
    return name, Annotated[annotation, told], field(default_factory=lambda: shown)


def option_group(params: type[Params], names: Collection[str] | None = None, heading: str | None = None) -> Any:
    """A class of options for the parameters of these names; None: for all. heading: None: the parameters' own.

    Raises ConfigError for a name that is none of theirs.
    """
    fields = params.model_fields
    for name in names or ():
        if name not in fields:
            raise ConfigError(unknown_word("parameter", name, fields))
    options = [_option(name, info) for name, info in fields.items() if names is None or name in names]
    return make_dataclass(params.__name__, options, namespace={"__doc__": heading or params.__doc__}, kw_only=True)
