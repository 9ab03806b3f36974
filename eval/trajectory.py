"""Trajectories, their files in the format of the TUM RGB-D benchmark, and the association of two of them by time."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path

import numpy as np

from slamgym.errors import OutputError, TrajectoryError, unknown_word
from slamgym.geometry import from_quaternion, quaternion_xyzw
from slamgym.types import FloatArray, IntArray

IndexPair = tuple[IntArray, IntArray]

_NS_PER_S = 1_000_000_000
_COLUMNS = "timestamp tx ty tz qx qy qz qw"
_MAX_STAMP_NS = 2**63 - 1


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Poses over time: stamps_ns int64 (N,), strictly increasing; T float64 (N, 4, 4), T_world_cam or T_map_cam.

    Raises TrajectoryError when the shapes do not fit, a value is not finite, or the stamps do not increase.
    """

    stamps_ns: IntArray
    T: FloatArray

    def __post_init__(self) -> None:
        n = len(self.stamps_ns)
        if self.stamps_ns.dtype != np.int64 or self.stamps_ns.ndim != 1:
            got = f"{self.stamps_ns.dtype} of shape {self.stamps_ns.shape}"
            raise TrajectoryError(f"expected stamps as int64 nanoseconds of shape (N,), got {got}")
        if self.T.shape != (n, 4, 4):
            raise TrajectoryError(f"expected {n} poses of shape ({n}, 4, 4), one a stamp, got shape {self.T.shape}")
        if not np.isfinite(self.T).all():
            bad = int(np.flatnonzero(~np.isfinite(self.T).all(axis=(1, 2)))[0])
            raise TrajectoryError(f"expected finite poses, got NaN or infinity in pose {bad}: leave it out")
        if (steps := np.diff(self.stamps_ns) <= 0).any():
            bad = int(np.argmax(steps)) + 1
            raise TrajectoryError(f"expected strictly increasing stamps, got {self.stamps_ns[bad]} ns at pose {bad}")

    def __len__(self) -> int:
        return len(self.stamps_ns)

    @property
    def positions(self) -> FloatArray:
        """Positions (N, 3), metres."""
        return self.T[:, :3, 3]


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


def associate(ref: Trajectory, est: Trajectory, max_difference_ns: int, convention: str = "tum") -> IndexPair:
    """Indices into `ref` and `est` of the poses that belong together, in the order of time.

    convention: "tum" takes the pairs less than `max_difference_ns` apart, the closest first, each pose once (as
    `associate.py` of the TUM tools); "evo" takes for each pose of the shorter trajectory the nearest of the longer one
    when it is at most `max_difference_ns` away (as evo's `sync`), so a pose of the longer may come up twice.
    Raises TrajectoryError when nothing matches.
    """
    if convention not in _CONVENTIONS:
        raise TrajectoryError(unknown_word("association convention", convention, _CONVENTIONS))
    pair = _CONVENTIONS[convention](ref.stamps_ns, est.stamps_ns, max_difference_ns)
    if not len(pair[0]):
        spans = " and ".join(_span(trajectory.stamps_ns) for trajectory in (ref, est))
        raise TrajectoryError(
            f"expected stamps within {max_difference_ns / _NS_PER_S:g} s of each other, got {spans}: "
            "are both from the same clock and sequence?"
        )
    return pair


def _closest_first(ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int) -> IndexPair:
    first = np.searchsorted(ref_ns, est_ns - max_difference_ns, side="right")
    counts = np.searchsorted(ref_ns, est_ns + max_difference_ns, side="left") - first
    counts = np.maximum(counts, 0)
    est = np.repeat(np.arange(len(est_ns)), counts)
    within = np.arange(len(est)) - np.repeat(np.cumsum(counts) - counts, counts)
    ref = np.repeat(first, counts) + within
    order = np.lexsort((est, ref, np.abs(ref_ns[ref] - est_ns[est])))
    partner: dict[int, int] = {}
    taken: set[int] = set()
    for i, j in zip(ref[order].tolist(), est[order].tolist(), strict=True):
        if i not in partner and j not in taken:
            partner[i] = j
            taken.add(j)
    pairs = np.array(sorted(partner.items()), dtype=np.int64).reshape(-1, 2)
    return pairs[:, 0], pairs[:, 1]


def _nearest_of_longer(ref_ns: IntArray, est_ns: IntArray, max_difference_ns: int) -> IndexPair:
    if len(est_ns) > len(ref_ns):
        return _nearest(ref_ns, est_ns, max_difference_ns)
    est, ref = _nearest(est_ns, ref_ns, max_difference_ns)
    return ref, est


def _nearest(short_ns: IntArray, long_ns: IntArray, max_difference_ns: int) -> IndexPair:
    if not len(long_ns):
        return np.empty(0, np.int64), np.empty(0, np.int64)
    after = np.clip(np.searchsorted(long_ns, short_ns, side="right"), 0, len(long_ns) - 1)
    before = np.maximum(after - 1, 0)
    nearest = np.where(np.abs(long_ns[after] - short_ns) < np.abs(short_ns - long_ns[before]), after, before)
    short = np.flatnonzero(np.abs(long_ns[nearest] - short_ns) <= max_difference_ns)
    return short, nearest[short]


_CONVENTIONS: dict[str, Callable[[IntArray, IntArray, int], IndexPair]] = {
    "tum": _closest_first,
    "evo": _nearest_of_longer,
}


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


def _span(stamps_ns: IntArray) -> str:
    if not len(stamps_ns):
        return "no pose"
    return f"{stamps_ns[0] / _NS_PER_S:.3f} to {stamps_ns[-1] / _NS_PER_S:.3f} s"
