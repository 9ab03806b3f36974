"""p-values of several tests at once."""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike
from statsmodels.stats.multitest import multipletests

from slamgym.types import FloatArray

Correction = Literal["holm", "fdr_bh"]


def corrected(p_values: ArrayLike, correction: Correction = "holm") -> FloatArray:
    """p-values (T,) of T tests, corrected for their number; NaN is no test.

    correction: "holm" bounds the chance of any false finding, "fdr_bh" (Benjamini and Hochberg) the expected share of
    false ones among the findings.
    """
    p = np.asarray(p_values, dtype=np.float64)
    tested = ~np.isnan(p)
    result = np.full_like(p, np.nan)
    if tested.any():
        result[tested] = multipletests(p[tested], method=correction)[1]
    return result
