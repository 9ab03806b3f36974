"""Which part of the ground is inside a house, where a scene shows a garden or a ground plane around it."""

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from slamgym.errors import SceneError
from slamgym.scenes.house import House
from slamgym.scenes.rasterise import Raster, cut
from slamgym.types import BoolArray, FloatArray

WALL_HEIGHTS_M = (1.8, 2.1)
"""Where walls are looked for: above fences and most furniture, below eaves, and high enough to meet most lintels."""
SIDES_ENCLOSED = 6
"""Of eight: a straight line through two open doors may miss the walls."""
MIN_ENCLOSED_M2 = 8.0
MIN_SHARE_OF_BOUNDS = 0.25
"""What encloses less is furniture, or walls on a few sides of a stage: then the whole floor counts."""
WALL_THICKNESS_M = 0.6


def indoors(house: House, resolution_m: float) -> tuple[Raster, BoolArray] | None:
    """A raster over the house, and the cells (ny, nx) of it that are in a room, or have walls on most sides.

    None where neither rooms nor walls tell what is inside. Raises SceneError for walls of too much detail.
    """
    corners = [part.vertices[part.faces].astype(np.float64) for part in house.parts]
    walls = cut(np.concatenate([np.zeros((0, 3, 3)), *corners]), 2, *WALL_HEIGHTS_M)
    bounds = np.array([(room.x_min, room.y_min, room.x_max, room.y_max) for room in house.rooms]).reshape(-1, 4)
    points = np.concatenate([walls[..., :2].reshape(-1, 2), bounds.reshape(-1, 2)])
    if len(points) == 0:
        return None
    try:
        raster = Raster.over(points.min(axis=0), points.max(axis=0), resolution_m)
    except SceneError:  # the sky as a dome: it tells nothing, and the floor may still be of a house's size
        return None
    inside = _within(bounds, raster) | _enclosed(raster.touched(walls), resolution_m)
    # The ground between two rooms is that under a wall, or in a doorway.
    return (raster, _closed(inside, WALL_THICKNESS_M / resolution_m)) if inside.any() else None


def _within(bounds: FloatArray, raster: Raster) -> BoolArray:
    """Cells (ny, nx) whose centres are in one of the rectangles (R, 4): x_min, y_min, x_max, y_max."""
    x, y = (raster.origin_xy[axis] + (np.arange(raster.shape[1 - axis]) + 0.5) * raster.resolution_m for axis in (0, 1))
    x_min, y_min, x_max, y_max = bounds.T
    left, bottom = np.searchsorted(x, x_min), np.searchsorted(y, y_min)
    right = np.maximum(np.searchsorted(x, x_max, side="right"), left)
    top = np.maximum(np.searchsorted(y, y_max, side="right"), bottom)
    # Counted at corners and summed up, so that a thousand rooms cost no more than one.
    counts = np.zeros((len(y) + 1, len(x) + 1), dtype=np.int32)
    for row, column, step in ((bottom, left, 1), (bottom, right, -1), (top, left, -1), (top, right, 1)):
        np.add.at(counts, (row, column), step)
    return counts.cumsum(axis=0).cumsum(axis=1)[:-1, :-1] > 0


def _enclosed(walls: BoolArray, resolution_m: float) -> BoolArray:
    """Cells (ny, nx) with a wall on most sides; none where that is too little for a house."""
    sides = np.zeros(walls.shape, dtype=np.int8)
    for flip in (1, -1):
        sides[:, ::flip].T[...] += _behind(walls[:, ::flip].T, 0)
        for shift in (-1, 0, 1):
            sides[::flip] += _behind(walls[::flip], shift)
    enclosed = (sides >= SIDES_ENCLOSED) | walls
    size = np.count_nonzero(enclosed)
    enough = size * resolution_m**2 >= MIN_ENCLOSED_M2 and size >= MIN_SHARE_OF_BOUNDS * walls.size
    return enclosed if enough else np.zeros_like(walls)


def _behind(walls: BoolArray, shift: int) -> NDArray[np.int8]:
    """1 for cells (ny, nx) with a wall in an earlier row, on the line that moves `shift` columns a row; 0 elsewhere."""
    behind = np.zeros(walls.shape, dtype=np.int8)
    for row in range(1, len(walls)):
        before = np.pad(behind[row - 1] | walls[row - 1], 1)
        behind[row] = before[1 - shift : len(before) - 1 - shift]
    return behind


def _closed(cells: BoolArray, width: float) -> BoolArray:
    """The cells, and those in gaps of up to `width` cells between them."""
    size = 2 * round(width / 2) + 1
    padded = np.pad(cells, size)
    closed = ndimage.grey_closing(padded.astype(np.uint8), size=(size, size)).astype(bool)
    return closed[size:-size, size:-size]
