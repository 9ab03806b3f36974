"""Trajectory files as lines of numbers: whatever is wrong with one becomes a TrajectoryError with file and line."""

from array import array
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.eval.trajectories.words import is_number
from slamgym.types import FloatArray, IntArray

MAX_LINES = 5_000_000

# A file without line ends is no trajectory, and must not be taken into memory to tell so.
_LONGEST_LINE = 1 << 20
_CHUNK = 1 << 20
_MIN_CSV_COLUMNS = 8

ParsedLine = tuple[list[int], list[float]]


class Table(NamedTuple):
    """Numbers of a file's data lines: their line numbers (N,), stamps in ns (N,), all other numbers flat.

    Stamps are empty where the format has none.
    """

    lines: IntArray
    stamps_ns: IntArray
    values: FloatArray


def read_table(path: Path, parse: Callable[[str], ParsedLine]) -> Table:
    """Every data line of the file through `parse`, whose ValueErrors are raised with file and line.

    A file of more than MAX_LINES lines is refused before any of them is parsed.
    """
    _check_size(path)
    lines, stamps, values = array("q"), array("q"), array("d")
    for number, text in _data_lines(path):
        try:
            line_stamps, line_values = parse(text)
        except ValueError as error:
            raise TrajectoryError(f"{path}:{number}: {error}") from None
        lines.append(number)
        stamps.extend(line_stamps)
        values.extend(line_values)
    return Table(np.array(lines, np.int64), np.array(stamps, np.int64), np.array(values, np.float64))


def first_data_line(path: Path) -> str | None:
    """The first data line of the file, None when there is none; what comes after it is not read."""
    return next((text for _, text in _data_lines(path)), None)


def _data_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Number and text of the lines that hold something: no comment, no blank line, no header of a CSV file."""
    with _readable(path), path.open(encoding="utf-8-sig") as file:
        header_allowed = True
        for number, line in enumerate(iter(partial(file.readline, _LONGEST_LINE), ""), start=1):
            _check_line(path, number, line)
            text = line.partition("#")[0].strip()
            if text and not (header_allowed and _is_header(text)):
                yield number, text
            header_allowed = header_allowed and not text


def _check_line(path: Path, number: int, line: str) -> None:
    if "\0" in line:
        raise _not_text(path)
    if len(line) == _LONGEST_LINE:
        raise TrajectoryError(
            f"{path}:{number}: expected lines below {_LONGEST_LINE:,} characters, got a longer one: does it hold poses?"
        )


def _is_header(text: str) -> bool:
    words = text.split(",")
    return len(words) >= _MIN_CSV_COLUMNS and not any(map(is_number, words))


def _check_size(path: Path) -> None:
    count = 0
    with _readable(path), path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            count += max(chunk.count(b"\n"), chunk.count(b"\r"))
            if count > MAX_LINES:
                raise TrajectoryError(f"{path}: expected at most {MAX_LINES:,} lines, got more: thin the file out")


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """What makes the file unreadable becomes a TrajectoryError; a device is not even opened, it could wait forever."""
    try:
        if path.exists() and not path.is_file():
            kind = "folder" if path.is_dir() else "device"
            raise TrajectoryError(f"cannot read {path}: expected a file, got a {kind}")
        yield
    except OSError as error:
        raise TrajectoryError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise _not_text(path) from error


def _not_text(path: Path) -> TrajectoryError:
    return TrajectoryError(f"{path}: expected lines of numbers in UTF-8, got a binary file or another encoding")
