"""Trajectory files of all formats."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, unknown_word
from slamgym.eval.trajectories.euroc import euroc_poses
from slamgym.eval.trajectories.kitti import kitti_poses
from slamgym.eval.trajectories.poses import FilePoses, to_trajectory
from slamgym.eval.trajectories.stamps import read_stamps
from slamgym.eval.trajectories.text import first_data_line
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.eval.trajectories.tum import tum_poses
from slamgym.eval.trajectories.words import format_of, quoted


class _Format(NamedTuple):
    read: Callable[[Path], FilePoses]
    has_stamps: bool


FORMATS = {
    "tum": _Format(tum_poses, has_stamps=True),
    "kitti": _Format(kitti_poses, has_stamps=False),
    "euroc": _Format(euroc_poses, has_stamps=True),
}


def read_trajectory(
    path: Path | str,
    format: str | None = None,  # noqa: A002 - the word that users look for
    *,
    times: Path | str | None = None,
    repair: bool = False,
    allow_empty: bool = False,
) -> Trajectory:
    """Read a trajectory file of at most 5,000,000 lines; metres and, in the trajectory, nanoseconds.

    format: one of FORMATS, None to tell it by the content (`guess_format`).
        "tum": `timestamp tx ty tz qx qy qz qw` a line, seconds.
        "kitti": the 12 numbers of the upper 3x4 of T_world_cam by rows, `times` names the file with their seconds.
        "euroc": `timestamp,x,y,z,qw,qx,qy,qz[,...]`, nanoseconds, with or without a header.
    repair: NaN, infinity, positions beyond 1e9 m, quaternions of length 0 or more than 1 % off 1, unsorted and repeated
        stamps, and nanoseconds in a TUM file are errors; with `repair` there is one TrajectoryWarning for each kind
        instead, and such poses are left out (not finite, too far, length 0), normalised, sorted, or taken as
        nanoseconds; of repeated stamps the last pose is kept, as the TUM tools do. That comes after the leaving out: a
        valid pose stays even where one that is not finite follows at the same stamp.
    allow_empty: a file without a pose, which a SLAM that never initialised writes, is an empty trajectory.
    Raises TrajectoryError with file and line, ConfigError for an unknown format.
    """
    path = Path(path)
    if format is not None and format not in FORMATS:
        raise ConfigError(unknown_word("trajectory format", format, FORMATS))
    if allow_empty and first_data_line(path) is None:
        return Trajectory(np.empty(0, np.int64), np.empty((0, 4, 4)))
    read, has_stamps = FORMATS[format or guess_format(path)]
    if has_stamps and times is not None:
        raise TrajectoryError(f"{path}: expected no times, its format has stamps; got {times}: leave it out")
    if not has_stamps and times is None:
        raise TrajectoryError(
            f"{path}: expected times too, its format has no stamps; got none: name the file with the seconds of its "
            "poses, such as KITTI's times.txt"
        )
    poses = read(path) if times is None else _with_times(read(path), Path(times))
    return to_trajectory(poses, repair=repair, allow_empty=allow_empty)


def guess_format(path: Path | str) -> str:
    """One of FORMATS, by the first data line: commas, 8 or 12 columns; the file's name does not count.

    Raises TrajectoryError when there is none, or it looks like none of them.
    """
    line = first_data_line(Path(path))
    if line is None:
        raise TrajectoryError(f"{path}: expected lines with poses, got no pose at all: was it ever tracked?")
    if (name := format_of(line)) is None:
        raise TrajectoryError(
            f"{path}: expected 8 columns (tum), 12 (kitti) or commas (euroc), got {len(line.split())} columns: "
            f"{quoted(line)}; is it a trajectory? Write it as one of {', '.join(FORMATS)}"
        )
    return name


def needs_times(path: Path | str) -> bool:
    """Whether `read_trajectory` needs `times` for the file: its guessed format has no stamps of its own.

    False for a file without a pose. Raises TrajectoryError when the file looks like no format.
    """
    return first_data_line(Path(path)) is not None and not FORMATS[guess_format(path)].has_stamps


def _with_times(poses: FilePoses, times: Path) -> FilePoses:
    stamps_ns = read_stamps(times)
    if len(stamps_ns) != len(poses.lines):
        raise TrajectoryError(
            f"{poses.path}: expected a pose for each of the {len(stamps_ns)} stamps of {times}, "
            f"got {len(poses.lines)}: are both from the same run?"
        )
    return poses._replace(stamps_ns=stamps_ns)
