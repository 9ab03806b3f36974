"""Rank correlations between attributes of paths and what a SLAM achieved on them."""

import math
from typing import NamedTuple, get_args

import numpy as np
import pandas as pd
from scipy import stats

from slamgym.errors import ConfigError, unknown_word
from slamgym.eval.statistics.multiple import Correction, corrected
from slamgym.types import FloatArray

CORRECTIONS = get_args(Correction)
_EXACT_UP_TO = 7
"""Spearman's p-value comes from all n! orders up to this n; above, from Student's t."""


class _Pair(NamedTuple):
    attribute: str
    metric: str
    n: int
    spearman: float = np.nan
    spearman_p: float = np.nan
    kendall: float = np.nan
    kendall_p: float = np.nan


def correlations(attributes: pd.DataFrame, metrics: pd.DataFrame, correction: Correction = "holm") -> pd.DataFrame:
    """Spearman's rho and Kendall's tau-b of each attribute with each metric, one row a pair.

    attributes, metrics: numbers, one row a path, both with the same index. Rows must be independent of each other:
    bring repeats of a path together first, see `median_over_repeats`. Failures may be +inf, the last rank.

    Columns: attribute, metric, n, spearman, spearman_p, spearman_p_corrected, kendall, kendall_p, kendall_p_corrected.
    The p-values are two-sided. Rows where either value is NaN are left out of that pair, and `n` counts the others. A
    pair without two different values on both sides has NaN, and is not counted as a test.

    correction: see `multiple.corrected`. Each coefficient's p-values are one family, all pairs of the table: decide for
    one coefficient before looking, since choosing the better of the two for each pair is not corrected for.
    Raises ConfigError.
    """
    if correction not in CORRECTIONS:
        raise ConfigError(unknown_word("correction", correction, CORRECTIONS))
    if not attributes.index.equals(metrics.index) or not attributes.index.is_unique:
        rows = f"{len(attributes)} and {len(metrics)} rows"
        raise ConfigError(f"correlations: expected tables with the same index, one row a path, got {rows}; align them")
    pairs = [_pair(attributes[a], metrics[m]) for a in attributes.columns for m in metrics.columns]
    table = pd.DataFrame(pairs, columns=_Pair._fields)
    for at, name in ((5, "spearman"), (8, "kendall")):
        table.insert(at, f"{name}_p_corrected", corrected(table[f"{name}_p"].to_numpy(np.float64), correction))
    return table


def _pair(attribute: "pd.Series[float]", metric: "pd.Series[float]") -> _Pair:
    x, y = attribute.to_numpy(np.float64), metric.to_numpy(np.float64)
    both = ~(np.isnan(x) | np.isnan(y))
    x, y = stats.rankdata(x[both]), stats.rankdata(y[both])
    empty = _Pair(str(attribute.name), str(metric.name), len(x))
    if len(x) < 3 or np.all(x == x[0]) or np.all(y == y[0]):
        return empty
    rho, tau = _spearman(x, y), stats.kendalltau(x, y)
    return empty._replace(spearman=rho[0], spearman_p=rho[1], kendall=float(tau.statistic), kendall_p=float(tau.pvalue))


def _spearman(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Spearman's rho and its p-value, of ranks.

    Student's t calls a perfect order certain, p = 0, even one of five values, which has a chance of 1 in 60.
    """
    exact = stats.PermutationMethod(n_resamples=math.factorial(_EXACT_UP_TO))
    rho = stats.pearsonr(x, y, method=exact) if len(x) <= _EXACT_UP_TO else stats.spearmanr(x, y)
    least = 2 / math.factorial(len(x))
    return float(rho.statistic), max(float(rho.pvalue), least)
