"""Statistics of errors."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from slamgym.types import FloatArray


@dataclass(frozen=True, slots=True)
class ErrorStats:
    """Statistics of errors, in their unit; std is that of the population. All are NaN when there is no error at all."""

    rmse: float
    mean: float
    median: float
    std: float
    min: float
    max: float

    @classmethod
    def of(cls, errors: FloatArray) -> Self:
        if not len(errors):
            return cls(*[np.nan] * 6)
        rmse = np.sqrt(np.mean(errors**2))
        values = (rmse, errors.mean(), np.median(errors), errors.std(), errors.min(), errors.max())
        return cls(*map(float, values))
