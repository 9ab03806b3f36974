"""Where a camera could be in a house: above a floor, with free space around, and whether a roof is above."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from slamgym.scenes.light.rays import Rays, sphere
from slamgym.types import BoolArray, FloatArray

GRID_M = 0.8
GRID_MOST = 24
"""Viewpoints along the longer side of the house; a wide one gets a wider grid."""
HEIGHTS_M = (0.5, 1.2)
LOOKS = 48
ROOMY_M = 0.8
"""A camera's place is free as far as this in the mean; the inside of furniture is not."""
FAR_M = 4.0
ROOF_M = 8.0
"""What is further above a camera is no roof."""
PROBES_MOST = 256
"""Along either side of the scene, where the roof is looked for."""
LEAST_ROOF_M2 = 8.0
"""What covers less is a lamp, a shelf, or the inside of a wall."""


class Places(NamedTuple):
    """Where cameras could be. indoors: (P, 3) under a roof, or all in a scene without one. everywhere: (Q, 3)."""

    indoors: FloatArray
    everywhere: FloatArray


def places_in(rays: Rays, corners: NDArray[np.floating]) -> Places:
    """The places in the scene whose faces have these corners (N, 3). A garden's take no room from those indoors."""
    if not len(corners):
        return Places(np.zeros((0, 3)), np.zeros((0, 3)))
    low, high = (bound.astype(np.float64) for bound in (corners[:, :2].min(axis=0), corners[:, :2].max(axis=0)))
    everywhere = _free_places(rays, low, high)
    if (roof := _roof(rays, low, high)) is None:
        return Places(everywhere, everywhere)
    near = _free_places(rays, *roof)
    indoors = near[_roofed(rays, near)]
    if not len(indoors):
        return Places(everywhere, everywhere)
    return Places(indoors, np.concatenate([indoors, everywhere[~_roofed(rays, everywhere)]]))


def _free_places(rays: Rays, low: FloatArray, high: FloatArray) -> FloatArray:
    """Places (P, 3) of a grid over the rectangle from low (2,) to high (2,)."""
    x, y = _middles(low, high, max(GRID_M, float((high - low).max()) / GRID_MOST))
    places = np.stack(np.meshgrid(x, y, HEIGHTS_M, indexing="ij"), axis=-1).reshape(-1, 3)
    looks = sphere(LOOKS)
    distance = rays.first_hits(np.repeat(places, LOOKS, axis=0), np.tile(looks, (len(places), 1))).distance
    distance = np.minimum(distance, FAR_M).reshape(-1, LOOKS)
    floor = np.median(distance[:, looks[:, 2] < -0.5], axis=1) < FAR_M
    roomy = (distance.mean(axis=1) > ROOMY_M) & (distance.min(axis=1) > 0.1)
    free: FloatArray = places[floor & roomy]
    return free


def _roof(rays: Rays, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray] | None:
    """The rectangle (2,), (2,) around what has a roof above between low and high; None where nothing has."""
    x, y = _middles(low, high, max(GRID_M, float((high - low).max()) / PROBES_MOST))
    probes = np.stack(np.meshgrid(x, y, HEIGHTS_M[-1], indexing="ij"), axis=-1).reshape(-1, 3)
    roofed = ndimage.binary_opening(_roofed(rays, probes).reshape(len(x), len(y)), np.ones((2, 2), dtype=bool))
    step = (high - low) / roofed.shape
    if np.count_nonzero(roofed) * step.prod() < LEAST_ROOF_M2:
        return None
    cells = np.argwhere(roofed)
    return low + cells.min(axis=0) * step, low + (cells.max(axis=0) + 1) * step


def _middles(low: FloatArray, high: FloatArray, step: float) -> tuple[FloatArray, FloatArray]:
    """Coordinates x and y of the middles of cells of about `step` metres that fill the rectangle."""
    x, y = (np.linspace(a, b, 2 * max(1, round((b - a) / step)) + 1)[1::2] for a, b in zip(low, high, strict=True))
    return x, y


def _roofed(rays: Rays, places: FloatArray) -> BoolArray:
    """Which places (P, 3) have something above, (P,)."""
    up = np.tile([0.0, 0.0, 1.0], (len(places), 1))
    return rays.blocked(places, up, np.full(len(places), ROOF_M))
