"""Sensor noise as pure functions of an image and a random generator."""

import cv2
import numpy as np
from numpy.typing import NDArray

DISPARITY_CM = 35130.0
"""Depth in cm times Kinect disparity in eighths of a pixel."""
SHIFT_SIGMA_PX = 0.5
DISPARITY_SIGMA = 1.0 / 6.0


def icl_nuim_depth_noise(depth: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.float32]:
    """Depth (H, W), metres, as a structured-light sensor would measure it; 0, no measurement, stays 0.

    The model of Handa et al., "A benchmark for RGB-D visual odometry, 3D reconstruction and SLAM" (ICRA 2014), after
    Barron and Malik (CVPR 2013): depth is read at a randomly shifted place, its disparity disturbed and rounded. Places
    outside the image read its border; the bilinear reading leaves out neighbours without a measurement.
    """
    noise = rng.standard_normal((3, *depth.shape), dtype=np.float32)
    z_cm = 100.0 * _shifted(depth, SHIFT_SIGMA_PX * noise[0], SHIFT_SIGMA_PX * noise[1])
    measured = (depth > 0.0) & (z_cm > 0.0)
    disparity = np.floor(DISPARITY_CM / np.where(measured, z_cm, 1.0) + DISPARITY_SIGMA * noise[2] + 0.5)
    measured &= disparity >= 1.0
    return np.where(measured, 0.01 * DISPARITY_CM / np.maximum(disparity, 1.0), 0.0).astype(np.float32)


def _shifted(
    depth: NDArray[np.float32], shift_x: NDArray[np.float32], shift_y: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Depth read bilinearly at (x + shift_x, y + shift_y), pixels, from measured neighbours; 0 without any."""
    y, x = np.indices(depth.shape, dtype=np.float32)
    where = x + shift_x, y + shift_y
    total, weight = (
        cv2.remap(image, *where, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        for image in (depth, (depth > 0.0).astype(np.float32))
    )
    least = np.float32(1e-3)
    return np.where(weight > least, total / np.maximum(weight, least), np.float32(0.0))


def rgb_noise(rgb: NDArray[np.uint8], sigma: float, rng: np.random.Generator) -> NDArray[np.uint8]:
    """The image (H, W, 3) with independent Gaussian noise of `sigma` grey levels of 255 in every value."""
    noise = rng.standard_normal(rgb.shape, dtype=np.float32)
    return np.clip(np.rint(rgb + np.float32(sigma) * noise), 0, 255).astype(np.uint8)
