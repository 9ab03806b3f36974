"""Lists of image files, a line a frame, as the TUM RGB-D benchmark has them. They are text of strangers."""

from pathlib import Path, PurePosixPath
from typing import NamedTuple

import numpy as np

from slamgym.errors import SequenceError, TrajectoryError
from slamgym.eval.trajectories.stamp_words import seconds_to_ns
from slamgym.eval.trajectories.text import ParsedLine, read_table
from slamgym.eval.trajectories.words import columns, quoted
from slamgym.types import IntArray


class FileList(NamedTuple):
    """The N data lines of a list with k stamps and files each.

    lines: their numbers, int64 (N,). stamps_ns: int64 (N, k), the first column strictly increasing. files: N tuples of
    k paths, all inside of the list's folder.
    """

    path: Path
    lines: IntArray
    stamps_ns: IntArray
    files: list[tuple[Path, ...]]


def read_file_list(path: Path, expected: str) -> FileList:
    """Read a list whose columns are `expected`, such as "timestamp filename": stamps in seconds and files by turns.

    Raises SequenceError with file and line when it cannot be read, has other columns or no line at all, stamps that do
    not increase, or files outside of its folder.
    """
    files: list[tuple[Path, ...]] = []

    def parse(text: str) -> ParsedLine:
        words = text.split()
        if len(words) != len(expected.split()):
            raise ValueError(f"expected the columns '{expected}', got {len(words)} in {quoted(text)}: correct the line")
        files.append(tuple(_inside(path.parent, word) for word in words[1::2]))
        return [seconds_to_ns(columns(word)[0]) for word in words[::2]], []

    try:
        table = read_table(path, parse)
    except TrajectoryError as error:
        raise SequenceError(str(error)) from None
    if not files:
        raise SequenceError(f"{path}: expected lines with '{expected}', got none: is the sequence unpacked whole?")
    stamps_ns = table.stamps_ns.reshape(len(files), -1)
    _check_increasing(path, table.lines, stamps_ns[:, 0])
    return FileList(path, table.lines, stamps_ns, files)


def check_present(listed: FileList, rows: IntArray) -> None:
    """Raise SequenceError with file and line unless the files of these rows are there: before a replay, not within."""
    for row in rows.tolist():
        for path in listed.files[row]:
            if not path.is_file():
                raise SequenceError(
                    f"{listed.path}:{listed.lines[row]}: expected the file {path}, got none: unpack the sequence "
                    "again, or take it off the list"
                )


def _inside(folder: Path, word: str) -> Path:
    """The file of that name below the folder. Raises ValueError."""
    name = PurePosixPath(word)
    if name.is_absolute() or ".." in name.parts:
        raise ValueError(f"expected a file inside of the sequence's folder, got {quoted(word)}: move it there")
    return folder / name


def _check_increasing(path: Path, lines: IntArray, stamps_ns: IntArray) -> None:
    if (bad := stamps_ns[1:] <= stamps_ns[:-1]).any():
        line = lines[int(np.argmax(bad)) + 1]
        raise SequenceError(f"{path}:{line}: expected increasing stamps, got one not above the last: sort the file")
