"""Triangles seen from above: cut at heights, and the cells of a raster that they touch."""

from collections.abc import Iterator
from typing import NamedTuple, Self, cast

import numpy as np
from numpy.typing import ArrayLike
from trimesh.intersections import slice_faces_plane

from slamgym.types import BoolArray, FloatArray

MAX_CELLS = 25_000_000
"""Of a raster: a square of 250 m in cells of 0.05 m."""
SAMPLES_PER_CELL = 2.5
SAMPLES_AT_A_TIME = 1_000_000


class Raster(NamedTuple):
    """Square cells over the ground plane. origin_xy: world position (2,), metres, of the outer corner of cell (0, 0).
    shape: rows along y, columns along x.
    """

    origin_xy: FloatArray
    shape: tuple[int, int]
    resolution_m: float

    @classmethod
    def over(cls, lower: ArrayLike, upper: ArrayLike, resolution_m: float) -> Self:
        """One that covers the world rectangle from `lower` (2,) to `upper` (2,), with a cell or more around it."""
        lower = np.asarray(lower, dtype=np.float64)
        nx, ny = (int(n) for n in np.ceil((upper - lower) / resolution_m) + 3)
        # Half a cell off, coordinates that are multiples of the resolution do not lie on the border of two cells.
        return cls(lower - 1.5 * resolution_m, (ny, nx), resolution_m)

    @property
    def upper_xy(self) -> FloatArray:
        """World position (2,) of the corner opposite the origin."""
        return self.origin_xy + np.array(self.shape[::-1]) * self.resolution_m

    def touched(self, triangles: FloatArray) -> BoolArray:
        """Cells (ny, nx) that the top view of triangles (F, 3, 3) touches, by sampling denser than the cells are."""
        cells = np.zeros(self.shape, dtype=bool)
        for axis in (0, 1):
            triangles = cut(triangles, axis, self.origin_xy[axis], self.upper_xy[axis])
        for xy in _samples(triangles[..., :2], self.resolution_m / SAMPLES_PER_CELL):
            column, row = np.floor((xy - self.origin_xy) / self.resolution_m).astype(np.int64).T
            inside = (row >= 0) & (row < self.shape[0]) & (column >= 0) & (column < self.shape[1])
            cells[row[inside], column[inside]] = True
        return cells


def cut(triangles: FloatArray, axis: int, lower: float, upper: float) -> FloatArray:
    """The part of triangles (F, 3, 3) that lies between two world coordinates on an axis, as triangles."""
    near = (triangles[..., axis].max(axis=1) >= lower) & (triangles[..., axis].min(axis=1) <= upper)
    within = triangles[near]
    crossing = (within[..., axis].min(axis=1) < lower) | (within[..., axis].max(axis=1) > upper)
    vertices = within[crossing].reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    for sign, bound in ((1.0, lower), (-1.0, upper)):
        vertices, faces, _ = slice_faces_plane(  # type: ignore[no-untyped-call]
            vertices, faces, sign * np.eye(3)[axis], bound * np.eye(3)[axis]
        )
    return cast(FloatArray, np.concatenate([within[~crossing], vertices[faces]]))


def _samples(triangles: FloatArray, step_m: float) -> Iterator[FloatArray]:
    """Points (S, 2) on triangles (F, 3, 2), edges included, at most `step_m` apart, in batches.

    They lie on lines parallel to the longest edge, so that a wall, seen from above, costs two lines.
    """
    a, b, c = _longest_edge_first(triangles)
    length = np.linalg.norm(b - a, axis=1)
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    height = np.abs(ux * vy - uy * vx) / np.maximum(length, 1e-12)
    n_along = np.ceil(length / step_m).astype(np.int64) + 1
    n_lines = np.ceil(height / step_m).astype(np.int64) + 1
    ends = np.cumsum(n_along * n_lines)
    for first in range(0, int(ends[-1]) if len(ends) else 0, SAMPLES_AT_A_TIME):
        sample = np.arange(first, min(first + SAMPLES_AT_A_TIME, ends[-1]))
        k = np.searchsorted(ends, sample, side="right")
        line, along = np.divmod(sample - (ends - n_along * n_lines)[k], n_along[k])
        s = (along / np.maximum(n_along[k] - 1, 1))[:, None]
        t = (line / np.maximum(n_lines[k] - 1, 1))[:, None]
        yield a[k] + s * (b - a)[k] + t * ((c - a)[k] - s * (b - a)[k])


def _longest_edge_first(triangles: FloatArray) -> FloatArray:
    """Corners (3, F, 2) of triangles (F, 3, 2), turned so that the first two bound the longest edge."""
    lengths = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
    order = (lengths.argmax(axis=1)[:, None] + np.arange(3)) % 3
    return np.moveaxis(np.take_along_axis(triangles, order[..., None], axis=1), 1, 0)
