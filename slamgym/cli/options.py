"""Options of the command line, made from groups of parameters."""

from collections.abc import Collection
from dataclasses import field, make_dataclass
from typing import Annotated, Any, Literal, get_args, get_origin

import tyro
from pydantic.fields import FieldInfo

from slamgym.checked_params import Params


def _option(name: str, info: FieldInfo) -> tuple[str, Any, Any]:
    """One option of the command line for one parameter, taken as text: the parameters check it, not the parser.

    So a bad value gets the same message from the command line as from Python.
    """
    default = info.get_default(call_default_factory=True)
    choices = get_args(info.annotation) if get_origin(info.annotation) is Literal else ("VALUE",)
    annotation: Any = str
    shown: Any = str(default)
    if name == "camera":
        shown = "default"
    elif isinstance(default, dict):
        annotation, shown, choices = dict[str, str], default, ("NAME VALUE",)
    elif default is None:
        annotation, shown = str | None, None
    help_text = tyro.conf.arg(help=info.description, metavar="|".join(map(str, choices)))
    return name, Annotated[annotation, help_text], field(default_factory=lambda: shown)


def option_group(params: type[Params], names: Collection[str] | None = None) -> Any:
    """A class of options for the parameters of these names; None: for all."""
    fields = params.model_fields.items()
    options = [_option(name, info) for name, info in fields if names is None or name in names]
    return make_dataclass(params.__name__, options, namespace={"__doc__": params.__doc__}, kw_only=True)
