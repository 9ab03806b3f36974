"""Poses as a file holds them, and how they become a trajectory: refused or repaired, never silently."""

import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np

from slamgym.errors import TrajectoryError, TrajectoryWarning
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.geometry import from_quaternion
from slamgym.types import BoolArray, FloatArray, IntArray

_NORM_TOLERANCE = 0.01


class FilePoses(NamedTuple):
    """The poses of a file, unchecked: a line number, stamp, position (3,) in metres and quaternion (4,) xyzw each.

    The stamps are empty until they are known, for a format that has none.
    in_ns: the stamps were nanoseconds in a file whose format wants seconds.
    """

    path: Path
    lines: IntArray
    stamps_ns: IntArray
    positions: FloatArray
    quaternions: FloatArray
    in_ns: bool = False

    def take(self, rows: BoolArray | IntArray) -> "FilePoses":
        return self._replace(
            lines=self.lines[rows],
            stamps_ns=self.stamps_ns[rows],
            positions=self.positions[rows],
            quaternions=self.quaternions[rows],
        )


_MAX_POSITION_M = 1e9
_SHORTEST_STEP_NS = 50_000


class _Fault(NamedTuple):
    expected: str
    got: str
    repair: str


_IN_NS = _Fault("stamps in seconds", "stamps in nanoseconds", "taken as nanoseconds")
_NOT_FINITE = _Fault("finite numbers", "NaN or infinity", "pose left out as not tracked")
_TOO_FAR = _Fault("positions within 1e9 m", "one farther away", "pose left out as not tracked")
_NO_ROTATION = _Fault("a rotation as unit quaternion", "one of length 0", "pose left out as not tracked")
_WRONG_NORM = _Fault("a rotation as unit quaternion", "one whose length is off by more than 1 %", "normalised")
_UNSORTED = _Fault("stamps in increasing order", "one before that of the pose above", "sorted")
_REPEATED = _Fault("every stamp once", "one that comes again", "last pose of the file kept")


def to_trajectory(poses: FilePoses, *, repair: bool, allow_empty: bool = False) -> Trajectory:
    """The trajectory of a file's poses.

    Stamps in nanoseconds for seconds, NaN and infinity, positions beyond 1e9 m, quaternions of length 0 or more than
    1 % off 1, unsorted and repeated stamps raise a TrajectoryError; with `repair` they are repaired, with one
    TrajectoryWarning for each kind: poses left out first, so that of poses at one stamp the last usable one stays.
    No pose raises TrajectoryError unless `allow_empty`.
    """
    poses = _with_usable_numbers(poses, repair)
    poses = _in_order(poses, repair)
    if not len(poses.lines) and not allow_empty:
        raise TrajectoryError(f"{poses.path}: expected lines with poses, got no pose at all: was it ever tracked?")
    _check_unit(poses)
    return Trajectory(poses.stamps_ns, from_quaternion(poses.positions, poses.quaternions))


def _check_unit(poses: FilePoses) -> None:
    """Nanoseconds are told by their size, which microseconds have too; but no camera takes 20,000 frames a second."""
    steps_ns = np.diff(poses.stamps_ns)
    if poses.in_ns and len(steps_ns) and np.median(steps_ns) < _SHORTEST_STEP_NS:
        raise TrajectoryError(
            f"{poses.path}: expected stamps in seconds or nanoseconds, got some {np.median(steps_ns):.0f} apart: are "
            "they in microseconds? Write them in seconds"
        )


def _with_usable_numbers(poses: FilePoses, repair: bool) -> FilePoses:
    _tell(poses, np.full(len(poses.lines), poses.in_ns), _IN_NS, repair)
    finite = np.asarray(np.isfinite(np.hstack([poses.positions, poses.quaternions])).all(axis=1))
    _tell(poses, ~finite, _NOT_FINITE, repair)
    poses = poses.take(finite)
    far = np.asarray((np.abs(poses.positions) > _MAX_POSITION_M).any(axis=1))
    _tell(poses, far, _TOO_FAR, repair)
    poses = poses.take(~far)
    # Divided by the largest component first: squares of very large or small numbers leave the range of floats.
    size = np.abs(poses.quaternions).max(axis=1, initial=0.0)
    _tell(poses, size == 0, _NO_ROTATION, repair)
    poses, size = poses.take(size > 0), size[size > 0]
    scaled = poses.quaternions / size[:, None]
    with np.errstate(over="ignore"):
        norm = size * np.linalg.norm(scaled, axis=1)
    _tell(poses, np.abs(norm - 1) > _NORM_TOLERANCE, _WRONG_NORM, repair)
    return poses._replace(quaternions=scaled)


def _in_order(poses: FilePoses, repair: bool) -> FilePoses:
    back = np.diff(poses.stamps_ns, prepend=poses.stamps_ns[:1]) < 0
    _tell(poses, back, _UNSORTED, repair)
    poses = poses.take(np.argsort(poses.stamps_ns, kind="stable"))
    same = np.diff(poses.stamps_ns) == 0
    _tell(poses, np.append(np.zeros(1, bool), same)[: len(poses.lines)], _REPEATED, repair)
    return poses.take(np.append(~same, np.ones(1, bool))[: len(poses.lines)])


def _tell(poses: FilePoses, bad: BoolArray, fault: _Fault, repair: bool) -> None:
    """Raise, or warn that it is repaired, when a pose is bad."""
    if not bad.any():
        return
    line = poses.lines[np.argmax(bad)]
    problem = f"{poses.path}:{line}: expected {fault.expected}, got {fault.got}"
    if not repair:
        raise TrajectoryError(f"{problem}; correct the file, or have it repaired ({fault.repair})")
    message = f"{problem} ({np.count_nonzero(bad)} of {len(poses.lines)} lines); {fault.repair}"
    warnings.warn(message, TrajectoryWarning, stacklevel=5)
