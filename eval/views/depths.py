"""What a depth image offers. `depth` is (H, W), metres along the optical axis, 0 where nothing was measured."""

import numpy as np
from numpy.typing import NDArray

from slamgym.camera import PinholeCamera
from slamgym.geometry import inverse
from slamgym.types import BoolArray, FloatArray

DepthImage = NDArray[np.float32]


def valid_depth(depth: DepthImage) -> float:
    """Share of the pixels with a depth, 0 to 1."""
    return float(_measured(depth).mean())


def median_depth_m(depth: DepthImage) -> float:
    """Median over the pixels with a depth, metres; NaN without any."""
    values = depth[_measured(depth)]
    return float(np.median(values)) if len(values) else np.nan


def overlap(
    depth_before: DepthImage,
    T_world_cam_before: FloatArray,
    T_world_cam_now: FloatArray,
    camera: PinholeCamera,
    step: int = 1,
) -> float:
    """Share of what the camera saw before that is still in view, 0 to 1.

    Of the pixels with a depth in `depth_before`, the share whose points fall into the image taken from
    `T_world_cam_now`, in front of the camera. depth_before: (H, W), or every `step`-th pixel of every `step`-th row of
    it. Occlusion and the distortion of the lens are ignored. NaN without any depth, and unless both poses (4, 4) are
    finite.
    """
    measured = _measured(depth_before)
    if not (measured.any() and np.isfinite([T_world_cam_before, T_world_cam_now]).all()):
        return np.nan
    v, u = np.nonzero(measured)
    points_before = _back_project(u * step, v * step, depth_before[measured], camera)
    T_now_before = inverse(T_world_cam_now) @ T_world_cam_before
    return _share_in_view(points_before @ T_now_before[:3, :3].T + T_now_before[:3, 3], camera)


def _measured(depth: DepthImage) -> BoolArray:
    return np.isfinite(depth) & (depth > 0)


def _back_project(u: NDArray[np.integer], v: NDArray[np.integer], z: DepthImage, camera: PinholeCamera) -> FloatArray:
    """Points (N, 3) in the camera's frame of N pixels with depths."""
    return np.column_stack([(u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z]).astype(np.float64)


def _share_in_view(points: FloatArray, camera: PinholeCamera) -> float:
    """Share of the points (N, 3), in the camera's frame, that its image shows, to the outer edges of its pixels."""
    x, y, z = points[points[:, 2] > 0].T
    u, v = x / z * camera.fx + camera.cx, y / z * camera.fy + camera.cy
    left, top = u + 0.5, v + 0.5
    in_view = (left >= 0) & (left <= camera.width) & (top >= 0) & (top <= camera.height)
    return float(in_view.sum() / len(points))
