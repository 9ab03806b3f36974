"""Lists of stamps: the frames that a SLAM was fed, or the times of a trajectory without any of its own."""

from pathlib import Path

import numpy as np

from slamgym.errors import OutputError, TrajectoryError
from slamgym.eval.trajectories.stamp_words import seconds_to_ns, seconds_word, whole_ns
from slamgym.eval.trajectories.text import ParsedLine, read_table
from slamgym.eval.trajectories.words import columns
from slamgym.types import IntArray


def read_stamps(path: Path | str) -> IntArray:
    """Stamps int64 (N,), ns, strictly increasing, from the first column of a file.

    In seconds, such as TUM's rgb.txt and associations.txt or KITTI's times.txt; in nanoseconds before a comma, such as
    the data.csv of EuRoC's cameras. What follows the first column is ignored, '#' starts a comment. Raises
    TrajectoryError with file and line.
    """
    table = read_table(Path(path), _parse)
    if not len(table.lines):
        raise TrajectoryError(f"{path}: expected lines that start with a stamp, got none")
    if (bad := table.stamps_ns[1:] <= table.stamps_ns[:-1]).any():
        line = table.lines[int(np.argmax(bad)) + 1]
        raise TrajectoryError(f"{path}:{line}: expected increasing stamps, got one not above the last: sort the file")
    return table.stamps_ns


def _parse(text: str) -> ParsedLine:
    if "," in text:
        return [whole_ns(columns(text, ",")[0])], []
    return [seconds_to_ns(columns(text.split(maxsplit=1)[0])[0])], []


def write_stamps(path: Path | str, stamps_ns: IntArray) -> None:
    """Write stamps (N,), a line of seconds each, exact, as `read_stamps` reads them; raises OutputError."""
    lines = (f"{seconds_word(stamp_ns)}\n" for stamp_ns in stamps_ns.tolist())
    try:
        Path(path).write_text("".join(lines), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"cannot write the stamps {path}: {error.strerror}") from error
