"""Level surfaces of a scene along an axis: floors, ceilings, table tops."""

from typing import NamedTuple

import numpy as np

from slamgym.scenes.importing.cleaning import areas_of, weighted_quantile
from slamgym.types import BoolArray, FloatArray, IntArray

LEVEL_COSINE = 0.95
SLICES = 200
"""Slices of the scene's height; a level takes two of them, as a scanned floor is not quite flat."""
LARGE = 0.5
"""Share of the largest level's area from which on another may be the floor."""
CEILING_SHARE = 0.3
SLAB = 0.15
"""Thickness of a floor by the scene's height, up to which its upper side is the floor and not its lower one."""
TOP_SHARE = 0.99


class Level(NamedTuple):
    """height: along the axis. area: of the faces there, whichever way they look. upward: area of those that look
    up, less that of those that look down.
    """

    height: float
    area: float
    upward: float


class Storey(NamedTuple):
    """The lowest storey. coverage: the floor's area by that of the rectangle around the scene, at most 1.

    height: up to the next large level above, or to the scene's top when there is none. below: how far the scene
    reaches below the floor.
    """

    floor: Level
    coverage: float
    height: float
    below: float


def lowest_storey(triangles: FloatArray, axis: int) -> Storey | None:
    """The storey of triangles (F, 3, 3), F > 0, when `axis` is up; None when nothing is level."""
    corners = triangles[..., axis]
    areas = areas_of(triangles)
    bottom, top = float(corners.min()), weighted_quantile(corners.max(axis=1), areas, TOP_SHARE)
    levels = _levels(triangles, axis, max(top - bottom, 1e-9))
    if not levels:
        return None
    floor = _floor(levels, top - bottom)
    above = [level for level in levels if level.height > floor.height + 0.3 * (top - floor.height)]
    ceilings = [level.height for level in above if level.area >= CEILING_SHARE * floor.area]
    height = (ceilings[0] if ceilings else top) - floor.height
    around = np.delete(np.ptp(triangles, axis=(0, 1)), axis)
    coverage = min(1.0, floor.area / max(float(around.prod()), np.finfo(float).tiny))
    lowest = weighted_quantile(corners.min(axis=1), areas, 1.0 - TOP_SHARE)
    return Storey(floor, coverage, height, below=floor.height - lowest)


def level_share(triangles: FloatArray, axis: int) -> float:
    """Share of the area of triangles (F, 3, 3), F > 0, that is level when `axis` is up."""
    upward, areas = _upward_areas(triangles, axis)
    return float(areas[_is_level(upward, areas)].sum() / max(float(areas.sum()), np.finfo(float).tiny))


def _floor(levels: list[Level], height: float) -> Level:
    large = [level for level in levels if level.area >= LARGE * max(level.area for level in levels)]
    floor = large[0]
    for level in large[1:]:
        if level.height - floor.height < SLAB * height:
            floor = level
    return floor


def _levels(triangles: FloatArray, axis: int, height: float) -> list[Level]:
    """Levels from the lowest to the highest, of those that are larger than their neighbours."""
    upward, areas = _upward_areas(triangles, axis)
    level = _is_level(upward, areas)
    heights, areas, upward = triangles[level][..., axis].mean(axis=1), areas[level], upward[level]
    if len(heights) == 0:
        return []
    bins = ((heights - heights.min()) / height * SLICES).astype(np.int64).clip(0, 2 * SLICES)
    window = np.convolve(np.bincount(bins, areas), [1.0, 1.0])
    return [_level(k, bins, heights, areas, upward) for k in _peaks(window)]


def _upward_areas(triangles: FloatArray, axis: int) -> tuple[FloatArray, FloatArray]:
    """Areas (F,) as seen along `axis`, negative for faces that look down, and areas (F,)."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]) / 2.0
    return normals[:, axis], np.linalg.norm(normals, axis=1)


def _is_level(upward: FloatArray, areas: FloatArray) -> BoolArray:
    return np.asarray(np.abs(upward) > LEVEL_COSINE * areas)


def _peaks(window: FloatArray) -> IntArray:
    """Where two slices, k - 1 and k, hold more than those just below and no less than those just above."""
    padded = np.concatenate([[0.0], window, [0.0]])
    return np.flatnonzero((window > padded[:-2]) & (window >= padded[2:]))


def _level(k: int, bins: IntArray, heights: FloatArray, areas: FloatArray, upward: FloatArray) -> Level:
    here = (bins == k) | (bins == k - 1)
    return Level(
        weighted_quantile(heights[here], areas[here], 0.5), float(areas[here].sum()), float(upward[here].sum())
    )
