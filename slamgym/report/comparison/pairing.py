"""Runs of two studies side by side: the same path, driven the same way, with the same levels of all common factors."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from slamgym.errors import ConfigError
from slamgym.eval.statistics import median_over_repeats
from slamgym.params import DriveParams
from slamgym.report.columns import numbers, places
from slamgym.report.comparison.metrics import ATE, METRICS, SUCCESS, TIME
from slamgym.report.levels import level_name
from slamgym.study.results import StudyResults
from slamgym.study.table import succeeded, was_run

DRIVE_NAMES = (*DriveParams.model_fields, "agent", "max_episode_steps")
SIDES = ("new", "baseline")
SHOWN_VALUES = 5


@dataclass(frozen=True, slots=True, eq=False)
class Pairing:
    """What two studies have in common.

    factors: by which the pairs are told apart, beside the path: the common ones, those of the drive that only one study
    varies, and others that only one varies, whose levels all have the other study's one as their partner.
    pairs: one row a pair: `place`, which is the path; the factors, as text; and for both sides, such as "runs.new" and
    "runs.baseline", `runs`, `successes`, and each metric with its repeats brought together: the median of ATE, in which
    a failure counts as infinite, and of the time for a frame, else the mean.
    runs: side -> the runs that are in a pair. alone: side -> how many runs have no partner. not_begun: side -> how many
    runs the SLAM was never started for.
    """

    factors: tuple[str, ...]
    pairs: pd.DataFrame
    runs: dict[str, pd.DataFrame]
    alone: dict[str, int]
    not_begun: dict[str, int]

    @property
    def paths(self) -> int:
        return int(self.pairs["place"].nunique())


def pair_studies(new: StudyResults, baseline: StudyResults) -> Pairing:
    """Pair the runs of both studies; raises ConfigError, in one line, where none has a partner."""
    tables = [_begun(new), _begun(baseline)]
    begun = {side: runs.assign(place=place) for side, runs, place in zip(SIDES, tables, places(tables), strict=True)}
    common, own = _factors(new, baseline)
    keys = ["place", *common]
    texts = {side: _with_texts(runs, [*common, *own[side]]) for side, runs in begun.items()}
    rows = {side: _settings(texts[side], [*keys, *own[side]]) for side in SIDES}
    pairs = rows["new"].merge(rows["baseline"], on=keys, suffixes=(".new", ".baseline"))
    if pairs.empty:
        raise ConfigError(_nothing_in_common(texts, common))
    paired = {side: _partnered(runs, pairs[keys]) for side, runs in texts.items()}
    return Pairing(
        factors=(*common, *own["new"], *own["baseline"]),
        pairs=pairs,
        runs={side: runs[paired[side]] for side, runs in begun.items()},
        alone={side: int((~paired[side]).sum()) for side in SIDES},
        not_begun={"new": len(new.runs) - len(begun["new"]), "baseline": len(baseline.runs) - len(begun["baseline"])},
    )


def level_order(names: Iterable[str]) -> list[str]:
    """Names of levels, each once, numbers by their size before words."""

    def place(name: str) -> tuple[bool, float, str]:
        try:
            return False, float(name), name
        except ValueError:
            return True, 0.0, name

    return sorted(set(names), key=place)


def some_of(values: Sequence[str]) -> str:
    """Some values in words, not more than a line takes."""
    more = len(values) - SHOWN_VALUES
    return ", ".join(values[:SHOWN_VALUES]) + (f" and {more} more" if more > 0 else "")


def _begun(study: StudyResults) -> pd.DataFrame:
    runs = study.runs[was_run(study.runs)]
    if runs.empty:
        raise ConfigError(f"compare: expected finished runs in {study.folder}, got none; run the study first")
    return runs


def _factors(new: StudyResults, baseline: StudyResults) -> tuple[list[str], dict[str, list[str]]]:
    """Factors to pair by, and those that only one of the studies has and that do not change the drive."""
    both_tables = set(new.runs) & set(baseline.runs)
    both_vary = set(new.factors) & set(baseline.factors)
    factors = list(dict.fromkeys([*new.factors, *baseline.factors]))
    common = [
        name for name in factors if name in both_tables and (name in both_vary or name.split(".")[0] in DRIVE_NAMES)
    ]
    own = {
        "new": [name for name in new.factors if name not in common],
        "baseline": [name for name in baseline.factors if name not in common],
    }
    return common, own


def _with_texts(runs: pd.DataFrame, factors: Sequence[str]) -> pd.DataFrame:
    """The same texts for the same levels, whether a column holds numbers or texts."""
    codes = {name: pd.factorize(runs[name], use_na_sentinel=False) for name in factors}
    return runs.assign(**{name: np.array([level_name(v) for v in values])[k] for name, (k, values) in codes.items()})


def _settings(runs: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """One row a path and its levels, the repeats brought together."""
    success = succeeded(runs).to_numpy(np.bool_)
    values = pd.DataFrame({metric.name: numbers(runs, metric.name) for metric in METRICS}, index=runs.index)
    values = values.assign(**{SUCCESS.name: success.astype(np.float64)})
    ways = dict.fromkeys(values, "mean") | {TIME.name: "median"}
    groups = values.assign(runs=1, successes=success.astype(np.int64)).groupby([runs[name] for name in by])
    together = groups.agg({**ways, "runs": "sum", "successes": "sum"}).reset_index()
    errors = median_over_repeats(runs[by].assign(**{ATE.name: values[ATE.name]}), by, [ATE.name], ~success)
    return together.assign(**{ATE.name: errors[ATE.name]})


def _partnered(runs: pd.DataFrame, keys: pd.DataFrame) -> "pd.Series[bool]":
    """Which runs are in a pair."""
    wanted = pd.MultiIndex.from_frame(keys.drop_duplicates())
    return pd.Series(pd.MultiIndex.from_frame(runs[list(keys)]).isin(wanted), index=runs.index)


def _nothing_in_common(runs: dict[str, pd.DataFrame], common: Sequence[str]) -> str:
    paths = {side: set(runs[side]["place"]) for side in SIDES}
    if paths["new"] & paths["baseline"]:
        here, there = (
            "; ".join(f"{name} {some_of(level_order(runs[side][name]))}" for name in common) for side in SIDES
        )
        return f"compare: expected runs with the same levels on the same paths, got {here} against {there}"
    here, there = (f"{len(paths[side])} paths such as {min(paths[side])!r}" for side in SIDES)
    return (
        f"compare: expected two studies with a path in common, got {here} and {there}; compare runs of the same paths"
    )
