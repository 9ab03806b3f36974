"""Trajectory files in the format of the TUM RGB-D benchmark."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from slamgym.errors import OutputError
from slamgym.eval.trajectories.poses import FilePoses, to_trajectory
from slamgym.eval.trajectories.stamp_words import (
    MAX_NANOSECONDS,
    SMALLEST_NANOSECONDS,
    seconds_to_ns,
    seconds_word,
    whole_ns,
)
from slamgym.eval.trajectories.text import ParsedLine, first_data_line, read_table
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.eval.trajectories.words import columns, numbers, quoted, wrong_columns
from slamgym.geometry import quaternion_xyzw

_COLUMNS = "timestamp tx ty tz qx qy qz qw"


def read_tum(path: Path | str, *, repair: bool = False) -> Trajectory:
    """Read a file with a pose a line, `timestamp tx ty tz qx qy qz qw` in seconds and metres; '#' starts a comment.

    As `read_trajectory` does with format "tum". Raises TrajectoryError with file and line.
    """
    return to_trajectory(tum_poses(Path(path)), repair=repair)


def tum_poses(path: Path) -> FilePoses:
    """The poses of a TUM file as they are; stamps exact to the nanosecond.

    When the first stamp can only be in nanoseconds (ORB-SLAM3's EuRoC program writes such files), all have to be.
    """
    in_ns = _starts_in_ns(path)
    table = read_table(path, partial(_parse, _large_ns if in_ns else seconds_to_ns))
    values = table.values.reshape(-1, 7)
    return FilePoses(path, table.lines, table.stamps_ns, values[:, :3], values[:, 3:], in_ns)


def write_tum(path: Path | str, trajectory: Trajectory) -> None:
    """Write a trajectory in the TUM format, stamps exact, 9 decimals throughout; raises OutputError."""
    values = np.hstack([trajectory.positions, quaternion_xyzw(trajectory.T)])
    lines = [f"# {_COLUMNS}\n"]
    for stamp_ns, pose in zip(trajectory.stamps_ns.tolist(), values.tolist(), strict=True):
        lines.append(" ".join([seconds_word(stamp_ns), *(f"{v:.9f}" for v in pose)]) + "\n")
    try:
        Path(path).write_text("".join(lines), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write the trajectory {path}: {error.strerror}") from error


def _parse(stamp: Callable[[str], int], text: str) -> ParsedLine:
    words = columns(text)
    if len(words) != 8:
        raise wrong_columns("tum", f"the 8 columns '{_COLUMNS}'", text, len(words))
    return [stamp(words[0])], numbers(words[1:])


def _starts_in_ns(path: Path) -> bool:
    try:
        return SMALLEST_NANOSECONDS <= abs(float((first_data_line(path) or "0").split()[0])) < MAX_NANOSECONDS
    except ValueError:
        return False


def _large_ns(word: str) -> int:
    stamp_ns = whole_ns(word)
    if abs(stamp_ns) < SMALLEST_NANOSECONDS:
        raise ValueError(f"expected a stamp in nanoseconds like the first one of the file, got {quoted(word)}")
    return stamp_ns
