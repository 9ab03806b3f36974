"""Smoothing of a planned route that keeps it in free space."""

from collections.abc import Callable, Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d, minimum_filter1d, uniform_filter1d

from slamgym.agents.path import SPACING_M, resample
from slamgym.types import BoolArray, FloatArray

IsFree = Callable[[FloatArray], BoolArray]
"""Points (..., 2) -> whether the robot's centre may be there (...)."""


def smooth(xy: FloatArray, is_free: IsFree, sigmas_m: Sequence[float]) -> FloatArray:
    """The polyline (P, 2), smoothed by Gaussians along it and resampled every 0.05 m; its ends stay where they are.

    sigmas_m: increasing widths, metres. Each point gets the widest one that keeps it and its neighbours free, with
    gradual changes between them. A right-angled corner becomes a bend of radius 0.89 sigma.
    """
    xy = resample(xy)
    levels = np.stack([xy, *(_gaussian(xy, sigma / SPACING_M) for sigma in sigmas_m)])
    allowed = np.cumprod(is_free(levels[1:]), axis=0).sum(axis=0)
    window = 2 * round(sigmas_m[-1] / SPACING_M) + 1
    while True:
        # A mean of minima over the same window never exceeds what is allowed at its centre.
        level = np.minimum(uniform_filter1d(minimum_filter1d(allowed, window).astype(np.float64), window), allowed)
        blended = _blend(levels, level)
        blocked = ~is_free(blended) & (level > 0)
        if not blocked.any():
            return resample(blended)
        allowed[blocked] = 0


def _gaussian(xy: FloatArray, sigma: float) -> FloatArray:
    """Gaussian of `sigma` points along a polyline (P, 2), continued beyond its ends by point reflection."""
    margin = round(4 * sigma)
    padded = np.pad(xy, ((margin, margin), (0, 0)), mode="reflect", reflect_type="odd")
    smoothed = gaussian_filter1d(padded, sigma, axis=0)[margin : margin + len(xy)]
    smoothed[[0, -1]] = xy[[0, -1]]
    return smoothed


def _blend(levels: FloatArray, level: FloatArray) -> FloatArray:
    """Points (P, 2) of `levels` (K, P, 2) at a fractional level (P,) each."""
    lower = np.floor(level).astype(np.int64)
    upper = np.ceil(level).astype(np.int64)
    point = np.arange(len(level))
    weight = (level - lower)[:, None]
    return (1 - weight) * levels[lower, point] + weight * levels[upper, point]
