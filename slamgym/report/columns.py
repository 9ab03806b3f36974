"""Columns of a table of runs, whether or not the table has them."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from slamgym.types import FloatArray


def numbers(table: pd.DataFrame, column: str) -> FloatArray:
    """A column as float64, NaN where it has no number or the table has no such column."""
    if column not in table:
        return np.full(len(table), np.nan)
    return pd.to_numeric(table[column], errors="coerce").to_numpy(np.float64, na_value=np.nan)


def texts(table: pd.DataFrame, column: str) -> "pd.Series[str]":
    """A column as text, "" where it has none or the table has no such column."""
    if column not in table:
        return pd.Series("", index=table.index, dtype=object)
    return table[column].astype(object).where(table[column].notna(), "").astype(str)


def places(tables: Sequence[pd.DataFrame]) -> list["pd.Series[str]"]:
    """The paths of each table by their names; with their datasets where one name stands for paths of two of them."""
    datasets = [texts(runs, "dataset") for runs in tables]
    names = [texts(runs, "path") for runs in tables]
    ambiguous = any(len(set(zip(d, p, strict=True))) > p.nunique() for d, p in zip(datasets, names, strict=True))
    return [d + ": " + p for d, p in zip(datasets, names, strict=True)] if ambiguous else names
