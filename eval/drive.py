"""How a drive went: how fast the robot really was, and how close it kept to its path."""

from itertools import pairwise

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import BoolArray, FloatArray, IntArray, Summary

FULL_SPEED = 0.9
"""A robot at this share of the commanded speed or more counts as driving at it."""
REACHED_SHARE = 0.1
"""A drive reached its speed when at least this share of its distance was driven at it."""


def summarize_drive(
    stamps_ns: IntArray, T_world_cam: FloatArray, path_xy: FloatArray, commanded_speed: float
) -> Summary:
    """What was really driven, in JSON types; NaN where fewer than two poses, or no motion at all, tell nothing.

    stamps_ns: int64 (N,), increasing. T_world_cam: true poses (N, 4, 4). path_xy: planned path (P, 2), metres.
    commanded_speed: m/s. All distances are those on the floor.

    - `distance_m`, `duration_s`; `turning_deg`: sum of the absolute changes of heading.
    - `speed_median_mps`, `speed_p95_mps`: over time, turning on the spot included.
    - `speed_reached_share`: share of the distance at 0.9 of the commanded speed or more; `speed_reached`: whether that
      is at least 0.1.
    - `path_deviation_max_m`: largest distance of the robot from the path.

    Raises TrajectoryError when the arrays do not fit together.
    """
    if T_world_cam.shape != (len(stamps_ns), 4, 4) or path_xy.ndim != 2 or path_xy.shape[1] != 2 or not len(path_xy):
        got = f"{stamps_ns.shape}, {T_world_cam.shape} and {path_xy.shape}"
        raise TrajectoryError(f"drive: expected stamps (N,), poses (N, 4, 4) and a path (P, 2), got {got}")
    robot_xy = T_world_cam[:, :2, 3]
    step_m = _length(np.diff(robot_xy, axis=0))
    step_s = np.diff(stamps_ns) * 1e-9
    speed = step_m / step_s
    share = _share(step_m, speed >= FULL_SPEED * commanded_speed)
    return {
        "distance_m": float(step_m.sum()),
        "duration_s": float(step_s.sum()),
        "turning_deg": float(np.rad2deg(np.abs(_heading_changes(T_world_cam)).sum())),
        "speed_median_mps": float(np.median(speed)) if len(speed) else np.nan,
        "speed_p95_mps": float(np.percentile(speed, 95)) if len(speed) else np.nan,
        "speed_reached_share": share,
        "speed_reached": share >= REACHED_SHARE,
        "path_deviation_max_m": float(distance_to_path(robot_xy, path_xy).max(initial=0.0)),
    }


def distance_to_path(points: FloatArray, path: FloatArray) -> FloatArray:
    """Distances (N,) of points (N, 2) from the polyline through the points `path` (P, 2), P of 1 or more."""
    nearest = _length(points - path[0])
    for start, end in pairwise(path):
        nearest = np.minimum(nearest, _distance_to_segment(points, start, end))
    return nearest


def _distance_to_segment(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    along = end - start
    length_sq = max(float(along @ along), np.finfo(np.float64).tiny)
    foot = start + np.clip((points - start) @ along / length_sq, 0.0, 1.0)[:, None] * along
    return _length(points - foot)


def _length(vectors: FloatArray) -> FloatArray:
    return np.hypot(vectors[:, 0], vectors[:, 1])


def _share(step_m: FloatArray, chosen: BoolArray) -> float:
    distance_m = step_m.sum()
    return float(step_m[chosen].sum() / distance_m) if distance_m > 0 else np.nan


def _heading_changes(T_world_cam: FloatArray) -> FloatArray:
    """Changes of heading from pose to pose (N - 1,), radians in [-pi, pi); the camera looks along its z axis."""
    heading = np.arctan2(T_world_cam[:, 1, 2], T_world_cam[:, 0, 2])
    return (np.diff(heading) + np.pi) % (2 * np.pi) - np.pi
