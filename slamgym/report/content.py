"""What a report says, whatever it is written as: sentences, figures and tables in sections."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd
from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """name: of its files in `figures/`. draw: makes the figure. caption: a sentence or two that say how to read it."""

    name: str
    title: str
    caption: str
    draw: Callable[[], Figure]


@dataclass(frozen=True, slots=True, eq=False)
class DataTable:
    """name: of its files in `tables/`. frame: its columns are headings for people, units included, and it has no index
    of interest. formats: column -> how its values are written, as "{:.3f}"; a value that is not finite is a dash.
    """

    name: str
    title: str
    caption: str
    frame: pd.DataFrame
    formats: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class Section:
    """Sentences, then tables and pictures. anchor: what a link to it ends with."""

    anchor: str
    title: str
    sentences: tuple[str, ...] = ()
    tables: tuple[DataTable, ...] = ()
    pictures: tuple[Picture, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class ReportContent:
    """title: the study's. facts: what was run, label -> value. headlines: what the data say, the most important first.
    notices: what a reader must know before these, such as that the study is not finished.

    All text is plain, with names of files in it as they are; who writes the page escapes it.
    """

    title: str
    description: str
    facts: Mapping[str, Any]
    headlines: tuple[str, ...]
    sections: tuple[Section, ...]
    notices: tuple[str, ...] = ()
