"""What differs between two studies in what was asked for: parameters, and versions of what the results depend on."""

from typing import NamedTuple

import pandas as pd

from slamgym.params import SlamParams
from slamgym.report.comparison.pairing import DRIVE_NAMES, level_order, some_of
from slamgym.report.levels import level_name

CONDITIONS = ("busy_processes", "fps")
COMPUTER = "timing.computer"
PREFIX = "run."
VERSIONS = "versions."
HOUSE = "run.versions.house_sha256"
DRIVEN_BY = ("run.agent", "run.reset_options.")
"""How the names of columns begin that tell who drove, and where."""
NOT_TOLD = "not told"


class SettingChange(NamedTuple):
    """A parameter or a version, and its values in both studies, in words. of_drive: whether it changes the drive."""

    name: str
    baseline: str
    new: str
    of_drive: bool

    def __str__(self) -> str:
        return f"{self.name}: {self.baseline} -> {self.new}"


def setting_changes(new: pd.DataFrame, baseline: pd.DataFrame) -> tuple[SettingChange, ...]:
    """What differs between the runs of two studies, as they are in a `Pairing`: parameters first."""
    names = [name for name in dict.fromkeys([*new, *baseline]) if _is_setting(name)]
    values = {name: (_values(baseline, name), _values(new, name)) for name in names}
    changes = [_change(name, before, now) for name, (before, now) in values.items() if before != now]
    return tuple(sorted(changes, key=lambda change: (change.name.startswith(VERSIONS), change.of_drive)))


def _is_setting(name: str) -> bool:
    root = name.split(".")[0]
    known = root in DRIVE_NAMES or root in SlamParams.model_fields or root in CONDITIONS
    # The scene belongs to the path; where paths differ, runs have no partners. An agent is told by "run.agent".
    return name.startswith((PREFIX + VERSIONS, *DRIVEN_BY, COMPUTER)) or (known and name not in ("scene", "agent"))


def _change(name: str, before: frozenset[str], now: frozenset[str]) -> SettingChange:
    of_drive = name.split(".")[0] in DRIVE_NAMES or name.startswith((HOUSE, *DRIVEN_BY))
    told = "computer" if name == COMPUTER else name.removeprefix(PREFIX)
    return SettingChange(told, _shown(before, now), _shown(now, before), of_drive)


def _values(runs: pd.DataFrame, name: str) -> frozenset[str]:
    """All values in words; of houses with their paths, each of which has its own."""
    if name not in runs:
        return frozenset({NOT_TOLD})
    if name == HOUSE:
        houses = runs[["place", name]].drop_duplicates()
        return frozenset(f"{level_name(house)} ({place})" for place, house in houses.itertuples(index=False))
    return frozenset(map(level_name, runs[name].drop_duplicates()))


def _shown(values: frozenset[str], others: frozenset[str]) -> str:
    """The values, first those that the other study lacks, since of many only some are shown."""
    return some_of(sorted(level_order(values), key=others.__contains__))
