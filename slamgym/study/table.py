"""The table of a study's runs: one row a run, in a file that can be read while the study runs.

Columns: `run_id`, `dataset`, `path`, `scene`, `seed`, `sequence`, `repeat`, `drive_id`; each factor under its own name;
every entry of `config.yaml` and of `episode.json`, those of mappings joined by dots ("timing.track_ms_median"); lists
of results are left out. `status` is "not_run", and `failure` says why, where the drive could not be rendered or the
SLAM not be started: no failure of the SLAM, so `success` is empty.
"""

import json
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pandas as pd

from slamgym.errors import ConfigError, TrajectoryWarning
from slamgym.files import draft
from slamgym.run_record import read_config, read_results
from slamgym.study.folder import Plan, StudyFolder, read_plan
from slamgym.study.planned import PlannedRun
from slamgym.study.results import StudyResults
from slamgym.study.slam_work import read_planned

IDENTITY = ("run_id", "dataset", "path", "scene", "seed", "sequence", "repeat", "drive_id")
NOT_RUN = "not_run"
REPEAT = "start the study again to repeat it"

Row = dict[str, Any]


def open_study(path: Path) -> StudyResults:
    """The results of a study so far, also while it runs; raises ConfigError where there is no study.

    A run whose folder is damaged is left out, with a TrajectoryWarning.
    """
    folder = StudyFolder(Path(path))
    plan = read_plan(folder)
    return StudyResults(
        folder=folder.path,
        name=plan.name,
        description=plan.description,
        factors=plan.factors,
        planned=len(plan.run_ids),
        runs=current_table(folder, plan),
    )


def succeeded(runs: pd.DataFrame) -> "pd.Series[bool]":
    """Of each run whether it is a success; one that could not be run is none."""
    return runs["success"].eq(True) if "success" in runs else pd.Series(False, runs.index)


def was_run(runs: pd.DataFrame) -> "pd.Series[bool]":
    """Of each run whether it could be run, and so says something of its SLAM."""
    return runs["status"].ne(NOT_RUN) if "status" in runs else pd.Series(False, runs.index)


def _left_out(_: str, error: ConfigError) -> None:
    warnings.warn(f"{error}; it is left out", TrajectoryWarning, stacklevel=2)


def current_table(
    folder: StudyFolder, plan: Plan, on_damaged: Callable[[str, ConfigError], None] = _left_out
) -> pd.DataFrame:
    """The table on the disk, and the runs that were finished since it was written.

    on_damaged: called with the id of each of these whose folder cannot be read, and why; it has no row.
    """
    table = read_table(folder.table)
    new = sorted((folder.finished_runs() - set(table["run_id"][was_run(table)])).intersection(plan.run_ids))
    return joined(table, _rows(folder, new, on_damaged), plan)


def _rows(folder: StudyFolder, run_ids: Iterable[str], on_damaged: Callable[[str, ConfigError], None]) -> Iterator[Row]:
    for run_id in run_ids:
        try:
            yield run_row(folder.run(run_id))
        except ConfigError as error:
            on_damaged(run_id, error)


def read_table(path: Path) -> pd.DataFrame:
    """The table on the disk; one without rows where there is none that can be read.

    All but its runs that could not be run can be made anew from the run folders.
    """
    none = pd.DataFrame(columns=[*IDENTITY, "status"])
    try:
        table = pd.read_parquet(path) if path.is_file() else none
    except Exception:  # a damaged file may fail in any way
        return none
    return table if {"run_id", "status"} <= set(table) else none


def write_table(path: Path, table: pd.DataFrame) -> None:
    """Write the table in one piece; raises OutputError."""
    with draft(path) as place:
        table.to_parquet(place, index=False, compression="zstd")


def joined(table: pd.DataFrame, rows: Iterable[Row], plan: Plan) -> pd.DataFrame:
    """The table with further rows, which replace those of the same run, in the order of the plan; as of one writing."""
    if new := list(rows):
        columns = pd.DataFrame(new)
        earlier = table[~table["run_id"].isin(columns["run_id"])]
        table = pd.concat([earlier, columns], ignore_index=True) if len(earlier) else columns
    first = [name for name in (*IDENTITY, *plan.factors) if name in table]
    table = table[[*dict.fromkeys(first), *sorted(set(map(str, table)) - set(first))]]
    place = table["run_id"].map({run_id: k for k, run_id in enumerate(plan.run_ids)})
    table = table.loc[place.dropna().sort_values().index].reset_index(drop=True)
    mixed = [str(name) for name in table if pd.api.types.is_object_dtype(table[name])]
    return table.assign(**{name: _of_one_type(table[name]) for name in mixed})


def run_row(folder: Path) -> Row:
    """The row of a finished run, from its folder. Raises ConfigError where it is not a study's run folder."""
    run = read_planned(folder)
    config, results = read_config(folder, REPEAT), read_results(folder, REPEAT)
    if "status" not in results:
        raise ConfigError(f"{folder}: expected a run with a status in its episode.json, got none; {REPEAT}")
    if run is None:
        raise ConfigError(f"{folder}: expected a run of a study, got a folder without its plan; move it elsewhere")
    return _row(run, config, results)


def not_run_row(run: PlannedRun, failure: str) -> Row:
    """The row of a run that could not be begun."""
    return _row(run, {**run.drive.params, **run.slam}, {"status": NOT_RUN, "success": None, "failure": failure})


def _row(run: PlannedRun, config: Mapping[str, Any], results: Mapping[str, Any]) -> Row:
    drive = asdict(run.drive)
    identity = {name: drive.get(name) for name in IDENTITY} | {
        "run_id": run.run_id,
        "repeat": run.repeat,
        "scene": drive["params"].get("scene"),
    }
    results = {name: value for name, value in _flat(results).items() if not isinstance(value, list)}
    asked = {**_flat(config), "busy_processes": run.busy_processes}, run.levels
    config, levels = ({name: _one_value(value) for name, value in values.items()} for values in asked)
    return {**config, **results, **levels, **identity}


def _flat(values: Mapping[str, Any], prefix: str = "") -> Row:
    """Mappings within it joined by dots: {"timing": {"a": 1}} becomes {"timing.a": 1}; empty ones vanish."""
    flat: Row = {}
    for name, value in values.items():
        flat |= _flat(value, f"{prefix}{name}.") if isinstance(value, Mapping) else {f"{prefix}{name}": value}
    return flat


def _one_value(value: Any) -> Any:
    return json.dumps(value) if isinstance(value, Mapping | list | tuple) else value


def _of_one_type(column: pd.Series) -> pd.Series:
    """Numbers, truth values or texts, any of them with gaps; a column that mixes them becomes text."""
    known = column[column.notna()]
    kinds = {_kind(value) for value in known}
    if kinds <= {bool}:
        return column.where(column.notna(), None) if len(known) < len(column) else column.astype(bool)
    if kinds == {float}:
        return pd.to_numeric(column)
    return known.map(_text).astype("str").reindex(column.index)


def _kind(value: Any) -> type:
    if isinstance(value, bool | str):
        return type(value)
    return float if pd.api.types.is_number(value) else object


def _text(value: Any) -> str:
    """The same for a number whether or not its column had gaps, which make all of it floating."""
    return str(int(value)) if isinstance(value, float) and value.is_integer() else str(value)
