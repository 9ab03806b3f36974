"""What a grey image offers to a SLAM that follows corners. `grey` is uint8 (H, W) throughout."""

import cv2
import numpy as np
from numpy.typing import NDArray

GreyImage = NDArray[np.uint8]

FAST_THRESHOLD = 20
"""Grey levels that a corner differs from its surroundings; what ORB-SLAM tries first."""


def keypoint_count(grey: GreyImage) -> int:
    """FAST corners of the full image, at FAST_THRESHOLD and with non-maximum suppression.

    Rosten and Drummond, "Machine learning for high-speed corner detection", ECCV 2006; the detector under ORB.
    """
    return len(cv2.FastFeatureDetector_create(FAST_THRESHOLD, nonmaxSuppression=True).detect(grey))  # type: ignore[attr-defined]


def sharpness(grey: GreyImage) -> float:
    """Variance of the Laplacian, grey levels squared. Blur lowers it, but so do dim light and bare walls.

    Pech-Pacheco et al., "Diatom autofocusing in brightfield microscopy: a comparative study", ICPR 2000.
    """
    _, deviation = cv2.meanStdDev(cv2.Laplacian(grey, cv2.CV_16S))
    return float(deviation[0, 0] ** 2)


def brightness(grey: GreyImage) -> float:
    """Mean grey level, 0 to 255."""
    return float(cv2.mean(grey)[0])
