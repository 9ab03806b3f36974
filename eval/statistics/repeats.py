"""Repeated runs of one path, brought together to one row a path."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from slamgym.errors import ConfigError
from slamgym.eval.statistics.intervals import checked_flags


def median_over_repeats(
    table: pd.DataFrame, by: Sequence[str], columns: Sequence[str], failed: ArrayLike | None = None
) -> pd.DataFrame:
    """One row for each combination of the columns `by` (a path, and what was varied on it), in sorted order.

    columns: errors, for which lower is better, such as "ate_rmse_m". Each becomes the median over all repeats, in which
    a failed one counts as +inf: where half of the repeats or more failed, so has the median. The median of the
    successful ones alone would grow better with each hard run that fails. Added are the numbers of `runs` and
    `failures`.

    failed: bool (rows,), which runs failed, such as `~table["success"]`. A run without a finite value in one of the
    columns has failed in any case. Raises ConfigError for a column that the table lacks or that
    is added, and flags that are not bool.
    """
    _check_columns(table, [*by, *columns])
    errors = table[list(columns)].astype(np.float64)
    failures = ~np.isfinite(errors.to_numpy()).all(axis=1)
    if failed is not None:
        failures = failures | checked_flags(failed, len(table))
    errors[failures] = np.inf
    rows = errors.assign(runs=1, failures=failures.astype(np.int64))
    counts = {"runs": "sum", "failures": "sum"}
    keys = [table[name] for name in by]
    return rows.groupby(keys, dropna=False).agg(dict.fromkeys(columns, "median") | counts).reset_index()


def _check_columns(table: pd.DataFrame, names: Sequence[str]) -> None:
    missing = [name for name in names if name not in table]
    if missing:
        raise ConfigError(f"table: expected the columns {missing}, got {list(table.columns)}")
    if taken := {"runs", "failures"} & set(names):
        raise ConfigError(f"table: expected other columns than {sorted(taken)}, which are added: rename them")
