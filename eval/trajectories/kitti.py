"""Trajectory files in the format of the KITTI odometry benchmark."""

from pathlib import Path

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories.poses import FilePoses
from slamgym.eval.trajectories.text import ParsedLine, Table, read_table
from slamgym.eval.trajectories.trajectory import are_rigid
from slamgym.eval.trajectories.words import columns, numbers, wrong_columns
from slamgym.geometry import quaternion_xyzw
from slamgym.types import FloatArray

_TOLERANCE = 1e-3


def kitti_poses(path: Path) -> FilePoses:
    """The poses of a file with 12 numbers a line, the upper 3x4 of T_world_cam by rows, metres; without stamps.

    Rotation parts orthonormal within 1e-3 are turned into the nearest rotation; others raise TrajectoryError.
    """
    table = read_table(path, _parse)
    T = np.tile(np.eye(4), (len(table.lines), 1, 1))
    T[:, :3] = table.values.reshape(-1, 3, 4)
    return FilePoses(path, table.lines, table.stamps_ns, T[:, :3, 3], _quaternions(path, table, T))


def _parse(text: str) -> ParsedLine:
    words = columns(text)
    if len(words) != 12:
        raise wrong_columns("kitti", "the 12 columns of a 3x4 matrix", text, len(words))
    return [], numbers(words)


def _quaternions(path: Path, table: Table, T: FloatArray) -> FloatArray:
    """Quaternions (N, 4), NaN where the pose is not finite."""
    finite = np.isfinite(T).all(axis=(1, 2))
    if (bad := finite & ~are_rigid(T, _TOLERANCE)).any():
        raise TrajectoryError(
            f"{path}:{table.lines[np.argmax(bad)]}: expected a rotation matrix in columns 1-3, 5-7 and 9-11, got one "
            f"off by more than {_TOLERANCE:g}: is the pose scaled, mirrored, or written by columns?"
        )
    quaternions = np.full((len(T), 4), np.nan)
    quaternions[finite] = quaternion_xyzw(T[finite])
    return quaternions
