"""Trajectory files in the format of the EuRoC MAV dataset's ground truth."""

from functools import partial
from pathlib import Path

from slamgym.eval.trajectories.poses import FilePoses
from slamgym.eval.trajectories.stamp_words import whole_ns
from slamgym.eval.trajectories.text import ParsedLine, first_data_line, read_table
from slamgym.eval.trajectories.words import columns, numbers, wrong_columns

_COLUMNS = "timestamp,x,y,z,qw,qx,qy,qz"


def euroc_poses(path: Path) -> FilePoses:
    """The poses of a CSV file `timestamp,x,y,z,qw,qx,qy,qz` as they are: whole nanoseconds, metres, the quaternion's w
    first; a header and further columns (velocities, biases) are skipped.
    """
    count = max(8, (first_data_line(path) or "").count(",") + 1)
    table = read_table(path, partial(_parse, count))
    values = table.values.reshape(-1, 7)
    return FilePoses(path, table.lines, table.stamps_ns, values[:, :3], values[:, [4, 5, 6, 3]])


def _parse(count: int, text: str) -> ParsedLine:
    words = columns(text, ",")
    # As many as in the first line: a line that is cut off would else lose its last digits unseen.
    if len(words) != count:
        raise wrong_columns("euroc", f"{count} columns '{_COLUMNS}...'", text, len(words))
    return [whole_ns(words[0])], numbers(words[1:8])
