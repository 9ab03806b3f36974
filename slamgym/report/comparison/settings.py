"""What differs between two studies in what was asked for: parameters, and versions of what the results depend on."""

from typing import NamedTuple

import pandas as pd

from slamgym.params import SlamParams
from slamgym.report.comparison.pairing import DRIVE_NAMES, level_order, some_of
from slamgym.report.levels import level_name

CONDITIONS = ("busy_processes", "fps")
PREFIX = "run."
VERSIONS = "versions."
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
    changes = [_change(name, new, baseline) for name in names]
    differing = [change for change in changes if change.new != change.baseline]
    return tuple(sorted(differing, key=lambda change: (change.name.startswith(VERSIONS), change.of_drive)))


def _is_setting(name: str) -> bool:
    root = name.split(".")[0]
    # The scene belongs to the path; where paths differ, runs have no partners.
    known = root in DRIVE_NAMES or root in SlamParams.model_fields or root in CONDITIONS
    return name.startswith(PREFIX + VERSIONS) or (known and name != "scene")


def _change(name: str, new: pd.DataFrame, baseline: pd.DataFrame) -> SettingChange:
    old_value, new_value = (_values(runs, name) for runs in (baseline, new))
    return SettingChange(name.removeprefix(PREFIX), old_value, new_value, name.split(".")[0] in DRIVE_NAMES)


def _values(runs: pd.DataFrame, name: str) -> str:
    if name not in runs:
        return NOT_TOLD
    return some_of(level_order(level_name(value) for value in runs[name].drop_duplicates()))
