"""The templates, filled in: all that goes into them is text, whatever it looks like."""

import base64
import hashlib
from functools import cache
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from slamgym.eval.plots import printable

STYLE, SCRIPT = "report.css", "report.js"


def filled(template: str, **values: Any) -> Markup:
    """A template of `slamgym/report/templates` with these values. Safe to be put into another one as it is."""
    # Jinja's own escaping made it so.
    return Markup(_environment().get_template(template).render(values))


def inlined() -> dict[str, str]:
    """The page's style and script, as they are, and what its security policy knows each by."""
    environment = _environment()
    texts = {"style": STYLE, "script": SCRIPT}
    sources = {name: environment.get_template(file).render() for name, file in texts.items()}
    return {
        **{name: Markup(source) for name, source in sources.items()},
        **{f"{name}_hash": _policy_hash(source) for name, source in sources.items()},
    }


def _policy_hash(source: str) -> str:
    """As in https://www.w3.org/TR/CSP3/#grammardef-hash-source."""
    return "sha256-" + base64.b64encode(hashlib.sha256(source.encode()).digest()).decode()


@cache
def _environment() -> Environment:
    return Environment(
        loader=PackageLoader("slamgym.report", "templates"),
        # By no file name's ending: everything is escaped.
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_shown,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _shown(value: Any) -> Any:
    """Control characters and marks that turn the direction of reading, from names of files, are made visible."""
    if isinstance(value, Markup) or not isinstance(value, str) or value.isprintable():
        return value
    return printable(value)
