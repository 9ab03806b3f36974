"""Colours as images have them, sRGB, and as light adds up, linear (IEC 61966-2-1); both 1 for 1."""

import numpy as np
from numpy.typing import ArrayLike

from slamgym.types import FloatArray


def linear_of_srgb(colour: ArrayLike) -> FloatArray:
    """Linear values of sRGB ones, of any shape, in [0, 1]."""
    c = np.asarray(colour, dtype=np.float64)
    return np.where(c <= 0.04045, c / 12.92, ((np.maximum(c, 0.0) + 0.055) / 1.055) ** 2.4)


def srgb_of_linear(linear: ArrayLike) -> FloatArray:
    """SRGB values of linear ones, of any shape, in [0, 1]."""
    light = np.asarray(linear, dtype=np.float64)
    curve = 1.055 * np.maximum(light, 0.0031308) ** (1.0 / 2.4) - 0.055
    return np.where(light <= 0.0031308, 12.92 * light, curve)
