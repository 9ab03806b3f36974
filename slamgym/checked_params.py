"""The base of all groups of parameters that users give: frozen, checked by pydantic, with errors of one line."""

from collections.abc import Mapping
from typing import Any, Self, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from slamgym.errors import ConfigError, unknown_word


class Params(BaseModel):
    """Frozen parameters that refuse unknown names; `checked` raises ConfigError in one line."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, arbitrary_types_allowed=True)

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """The parameters `values`, defaults filled in; raises ConfigError."""
        try:
            return cls.model_validate(dict(values))
        except ValidationError as error:
            raise ConfigError("; ".join(cls._explain(details) for details in error.errors())) from None

    @classmethod
    def _explain(cls, details: ErrorDetails) -> str:
        name = str(details["loc"][0]) if details["loc"] else cls.__name__
        if details["type"] == "extra_forbidden":
            return unknown_word("parameter", name, cls.model_fields)
        if details["type"] == "literal_error" and isinstance(details["input"], str):
            return unknown_word(name, details["input"], get_args(cls.model_fields[name].annotation))
        if details["type"] == "value_error":
            return str(details["ctx"]["error"])
        return f"{name}: {details['msg'].replace('Input should be', 'the value should be')}, got {details['input']!r}"
