"""Statistics of errors."""

from dataclasses import dataclass
from typing import NamedTuple, Self

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


class PoseErrorStats(NamedTuple):
    """Statistics of pose errors: of the translation in metres, of the rotation angle in degrees."""

    trans_m: ErrorStats
    rot_deg: ErrorStats

    @classmethod
    def of(cls, trans_m: FloatArray, rot_deg: FloatArray) -> Self:
        return cls(ErrorStats.of(trans_m), ErrorStats.of(rot_deg))
