"""What was varied in a study, with names for people: factors, their units, their levels in order."""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd

from slamgym.eval.plots import printable
from slamgym.study.results import StudyResults
from slamgym.study.table import was_run
from slamgym.types import FloatArray, IntArray

NAMES = {
    "speed": ("speed", "m/s"),
    "turn_rate": ("turn rate", "rad/s"),
    "stride": ("stride", "frames left out"),
    "fps": ("frame rate", "frames/s"),
    "rgb_noise": ("image noise", "grey levels"),
    "motion_blur": ("exposure", "of the frame's time"),
    "multisampling": ("multisampling", "samples"),
    "slam": ("SLAM", ""),
    "slam_sync": ("feeding", ""),
    "loop_closure": ("loop closing", ""),
    "brightness": ("brightness", "times"),
    "lighting": ("light", ""),
}
"""Parameter -> what people call it, and its unit."""

UNITS = {"_m": "m", "_s": "s", "_mb": "MB", "_deg": "degrees"}
"""How the names of other parameters end, and what that says of their unit."""

SI_UNITS = frozenset({"m/s", "rad/s", "frames/s", "m", "s", "MB", "degrees"})
"""Units that are written after a number; of others, the factor is named before it: "stride 2"."""

MOST_SHOWN = 6


@dataclass(frozen=True, slots=True, eq=False)
class Factor:
    """One parameter that was varied, or several that changed together.

    names: columns of the runs' table. title, unit: for people; unit "" for none. levels: their names, in order. values:
    numbers of the levels (L,), increasing; empty where they are not all numbers.
    """

    names: tuple[str, ...]
    title: str
    unit: str
    levels: tuple[str, ...]
    values: FloatArray

    @property
    def column(self) -> str:
        """The column of level names that `with_levels` adds."""
        return "level of " + ", ".join(self.names)

    @property
    def slug(self) -> str:
        """For names of files."""
        return re.sub(r"[^A-Za-z0-9]+", "_", "_".join(self.names)).strip("_")

    @property
    def label(self) -> str:
        """For axes and headings: "speed (m/s)"."""
        return f"{self.title} ({self.unit})" if self.unit else self.title

    @property
    def is_numeric(self) -> bool:
        return len(self.values) > 0

    @property
    def shown(self) -> tuple[str, ...]:
        """The levels, or MOST_SHOWN of them from the first to the last: more cannot be told apart in a picture."""
        chosen = np.unique(np.linspace(0, len(self.levels) - 1, MOST_SHOWN).astype(int))
        return tuple(self.levels[i] for i in chosen)

    def at(self, level: str) -> str:
        """A level as a condition: "at 0.8 m/s", "with stride 2"."""
        told = self.told(level)
        return f"with {told}" if told.startswith(self.title) else f"at {told}"

    def told(self, level: str) -> str:
        """A level in a sentence: "0.8 m/s", "stride 2", "loop closing on"."""
        return f"{level} {self.unit}" if self.unit in SI_UNITS and _is_number(level) else f"{self.title} {level}"


def title_and_unit(name: str) -> tuple[str, str]:
    """What people call a parameter, and its unit or "": ("camera height", "m")."""
    if name in NAMES:
        return NAMES[name]
    last = name.rpartition(".")[2]
    ending = next((end for end in UNITS if last.endswith(end)), "")
    return printable(last.removesuffix(ending).replace("_", " ")), UNITS.get(ending, "")


def level_name(value: Any) -> str:
    """A level for people: "on" and "off" for truth values, "default" for None, numbers as short as they can be."""
    if value is None or value is pd.NA or value in ("None", "nan", "") or value != value:
        return "default"
    if isinstance(value, (bool, np.bool_)) or value in ("True", "False"):
        return "on" if str(value) == "True" else "off"
    if isinstance(value, (int, float, np.number)):
        return f"{float(value):.12g}"
    return printable(value if isinstance(value, str) else json.dumps(value, default=str))


def study_factors(results: StudyResults) -> tuple[Factor, ...]:
    """The factors that have two levels or more among the runs that were not `not_run`."""
    runs = results.runs
    # Of an unfinished study the rows may happen to change two factors together that the others will tell apart.
    is_finished = len(runs) >= results.planned
    tied = tied_names(runs, results.factors) if is_finished else [[name] for name in results.factors]
    return find_factors(runs[was_run(runs)], results.factors, tied)


def find_factors(
    table: pd.DataFrame, names: Sequence[str], tied: Sequence[Sequence[str]] | None = None
) -> tuple[Factor, ...]:
    """The factors that have two levels or more in the table; those whose levels always change together are one.

    tied: the groups of names that do, as other rows tell; those of `tied_names` of the table unless given.
    """
    groups = tied_names(table, names) if tied is None else tied
    coded = {name: _coded(table[name]) for name in names if name in table}
    varied = {name: codes for name, (codes, levels) in coded.items() if len(levels) > 1}
    kept = ([name for name in group if name in varied] for group in groups)
    return tuple(_factor(group, varied, coded) for group in kept if group)


def tied_names(table: pd.DataFrame, names: Sequence[str]) -> list[list[str]]:
    """Groups of the names that are varied in the table: in one group, the level of one always tells that of another."""
    codes = {name: _coded(table[name])[0] for name in names if name in table and len(table)}
    return _tied({name: levels for name, levels in codes.items() if levels.max() > 0})


def with_levels(table: pd.DataFrame, factors: Iterable[Factor]) -> pd.DataFrame:
    """The table with a column of level names, ordered categories, for each factor."""
    columns = {}
    for factor in factors:
        codes = _joint_codes([_coded(table[name])[0] for name in factor.names])[0]
        columns[factor.column] = pd.Categorical.from_codes(codes, pd.Index(factor.levels), ordered=True)
    return with_columns(table, columns)


def with_columns(table: pd.DataFrame, columns: Mapping[str, Any]) -> pd.DataFrame:
    """The table with these columns, new or instead of its own, at once: one by one is slow where there are many."""
    kept = table.drop(columns=[name for name in columns if name in table])
    return pd.concat([kept, pd.DataFrame(dict(columns), index=table.index)], axis=1)


def _coded(column: "pd.Series[Any]") -> tuple[IntArray, list[Any]]:
    """For each row the number of its level, and the levels: default, off, on, numbers by size, words as they come."""
    hashable = column if column.dtype != object else column.map(_hashable)
    codes, values = pd.factorize(hashable, use_na_sentinel=False)
    order = sorted(range(len(values)), key=lambda i: _rank(values[i]))
    return np.argsort(order)[codes], [values[i] for i in order]


def _hashable(value: Any) -> Any:
    return level_name(value) if isinstance(value, (list, dict, np.ndarray)) else value


def _rank(value: Any) -> tuple[int, float]:
    name = level_name(value)
    fixed = {"default": 0, "off": 1, "on": 2}
    return (fixed[name], 0.0) if name in fixed else (3, float(name)) if _is_number(name) else (4, 0.0)


def _is_number(name: str) -> bool:
    try:
        return bool(np.isfinite(float(name)))
    except ValueError:
        return False


def _tied(varied: dict[str, IntArray]) -> list[list[str]]:
    """Groups of the names: two are in one group when the level of one always tells that of the other."""
    groups = {name: [name] for name in varied}
    for a, b in combinations(varied, 2):
        together = len(np.unique(varied[a] * (varied[b].max() + 1) + varied[b]))
        if together == max(varied[a].max(), varied[b].max()) + 1 and groups[a] is not groups[b]:
            groups[a].extend(groups[b])
            groups.update(dict.fromkeys(groups[b], groups[a]))
    return list({id(group): group for group in groups.values()}.values())


def _joint_codes(codes: Sequence[IntArray]) -> tuple[IntArray, IntArray]:
    """For each row the number of its combination, and the combinations (L, names) in order."""
    rows, joint = np.unique(np.stack(codes, axis=1), axis=0, return_inverse=True)
    return joint.ravel().astype(np.int64), rows


def _factor(group: list[str], varied: dict[str, IntArray], coded: dict[str, tuple[IntArray, list[Any]]]) -> Factor:
    _, rows = _joint_codes([varied[name] for name in group])
    parts = [[level_name(coded[name][1][k]) for k in column] for name, column in zip(group, rows.T, strict=True)]
    title, unit = title_and_unit(group[0])
    numbers = parts[0] if all(map(_is_number, parts[0])) and len(set(parts[0])) == len(rows) else []
    others = [title_and_unit(name)[0] for name in group[1:]]
    return Factor(
        names=tuple(group),
        title=f"{title} with {' and '.join(others)}" if others else title,
        unit=unit,
        levels=tuple(_unique([", ".join(level) for level in zip(*parts, strict=True)])),
        values=np.array(numbers, dtype=np.float64),
    )


def _unique(names: list[str]) -> list[str]:
    return [name if names.index(name) == i else f"{name} #{i + 1}" for i, name in enumerate(names)]
