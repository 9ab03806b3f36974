"""All that the report of two studies is written from."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass

import pandas as pd

from slamgym.report.comparison.differences import MetricChange
from slamgym.report.comparison.pairing import Pairing
from slamgym.report.comparison.settings import SettingChange
from slamgym.report.levels import title_and_unit
from slamgym.study.results import StudyResults


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """Two studies, their pairs, and how they differ in what was asked for and in what came of it.

    broken, regressed: rows of the pairs, see `.broken`.
    """

    new: StudyResults
    baseline: StudyResults
    pairing: Pairing
    settings: tuple[SettingChange, ...]
    changes: tuple[MetricChange, ...]
    broken: pd.DataFrame
    regressed: pd.DataFrame


def pair_names(pairs: pd.DataFrame, factors: Sequence[str]) -> tuple[str, ...]:
    """Paths with their levels, in words."""

    def name(row: Mapping[Hashable, str]) -> str:
        levels = ", ".join(f"{title_and_unit(factor)[0]} {row[factor]}" for factor in factors)
        return f"{row['place']} ({levels})" if levels else row["place"]

    return tuple(name(row) for row in pairs[["place", *factors]].to_dict("records"))
