"""What a grey image offers to a SLAM that follows corners. `grey` is uint8 (H, W) throughout."""

import cv2
import numpy as np
from numpy.typing import NDArray

GreyImage = NDArray[np.uint8]

FAST_THRESHOLD = 20
"""Grey levels that a corner differs from its surroundings; what ORB-SLAM tries first."""

SMOOTHING_PX = 1.0
"""Standard deviation of the smoothing, in pixels of half the size."""

MIN_GRADIENT = 0.05
"""Mean squared gradient, grey levels squared, below which an image shows hardly more than its rounding."""


def keypoint_count(grey: GreyImage) -> int:
    """FAST corners of the full image, at FAST_THRESHOLD and with non-maximum suppression.

    Rosten and Drummond, "Machine learning for high-speed corner detection", ECCV 2006; the detector under ORB.
    """
    return len(cv2.FastFeatureDetector_create(FAST_THRESHOLD, nonmaxSuppression=True).detect(grey))  # type: ignore[attr-defined]


def sharpness(grey: GreyImage) -> float:
    """How abruptly the grey changes where it changes at all, 1/px^2; NaN for hardly more than one grey, or below 6x6.

    Mean squared second difference, along the axis where that is smaller, over the mean squared gradient: energies of
    Laplacian and gradient (Pertuz et al., "Analysis of focus measure operators for shape-from-focus", Pattern
    Recognition 2013), put into a ratio, and one axis at a time. The ratio stays where light dims or a bare wall fills
    the view, which lower the variance of the Laplacian just as blur does; and an axis at a time it sees the blur of a
    turn, which leaves edges along the motion sharp. Taken at half the size and smoothed, so that noise of the sensor
    does not pass for sharpness.
    """
    if min(grey.shape) < 6:
        return np.nan
    half = cv2.resize(grey, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA).astype(np.float32)
    smooth = cv2.GaussianBlur(half, (0, 0), SMOOTHING_PX)
    along_y, along_x = smooth[1:] - smooth[:-1], smooth[:, 1:] - smooth[:, :-1]
    gradient = _mean_square(along_y) + _mean_square(along_x)
    second = min(_mean_square(along_y[1:] - along_y[:-1]), _mean_square(along_x[:, 1:] - along_x[:, :-1]))
    return second / gradient if gradient > MIN_GRADIENT else np.nan


def brightness(grey: GreyImage) -> float:
    """Mean grey level, 0 to 255."""
    return float(cv2.mean(grey)[0])


def _mean_square(values: NDArray[np.float32]) -> float:
    return float(np.mean(values * values))
