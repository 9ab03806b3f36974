"""Triangles seen from above: cut at heights, and the cells of a raster that they touch."""

from collections.abc import Iterator
from typing import NamedTuple, Self, cast

import numpy as np
from numpy.typing import ArrayLike

from slamgym.errors import SceneError
from slamgym.types import BoolArray, FloatArray, IntArray

MAX_CELLS = 25_000_000
"""Of a raster: a square of 250 m in cells of 0.05 m."""
MAX_SPANS = 20_000_000
"""Of a raster: a span is the cells of one row that one triangle touches."""
SPANS_AT_A_TIME = 100_000
LEVEL = 1e-100
"""Instead of the rise of a level edge: so small that it meets its own row from end to end, and no other."""


class Raster(NamedTuple):
    """Square cells over the ground plane. origin_xy: world position (2,), metres, of the outer corner of cell (0, 0).
    shape: rows along y, columns along x.
    """

    origin_xy: FloatArray
    shape: tuple[int, int]
    resolution_m: float

    @classmethod
    def over(cls, lower: ArrayLike, upper: ArrayLike, resolution_m: float) -> Self:
        """One that covers the world rectangle from `lower` (2,) to `upper` (2,), with a cell or more around it.

        Raises SceneError for more than MAX_CELLS cells, and for bounds that are not finite.
        """
        lower, upper = np.asarray(lower, dtype=np.float64), np.asarray(upper, dtype=np.float64)
        with np.errstate(over="ignore", invalid="ignore"):
            size = upper - lower
            nx, ny = np.ceil(size / resolution_m) + 3
            fits = nx * ny <= MAX_CELLS
        if not fits:  # nor is one of no number
            raise SceneError(
                f"too large: expected at most {MAX_CELLS} cells of {resolution_m} m, got {size[0]:.6g} x "
                f"{size[1]:.6g}; check that it is in metres"
            )
        # Half a cell off, coordinates that are multiples of the resolution do not lie on the border of two cells.
        return cls(lower - 1.5 * resolution_m, (int(ny), int(nx)), resolution_m)

    def touched(self, triangles: FloatArray) -> BoolArray:
        """Cells (ny, nx) that the top view of triangles (F, 3, 3), of finite corners, touches.

        Raises SceneError for more than MAX_SPANS spans: cost goes with the rows of a triangle, not with its area.
        """
        n_rows, n_columns = self.shape
        corners = (triangles[..., :2] - self.origin_xy) / self.resolution_m
        # How many more of the triangles cover a cell than cover the one before it.
        steps = np.zeros((n_rows, n_columns + 1), dtype=np.int32)
        for triangle, row in _spans(corners, self.shape):
            first, last = _reach(corners[triangle], row)
            begin, end = (np.clip(column, 0, n_columns).astype(np.int64) for column in (first, last + 1))
            np.add.at(steps.reshape(-1), row * (n_columns + 1) + begin, 1)
            np.add.at(steps.reshape(-1), row * (n_columns + 1) + end, -1)
        return np.cumsum(steps, axis=1, out=steps)[:, :-1] > 0


def cut(triangles: FloatArray, axis: int, lower: float, upper: float) -> FloatArray:
    """The part of triangles (F, 3, 3) that lies between two world coordinates on an axis, as triangles."""
    from trimesh.intersections import slice_faces_plane  # takes half a second to import

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


def _spans(corners: FloatArray, shape: tuple[int, int]) -> Iterator[tuple[IntArray, IntArray]]:
    """Indices (S,) of triangles (F, 3, 2), in cells, and the rows (S,) that each of them meets, in batches."""
    lower, upper = np.floor(corners.min(axis=1)), np.floor(corners.max(axis=1))
    near = ((upper >= 0) & (lower < shape[::-1])).all(axis=1)
    triangles = np.flatnonzero(near)
    first = np.maximum(lower[near, 1], 0).astype(np.int64)
    counts = np.minimum(upper[near, 1], shape[0] - 1).astype(np.int64) - first + 1
    ends = np.cumsum(counts)
    total = int(ends[-1]) if len(ends) else 0
    if total > MAX_SPANS:
        raise SceneError(
            f"too much detail: expected triangles that meet at most {MAX_SPANS} rows of cells in all, got {total}; "
            "simplify it"
        )
    for start in range(0, total, SPANS_AT_A_TIME):
        span = np.arange(start, min(start + SPANS_AT_A_TIME, total))
        k = np.searchsorted(ends, span, side="right")
        yield triangles[k], first[k] + span - (ends - counts)[k]


def _reach(corners: FloatArray, row: IntArray) -> tuple[FloatArray, FloatArray]:
    """First and last columns (S,), whole numbers, that triangles (S, 3, 2), in cells, touch in one row (S,) each."""
    x, y = np.ascontiguousarray(corners.T)  # (3, S): the edges, each from its corner to the next
    dx, dy = np.roll(x, -1, axis=0) - x, np.roll(y, -1, axis=0) - y
    dy = np.where(dy == 0, LEVEL, dy)
    # Shares of the edges at which they enter and leave the row.
    below, above = (row - y) / dy, (row + 1 - y) / dy
    enter, leave = np.maximum(np.minimum(below, above), 0.0), np.minimum(np.maximum(below, above), 1.0)
    meets = enter <= leave
    ends = x + enter * dx, x + leave * dx
    first = np.where(meets, np.minimum(*ends), np.inf).min(axis=0)
    last = np.where(meets, np.maximum(*ends), -np.inf).max(axis=0)
    return np.floor(first), np.floor(last)
