"""Where a robot can stand: an occupancy grid of a house, and its free space."""

from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from slamgym.errors import SceneError
from slamgym.scenes.house import House
from slamgym.scenes.indoors import indoors
from slamgym.scenes.rasterise import Raster, cut
from slamgym.types import BoolArray, FloatArray, IntArray

FLOOR_TOLERANCE_M = 0.03
"""The floor is what lies within this distance of z = 0; lower steps, rugs and thresholds are driven over."""
MIN_FREE_AREA_M2 = 1.0
MIN_FLOOR_NORMAL_Z = 0.7


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

    So is all that lies outside the house, where rooms or walls tell what is inside (see `indoors`): the robot stays in.
    Raises SceneError when there is no floor at all, when it is so large that the house cannot be in metres, for corners
    that are not finite, and for more detail than takes seconds.
    """
    try:
        triangles = _solid_triangles(house)
        floor = _floor(triangles)
        raster, inside = indoors(house, resolution_m) or (_over(floor, resolution_m), np.True_)
        occupied = raster.touched(cut(triangles, 2, FLOOR_TOLERANCE_M, robot_height))
        return OccupancyGrid(occupied | ~(raster.touched(floor) & inside), raster.origin_xy, resolution_m)
    except SceneError as error:
        raise SceneError(f"scene {house.name!r}: {error}") from None


def free_space(grid: OccupancyGrid, radius_m: float) -> BoolArray:
    """Cells (ny, nx) where the centre of a round robot can be: the largest connected region that is `radius_m` metres
    away from everything occupied, and from the grid's border.

    Raises SceneError when that region is smaller than 1 m2.
    """
    distance_m = ndimage.distance_transform_edt(np.pad(~grid.occupied, 1), sampling=grid.resolution_m)[1:-1, 1:-1]
    # Half a cell more: what occupies a cell may lie anywhere in it.
    free = distance_m > radius_m + grid.resolution_m / 2
    labels, _ = ndimage.label(free, structure=np.ones((3, 3)))
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
    """Corners (F, 3, 3) of all that a robot bumps into; raises SceneError where one is not finite."""
    corners = [part.vertices[part.faces].astype(np.float64) for part in house.parts if part.solid]
    triangles = np.concatenate([np.zeros((0, 3, 3)), *corners])
    if not np.isfinite(triangles).all():
        raise SceneError("expected corners at finite places, got infinite ones or none at all; repair the scene's mesh")
    return triangles


def _normal_z(triangles: FloatArray) -> FloatArray:
    """Vertical components (F,) of the unit normals; 0 for triangles without area."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return cast(FloatArray, normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-12))


def _floor(triangles: FloatArray) -> FloatArray:
    """What faces up near z = 0, triangles (F, 3, 3); raises SceneError when nothing does."""
    floor = cut(triangles[_normal_z(triangles) > MIN_FLOOR_NORMAL_Z], 2, -FLOOR_TOLERANCE_M, FLOOR_TOLERANCE_M)
    if len(floor) == 0:
        raise SceneError(
            f"no floor: expected an upward-facing surface within {FLOOR_TOLERANCE_M} m of z = 0; "
            "move the scene so that its floor is there"
        )
    return floor


def _over(floor: FloatArray, resolution_m: float) -> Raster:
    return Raster.over(floor[..., :2].min(axis=(0, 1)), floor[..., :2].max(axis=(0, 1)), resolution_m)
