"""Lists of stamps: the frames that a SLAM was fed, or the times of a trajectory without any of its own."""

from pathlib import Path

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories.text import ParsedLine, columns, read_table, seconds_to_ns
from slamgym.types import IntArray


def read_stamps(path: Path | str) -> IntArray:
    """Stamps int64 (N,), ns, strictly increasing, from the first column, in seconds, of a file.

    Such as TUM's rgb.txt and associations.txt or KITTI's times.txt; words after the first are ignored, '#' starts a
    comment. Raises TrajectoryError with file and line.
    """
    table = read_table(Path(path), _parse)
    if not len(table.lines):
        raise TrajectoryError(f"{path}: expected lines that start with a stamp, got none")
    if (bad := table.stamps_ns[1:] <= table.stamps_ns[:-1]).any():
        line = table.lines[int(np.argmax(bad)) + 1]
        raise TrajectoryError(f"{path}:{line}: expected increasing stamps, got one not above the last: sort the file")
    return table.stamps_ns


def _parse(text: str) -> ParsedLine:
    return [seconds_to_ns(columns(text.split(maxsplit=1)[0])[0])], []
