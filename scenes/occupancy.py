"""Where a robot can stand: an occupancy grid of a house, and its free space."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage
from trimesh.intersections import slice_faces_plane

from slamgym.errors import SceneError
from slamgym.scenes.house import House
from slamgym.types import BoolArray, FloatArray, IntArray

FLOOR_TOLERANCE_M = 0.03
"""The floor is what lies within this distance of z = 0; lower steps, rugs and thresholds are driven over."""
MIN_FREE_AREA_M2 = 1.0
MAX_CELLS = 25_000_000
MIN_FLOOR_NORMAL_Z = 0.7
SAMPLES_PER_CELL = 2.5
SAMPLES_AT_A_TIME = 1_000_000


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """Top view of a house. occupied: bool (ny, nx), row along y and column along x. origin_xy: world position (2,),
    metres, of the outer corner of cell (0, 0). resolution_m: side of a cell.
    """

    occupied: BoolArray
    origin_xy: FloatArray
    resolution_m: float

    def cell_of(self, xy: ArrayLike) -> IntArray:
        """Cells (..., 2), row and column, that world points (..., 2) lie in; points outside give cells outside."""
        cell_xy = np.floor((np.asarray(xy, dtype=np.float64) - self.origin_xy) / self.resolution_m)
        return cast(IntArray, cell_xy[..., ::-1].astype(np.int64))

    def centre_of(self, cells: ArrayLike) -> FloatArray:
        """World positions (..., 2), metres, of the centres of cells (..., 2) given as row and column."""
        cell_xy = np.asarray(cells, dtype=np.float64)[..., ::-1]
        return self.origin_xy + (cell_xy + 0.5) * self.resolution_m


def occupancy_grid(house: House, robot_height: float, resolution_m: float = 0.05) -> OccupancyGrid:
    """Grid over the floor of `house`: a cell is occupied when something solid is in the robot's way, between 0.03 m and
    `robot_height` metres above it, or when there is no floor within 0.03 m of z = 0.

    Raises SceneError when there is no floor at all, or one so large that the house cannot be in metres.
    """
    triangles = _solid_triangles(house)
    floor = _clip(triangles[_normal_z(triangles) > MIN_FLOOR_NORMAL_Z], -FLOOR_TOLERANCE_M, FLOOR_TOLERANCE_M)
    origin_xy, shape = _extent(floor, resolution_m, house.name)
    obstacles = _clip(triangles, FLOOR_TOLERANCE_M, robot_height)
    touched = _rasterise(obstacles, origin_xy, shape, resolution_m)
    supported = _rasterise(floor, origin_xy, shape, resolution_m)
    return OccupancyGrid(touched | ~supported, origin_xy, resolution_m)


def free_space(grid: OccupancyGrid, radius_m: float) -> BoolArray:
    """Cells (ny, nx) where the centre of a round robot can be: the largest connected region that is `radius_m` metres
    away from everything occupied.

    Raises SceneError when that region is smaller than 1 m2.
    """
    # Half a cell more: what occupies a cell may lie anywhere in it.
    free = ndimage.distance_transform_edt(~grid.occupied, sampling=grid.resolution_m) > radius_m + grid.resolution_m / 2
    labels, _ = ndimage.label(free)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    area_m2 = sizes.max() * grid.resolution_m**2
    if area_m2 < MIN_FREE_AREA_M2:
        floor_m2 = np.count_nonzero(~grid.occupied) * grid.resolution_m**2
        raise SceneError(
            f"no room for the robot: expected at least {MIN_FREE_AREA_M2} m2 of connected space for a robot of radius "
            f"{radius_m} m, got {area_m2:.2f} m2 out of {floor_m2:.2f} m2 of unobstructed floor; "
            "check the scene's scale and that its floor is at z = 0"
        )
    return cast(BoolArray, labels == sizes.argmax())


def _solid_triangles(house: House) -> FloatArray:
    """Corners (F, 3, 3) of all that a robot bumps into."""
    corners = [part.vertices[part.faces].astype(np.float64) for part in house.parts if part.solid]
    return np.concatenate(corners) if corners else np.zeros((0, 3, 3))


def _normal_z(triangles: FloatArray) -> FloatArray:
    """Vertical components (F,) of the unit normals; 0 for triangles without area."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return cast(FloatArray, normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-12))


def _clip(triangles: FloatArray, z_min: float, z_max: float) -> FloatArray:
    """The part of triangles (F, 3, 3) with z_min <= z <= z_max, as triangles."""
    near = (triangles[..., 2].max(axis=1) >= z_min) & (triangles[..., 2].min(axis=1) <= z_max)
    vertices = triangles[near].reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    for normal_z, z in ((1.0, z_min), (-1.0, z_max)):
        vertices, faces, _ = slice_faces_plane(  # type: ignore[no-untyped-call]
            vertices, faces, (0.0, 0.0, normal_z), (0.0, 0.0, z)
        )
    return cast(FloatArray, vertices[faces])


def _extent(floor: FloatArray, resolution_m: float, name: str) -> tuple[FloatArray, tuple[int, int]]:
    """Origin and shape of a grid over the floor, with a margin of a cell or more that stays occupied."""
    if len(floor) == 0:
        raise SceneError(
            f"no floor in scene {name!r}: expected an upward-facing surface within {FLOOR_TOLERANCE_M} m of z = 0; "
            "move the scene so that its floor is there"
        )
    lower, upper = floor[..., :2].min(axis=(0, 1)), floor[..., :2].max(axis=(0, 1))
    nx, ny = (int(n) for n in np.ceil((upper - lower) / resolution_m) + 3)
    if nx * ny > MAX_CELLS:
        raise SceneError(
            f"scene {name!r} is too large: expected at most {MAX_CELLS} cells of {resolution_m} m, got a floor of "
            f"{upper[0] - lower[0]:.0f} x {upper[1] - lower[1]:.0f}; check that it is in metres"
        )
    # Half a cell off, coordinates that are multiples of the resolution do not lie on the border of two cells.
    return lower - 1.5 * resolution_m, (ny, nx)


def _rasterise(triangles: FloatArray, origin_xy: FloatArray, shape: tuple[int, int], resolution_m: float) -> BoolArray:
    """Cells (ny, nx) that the top view of triangles (F, 3, 3) touches, by sampling denser than the cells are."""
    cells = np.zeros(shape, dtype=bool)
    for xy in _samples(triangles[..., :2], resolution_m / SAMPLES_PER_CELL):
        column, row = np.floor((xy - origin_xy) / resolution_m).astype(np.int64).T
        inside = (row >= 0) & (row < shape[0]) & (column >= 0) & (column < shape[1])
        cells[row[inside], column[inside]] = True
    return cells


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
