"""Trajectory files in the format of the TUM RGB-D benchmark."""

import math
from decimal import Decimal, InvalidOperation
from pathlib import Path

import numpy as np

from slamgym.errors import OutputError, TrajectoryError, unknown_word
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.geometry import from_quaternion, quaternion_xyzw

_NS_PER_S = 1_000_000_000
_COLUMNS = "timestamp tx ty tz qx qy qz qw"
_MAX_STAMP_NS = 2**63 - 1


def read_tum(path: Path | str, *, repeated_stamps: str = "error") -> Trajectory:
    """Read a file with a pose a line, `timestamp tx ty tz qx qy qz qw` in seconds and metres; '#' starts a comment.

    Stamps are read as decimal numbers, exact to the nanosecond. repeated_stamps: "error", or "last" to keep the last
    pose of one stamp, as the TUM tools do. Raises TrajectoryError with file and line.
    """
    if repeated_stamps not in ("error", "last"):
        raise TrajectoryError(unknown_word("way with repeated stamps", repeated_stamps, ("error", "last")))
    poses: dict[int, tuple[float, ...]] = {}
    last_ns = None
    for number, line in enumerate(_read_lines(Path(path)), start=1):
        text = line.split("#", 1)[0]
        if not text.strip():
            continue
        try:
            stamp_ns, pose = _parse_pose(text)
            _check_order(last_ns, stamp_ns, repeats_allowed=repeated_stamps == "last")
        except ValueError as error:
            raise TrajectoryError(f"{path}:{number}: {error}") from None
        poses[stamp_ns] = pose
        last_ns = stamp_ns
    if not poses:
        raise TrajectoryError(f"{path}: expected lines '{_COLUMNS}', got no pose at all")
    values = np.array(list(poses.values()))
    return Trajectory(np.array(list(poses), dtype=np.int64), from_quaternion(values[:, :3], values[:, 3:]))


def write_tum(path: Path | str, trajectory: Trajectory) -> None:
    """Write a trajectory in the TUM format, stamps exact, 9 decimals throughout; raises OutputError."""
    values = np.hstack([trajectory.positions, quaternion_xyzw(trajectory.T)])
    lines = [f"# {_COLUMNS}\n"]
    for stamp_ns, pose in zip(trajectory.stamps_ns.tolist(), values.tolist(), strict=True):
        lines.append(" ".join([f"{Decimal(stamp_ns).scaleb(-9):.9f}", *(f"{v:.9f}" for v in pose)]) + "\n")
    try:
        Path(path).write_text("".join(lines), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write the trajectory {path}: {error.strerror}") from error


def _read_lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise TrajectoryError(f"cannot read the trajectory {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise TrajectoryError(f"{path}: expected text lines '{_COLUMNS}', got a binary file") from error


def _parse_pose(text: str) -> tuple[int, tuple[float, ...]]:
    words = text.split()
    if len(words) != 8:
        raise ValueError(f"expected the 8 columns '{_COLUMNS}', got {len(words)}")
    pose = tuple(_number(word) for word in words[1:])
    if not any(pose[3:]):
        raise ValueError("expected a rotation as quaternion, got one of length 0")
    return _stamp_ns(words[0]), pose


def _number(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        raise ValueError(f"expected a number, got {word!r}") from None
    if not math.isfinite(value):
        raise ValueError(f"expected a finite number, got {word!r}")
    return value


def _stamp_ns(word: str) -> int:
    """Nanoseconds of a decimal number of seconds; a float would round a Unix time to some 200 ns."""
    try:
        stamp_ns = int((Decimal(word) * _NS_PER_S).to_integral_value())
    except (InvalidOperation, ValueError, OverflowError):
        raise ValueError(f"expected a stamp in seconds, got {word!r}") from None
    if abs(stamp_ns) > _MAX_STAMP_NS:
        raise ValueError(f"expected a stamp in seconds, got {word!r}: is it in nanoseconds?")
    return stamp_ns


def _check_order(last_ns: int | None, stamp_ns: int, *, repeats_allowed: bool) -> None:
    if last_ns is None or stamp_ns > last_ns:
        return
    if stamp_ns < last_ns:
        raise ValueError("expected stamps in increasing order, got one before that of the pose above: sort the file")
    if not repeats_allowed:
        raise ValueError("expected every stamp once, got that of the pose above again: keep one, or read the 'last'")
