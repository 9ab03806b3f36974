"""The report's tables: csv with the values as they are; tex, md and the page's with what people read."""

import math
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import pandas as pd

from slamgym.eval.plots import printable
from slamgym.files import write_atomically
from slamgym.report.content import DataTable
from slamgym.report.page.file_names import file_stem

NOTHING = "-"
"""For a value that cannot be told."""
KINDS = ("csv", "tex", "md")
PAGE_ROWS = 200
"""Rows that the page shows; the files have all."""


@dataclass(frozen=True, slots=True, eq=False)
class PageTable:
    """numeric: whether each column holds numbers, which are right-aligned. csv: the file that has the other rows."""

    title: str
    caption: str
    headings: tuple[str, ...]
    numeric: tuple[bool, ...]
    rows: tuple[tuple[str, ...], ...]
    rows_in_all: int
    csv: str


def table_files(table: DataTable) -> list[str]:
    return [f"tables/{file_stem(table.name)}.{kind}" for kind in KINDS]


def write_table(table: DataTable, folder: Path) -> PageTable:
    """Write the table's files below `folder`, and give it for the page. Raises OutputError."""
    shown, numeric = shown_values(table), numeric_columns(table.frame)
    csv, tex, md = (folder / name for name in table_files(table))
    write_atomically(csv, table.frame.to_csv(index=False))
    write_atomically(tex, latex(shown, numeric))
    write_atomically(md, markdown(shown, numeric))
    rows = tuple(shown.head(PAGE_ROWS).itertuples(index=False, name=None))
    return PageTable(
        table.title, table.caption, tuple(map(str, shown.columns)), numeric, rows, len(shown), f"tables/{csv.name}"
    )


def shown_values(table: DataTable) -> pd.DataFrame:
    """All values as text, in one line each."""
    columns = [
        [shown_value(value, table.formats.get(name)) for value in table.frame[name]] for name in table.frame.columns
    ]
    headings = [printable(str(name)) for name in table.frame.columns]
    return pd.DataFrame(dict(enumerate(columns)), dtype=object).set_axis(headings, axis="columns")


def shown_value(value: Any, style: str | None = None) -> str:
    """A value as text; what is missing, or not finite, is a dash."""
    if value is None or value is pd.NA or (isinstance(value, float) and not math.isfinite(value)):
        return NOTHING
    if isinstance(value, float) and style is None:
        style = "{:.4g}"
    return printable(str(value) if style is None else style.format(value))


def numeric_columns(frame: pd.DataFrame) -> tuple[bool, ...]:
    """Whether each column holds numbers only, beside what is missing."""
    return tuple(pd.api.types.infer_dtype(frame[name], skipna=True) in _NUMBERS for name in frame.columns)


_NUMBERS = {"integer", "floating", "mixed-integer-float", "decimal"}


def latex(shown: pd.DataFrame, numeric: tuple[bool, ...]) -> str:
    r"""A `tabular` for a document with \usepackage{booktabs}."""
    text = shown.to_latex(index=False, escape=True, column_format="".join("r" if number else "l" for number in numeric))
    return str(text)


def markdown(shown: pd.DataFrame, numeric: tuple[bool, ...]) -> str:
    """A table as GitHub has it."""
    ruler = ["---:" if number else ":---" for number in numeric]
    rows = [_cells(shown.columns), ruler, *(_cells(row) for row in shown.itertuples(index=False, name=None))]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _cells(values: Any) -> list[str]:
    return [_markdown_text(str(value)) for value in values]


def _markdown_text(text: str) -> str:
    """Every sign that Markdown or HTML would obey is escaped; underscores within a word are obeyed by neither."""
    for sign in "\\`*|[]":
        text = text.replace(sign, f"\\{sign}")
    return escape(text, quote=False)
