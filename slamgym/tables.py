"""Tables of figures on the terminal."""

from collections.abc import Iterable, Mapping
from math import floor, isfinite
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.markup import escape
from rich.table import Table

PERCENT = "percent"
"""Format of a share: rounded down, so that "100.0%" means all."""


def figures_table(columns: Mapping[str, tuple[str, str]], rows: Iterable[Mapping[str, Any]]) -> Table:
    """A table with a line a row; columns: heading -> key in the rows, and the format of its values."""
    table = Table(box=SIMPLE_HEAD, padding=0)
    for heading in columns:
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*(_formatted(row[key], style) for key, style in columns.values()))
    return table


def _formatted(value: Any, style: str) -> str:
    if isinstance(value, float) and not isfinite(value):
        return "-"
    if style == PERCENT:
        return f"{floor(1e3 * value + 1e-9) / 10:.1f}%"
    return escape(style.format(value))
