"""The base of all groups of parameters that users give: frozen, checked by pydantic, with errors of one line."""

from collections.abc import Mapping
from typing import Any, ClassVar, Self, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from slamgym.errors import ConfigError, unknown_word


class Params(BaseModel):
    """Frozen parameters that refuse unknown names; `checked` raises ConfigError in one line."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, arbitrary_types_allowed=True)

    kind: ClassVar[str] = "parameter"
    """What one of them is called in messages."""

    @classmethod
    def checked(cls, values: Mapping[str, Any]) -> Self:
        """The parameters `values`, defaults filled in; raises ConfigError that tells all that are bad."""
        try:
            return cls.model_validate(dict(values))
        except ValidationError as error:
            raise ConfigError("; ".join(cls._explain(details) for details in error.errors())) from None

    @classmethod
    def _explain(cls, details: ErrorDetails) -> str:
        name = str(details["loc"][0]) if details["loc"] else cls.__name__
        if details["type"] == "extra_forbidden":
            return unknown_word(cls.kind, name, cls.model_fields)
        if details["type"] == "literal_error" and isinstance(details["input"], str) and (words := cls._words(name)):
            return unknown_word(name, details["input"], words)
        if details["type"] == "value_error":
            return str(details["ctx"]["error"])
        problem = details["msg"].replace("Input should be", "the value should be")
        return f"{cls._label(name)}: {problem}, got {details['input']!r}"

    @classmethod
    def _label(cls, name: str) -> str:
        """How a message about a value begins."""
        return name

    @classmethod
    def _words(cls, name: str) -> list[str]:
        """What may be given where one of some words is expected; none where it is a number, or may be left out."""
        return [word for word in get_args(cls.model_fields[name].annotation) if isinstance(word, str)]
