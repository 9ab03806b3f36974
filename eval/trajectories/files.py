"""Trajectory files of all formats."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from slamgym.errors import ConfigError, TrajectoryError, unknown_word
from slamgym.eval.trajectories.euroc import euroc_poses
from slamgym.eval.trajectories.kitti import kitti_poses
from slamgym.eval.trajectories.poses import FilePoses, to_trajectory
from slamgym.eval.trajectories.text import first_data_line, format_of, shorten
from slamgym.eval.trajectories.trajectory import Trajectory
from slamgym.eval.trajectories.tum import tum_poses

_Reader = Callable[[Path, Path | None], FilePoses]


def _with_own_stamps(read: Callable[[Path], FilePoses]) -> _Reader:
    def reader(path: Path, times: Path | None) -> FilePoses:
        if times is not None:
            raise TrajectoryError(f"{path}: expected no times, its format has stamps; got {times}: leave it out")
        return read(path)

    return reader


def _with_times(read: Callable[[Path, Path], FilePoses]) -> _Reader:
    def reader(path: Path, times: Path | None) -> FilePoses:
        if times is None:
            raise TrajectoryError(
                f"{path}: expected a file of times too, its format has no stamps; give times=, a file with the seconds "
                "of each pose (KITTI's times.txt)"
            )
        return read(path, times)

    return reader


FORMATS: dict[str, _Reader] = {
    "tum": _with_own_stamps(tum_poses),
    "kitti": _with_times(kitti_poses),
    "euroc": _with_own_stamps(euroc_poses),
}


def read_trajectory(
    path: Path | str,
    format: str | None = None,  # noqa: A002 - the word that users look for
    *,
    times: Path | str | None = None,
    repair: bool = False,
    allow_empty: bool = False,
) -> Trajectory:
    """Read a trajectory file; metres and, in the trajectory, nanoseconds.

    format: one of FORMATS, None to tell it by the content (`guess_format`).
        "tum": `timestamp tx ty tz qx qy qz qw` a line, seconds.
        "kitti": the 12 numbers of the upper 3x4 of T_world_cam by rows, `times` names the file with their seconds.
        "euroc": `timestamp,x,y,z,qw,qx,qy,qz[,...]`, nanoseconds, with or without a header.
    repair: NaN, infinity, quaternions of length 0 or more than 1 % off 1, unsorted and repeated stamps, and
        nanoseconds in a TUM file are errors; with `repair` there is one TrajectoryWarning for each kind instead, and
        such poses are left out (not finite, length 0), normalised, sorted, or taken as nanoseconds; of repeated stamps
        the last pose is kept, as the TUM tools do.
    allow_empty: a file without a pose, which a SLAM that never initialised writes, is an empty trajectory.
    Raises TrajectoryError with file and line, ConfigError for an unknown format.
    """
    path = Path(path)
    if format is not None and format not in FORMATS:
        raise ConfigError(unknown_word("trajectory format", format, FORMATS))
    if allow_empty and first_data_line(path) is None:
        return Trajectory(np.empty(0, np.int64), np.empty((0, 4, 4)))
    poses = FORMATS[format or guess_format(path)](path, None if times is None else Path(times))
    return to_trajectory(poses, repair=repair, allow_empty=allow_empty)


def guess_format(path: Path | str) -> str:
    """One of FORMATS, by the first data line: commas, 8 or 12 columns; the file's name does not count.

    Raises TrajectoryError when it looks like none of them.
    """
    line = first_data_line(Path(path))
    if line is None:
        raise TrajectoryError(f"{path}: expected lines with poses, got no pose at all: was it ever tracked?")
    if (name := format_of(line)) is None:
        raise TrajectoryError(
            f"{path}: expected 8 columns (tum), 12 (kitti) or commas (euroc), got {len(line.split())} columns: "
            f"{shorten(line)}; give format=, one of {', '.join(FORMATS)}"
        )
    return name
