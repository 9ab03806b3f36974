"""Level surfaces of a scene along an axis: floors, ceilings, table tops."""

from typing import NamedTuple

import numpy as np

from slamgym.scenes.importing.cleaning import areas_of, weighted_quantile
from slamgym.types import BoolArray, FloatArray, IntArray

LEVEL_COSINE = 0.95
SLICES = 200
"""Slices of the scene's height; a level takes two of them, as a scanned floor is not quite flat."""
LARGE = 0.5
"""Share of the largest level's area from which on another may be a floor."""
CEILING_SHARE = 0.3
SLAB = 0.2
"""Thickness of a floor by the largest gap between levels, up to which its upper side is the floor."""
EVEN = 0.15
"""By how much storeys of one house differ in height, and WIDE in area."""
WIDE = 0.25
TABLE = 0.45
"""Height of a table by the largest gap between levels; what is higher is a ceiling."""
NOTABLE = 0.02
"""Share of the ground's area from which on a level on it may be the floor of a house."""
PLOT = 0.5
"""Share of the ground's rectangle up to which a house leaves a garden around it."""
FILLED = 0.5
"""Share of its own rectangle from which on a level is one floor, not many seats of the same height."""
UPRIGHT_COSINE = 0.3
STANDS_ON = 0.8
MAY_STAND_ON = 0.4
"""Share of what is upright that stands on a level, from which on the house does; from which on it may."""
TOP_SHARE = 0.99


class Level(NamedTuple):
    """height: along the axis. area: of the faces there, whichever way they look. upward: area of those that look
    up, less that of those that look down.
    """

    height: float
    area: float
    upward: float


class Storey(NamedTuple):
    """The lowest storey. coverage: the floor's area by that of the rectangle around the scene, at most 1. ground: that
    of the ground which the house stands on, as a lawn; coverage when there is none.

    height: up to the next large level above, or to the scene's top when there is none. below: how far the scene
    reaches below the floor. even: whether all storeys above are as high and as wide. others: heights of other levels
    that might be meant as the floor.
    """

    floor: Level
    coverage: float
    ground: float
    height: float
    below: float
    even: bool
    others: tuple[float, ...]


def lowest_storey(triangles: FloatArray, axis: int) -> Storey | None:
    """The storey of triangles (F, 3, 3), F > 0, when `axis` is up; None when nothing is level."""
    corners = triangles[..., axis]
    areas = areas_of(triangles)
    bottom, top = float(corners.min()), weighted_quantile(corners.max(axis=1), areas, TOP_SHARE)
    levels = _levels(triangles, axis, max(top - bottom, 1e-9))
    if not levels:
        return None
    low = _lowest(levels, top)
    ground = low[-1]
    houses = _houses(levels, ground, top, triangles, axis)
    floor = next((level for level, stands in houses if stands), ground)
    large = [level for level in levels if level.area >= LARGE * floor.area and level.height >= floor.height]
    gaps = _gaps(large, top)
    least = floor.height + TABLE * gaps.max()
    ceilings = [level for level in levels if level.height > least and level.area >= CEILING_SHARE * floor.area]
    height = (ceilings[0].height if ceilings else top) - floor.height
    around = max(float(np.delete(np.ptp(triangles, axis=(0, 1)), axis).prod()), np.finfo(float).tiny)
    lowest = weighted_quantile(corners.min(axis=1), areas, 1.0 - TOP_SHARE)
    even = (
        gaps[gaps > SLAB * gaps.max()].min(initial=gaps.max()) >= (1.0 - EVEN) * gaps.max()
        and min(level.area for level in large) >= (1.0 - WIDE) * floor.area
    )
    # Of those low the one that looks down is the lower side of a slab.
    meant = {level.height for level in low if level.upward > 0.0} | {level.height for level, _ in houses}
    others = tuple(sorted(meant - {floor.height}))
    coverage, covered = (min(1.0, level.area / around) for level in (floor, ground))
    return Storey(floor, coverage, covered, height, floor.height - lowest, bool(even), others)


def level_share(triangles: FloatArray, axis: int) -> float:
    """Share of the area of triangles (F, 3, 3), F > 0, that is level when `axis` is up."""
    upward, areas = _upward_areas(triangles, axis)
    return float(areas[_is_level(upward, areas)].sum() / max(float(areas.sum()), np.finfo(float).tiny))


def _lowest(levels: list[Level], top: float) -> list[Level]:
    """The lowest large level, and those that may be its slab's upper side."""
    large = [level for level in levels if level.area >= LARGE * max(level.area for level in levels)]
    thickest = SLAB * _gaps(large, top).max()
    return [level for level in large if level.height - large[0].height <= thickest]


def _gaps(levels: list[Level], top: float) -> FloatArray:
    """From each level (L,), L > 0, to the next or the scene's top; the largest is about as high as a storey."""
    return np.asarray(np.maximum(np.diff([*(level.height for level in levels), top]), 0.0))


def _houses(
    levels: list[Level], ground: Level, top: float, triangles: FloatArray, axis: int
) -> list[tuple[Level, bool]]:
    """Levels a little above the ground, as a lawn, that may be a house's floor; and whether nearly all stands there."""
    highest = ground.height + SLAB * (top - ground.height)
    raised = [level for level in levels if ground.height < level.height <= highest]
    notable = [level for level in raised if level.area >= NOTABLE * ground.area]
    if not notable:
        return []
    upward, areas = _upward_areas(triangles, axis)
    plan, heights = np.delete(triangles, axis, axis=2), triangles[..., axis].mean(axis=1)
    level_faces, upright = _is_level(upward, areas), np.abs(upward) < UPRIGHT_COSINE * areas
    centres, weights = plan[upright].mean(axis=1), areas[upright] * (heights[upright] > ground.height)
    slice_height = (top - ground.height) / SLICES

    def rectangle(level: Level) -> tuple[FloatArray, FloatArray]:
        corners = plan[level_faces & (np.abs(heights - level.height) <= slice_height)]
        return corners.min(axis=(0, 1)), corners.max(axis=(0, 1))

    plot = float(np.subtract(*rectangle(ground)).prod())
    houses = []
    for level in notable:
        low, high = rectangle(level)
        if level.area < FILLED * (high - low).prod() or (high - low).prod() > PLOT * plot:
            continue
        beside = 0.05 * (high - low)  # where a wall's outer side is
        there = ((centres >= low - beside) & (centres <= high + beside)).all(axis=1)
        standing = float(weights[there & (heights[upright] > level.height)].sum())
        if standing >= MAY_STAND_ON * weights.sum() > 0.0:
            houses.append((level, bool(standing >= STANDS_ON * weights.sum())))
    return houses


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
