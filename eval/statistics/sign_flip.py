"""Is a mean difference over paths more than chance?"""

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from slamgym.errors import ConfigError
from slamgym.types import FloatArray

_RESAMPLES = 9999
_BATCH = 200


def sign_flip_p(differences: ArrayLike) -> float:
    """Two-sided p-value of a mean difference, one value a path (P,), against no difference at all.

    Without one, each path's difference could as well have the other sign (Fisher, "The design of experiments", 1935,
    section 21). Up to 13 paths all signs are tried, else 9,999 random ones. The least is 2^(1 - P): of 5 paths or fewer
    none is below 0.05. Raises ConfigError.
    """
    values = _checked(differences)
    if len(values) == 1 or not values.any():
        return 1.0
    test = stats.permutation_test(
        (values,),
        lambda sample, axis: np.mean(sample, axis=axis),
        permutation_type="samples",
        vectorized=True,
        n_resamples=_RESAMPLES,
        batch=_BATCH,
        rng=0,
    )
    return float(test.pvalue)


def _checked(differences: ArrayLike) -> FloatArray:
    values = np.asarray(differences, dtype=np.float64)
    if values.ndim != 1 or not len(values) or not np.isfinite(values).all():
        raise ConfigError(f"expected finite differences (P,), one a path, P of 1 or more, got shape {values.shape}")
    return values
