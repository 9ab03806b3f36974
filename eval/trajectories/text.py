"""Trajectory files as lines of numbers: whatever is wrong with one becomes a TrajectoryError with file and line."""

from array import array
from collections.abc import Callable, Iterator
from decimal import Context, Decimal, DecimalException
from pathlib import Path
from typing import NamedTuple

import numpy as np

from slamgym.errors import TrajectoryError
from slamgym.types import FloatArray, IntArray

MAX_LINES = 5_000_000
# No number of seconds that the stamps can hold is as large: it can only be nanoseconds (1e14 ns are a day).
SMALLEST_NANOSECONDS = 10**14

_CHUNK = 1 << 20
_MIN_CSV_COLUMNS = 8
# Differences of two stamps below it (the year 2115) fit into 64 bits.
_MAX_STAMP_S = 4_600_000_000
MAX_NANOSECONDS = _MAX_STAMP_S * 10**9
# Bounds exponents and digits, so that a stamp like 1e999999999 is refused and not worked out.
_DECIMAL = Context(prec=40)

ParsedLine = tuple[list[int], list[float]]


class Table(NamedTuple):
    """Numbers of a file's data lines: their line numbers (N,), stamps in ns (N,), all other numbers flat.

    Stamps are empty where the format has none.
    """

    lines: IntArray
    stamps_ns: IntArray
    values: FloatArray


def read_table(path: Path, parse: Callable[[str], ParsedLine]) -> Table:
    """Every data line of the file through `parse`, whose ValueErrors are raised with file and line."""
    lines, stamps, values = array("q"), array("q"), array("d")
    for number, text in data_lines(path):
        try:
            line_stamps, line_values = parse(text)
        except ValueError as error:
            raise TrajectoryError(f"{path}:{number}: {error}") from None
        lines.append(number)
        stamps.extend(line_stamps)
        values.extend(line_values)
    return Table(np.array(lines, np.int64), np.array(stamps, np.int64), np.array(values, np.float64))


def data_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Number and text of the lines that hold something: no comment, no blank line, no header of a CSV file."""
    try:
        _check_size(path)
        with path.open(encoding="utf-8-sig") as file:
            header_allowed = True
            for number, line in enumerate(file, start=1):
                text = line.partition("#")[0].strip()
                if text and not (header_allowed and _is_header(text)):
                    yield number, text
                header_allowed = header_allowed and not text
    except OSError as error:
        raise TrajectoryError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise _not_text(path) from error


def first_data_line(path: Path) -> str | None:
    """The first data line of the file, None when there is none."""
    return next((text for _, text in data_lines(path)), None)


def format_of(line: str) -> str | None:
    """Name of the format that a data line looks like by its separators and columns, None for none of them."""
    if "," in line:
        return "euroc"
    return {8: "tum", 12: "kitti"}.get(len(line.split()))


def wrong_columns(own_format: str, expected: str, line: str, got: int) -> ValueError:
    """The error for a line with another number of columns; it names the other format that the line looks like."""
    look = format_of(line)
    hint = "" if look in (None, own_format) else f"this looks like {look}: use format={look!r}; or "
    return ValueError(f"expected {expected}, got {got} columns; {hint}is the line cut off?")


def columns(line: str, separator: str | None = None) -> list[str]:
    """The words of a line of numbers. Python reads 1_000 and all scripts' digits as numbers; no other tool does."""
    if "_" in line or not line.isascii():
        raise ValueError(f"expected plain numbers, got {shorten(line)}")
    return line.split(separator)


def numbers(words: list[str]) -> list[float]:
    """Floats of the words; NaN and infinity are numbers here."""
    try:
        return list(map(float, words))
    except ValueError:
        raise ValueError(f"expected a number, got {shorten(next(w for w in words if not _is_number(w)))}") from None


def seconds_to_ns(word: str) -> int:
    """Nanoseconds of a decimal number of seconds; a float would round a Unix time to some 200 ns."""
    seconds = _decimal(word, "seconds")
    if _DECIMAL.abs(seconds) >= SMALLEST_NANOSECONDS:
        raise ValueError(f"expected a stamp in seconds, got {shorten(word)}: that is in nanoseconds, divide it by 1e9")
    if _DECIMAL.abs(seconds) >= _MAX_STAMP_S:
        raise ValueError(f"expected a stamp in seconds below {_MAX_STAMP_S}, got {shorten(word)}")
    return round(seconds.scaleb(9, _DECIMAL))


def whole_ns(word: str) -> int:
    """Nanoseconds of a whole number of nanoseconds, with or without decimals that are 0."""
    stamp = _decimal(word, "nanoseconds")
    if _DECIMAL.abs(stamp) >= MAX_NANOSECONDS:
        raise ValueError(f"expected a stamp in nanoseconds below {MAX_NANOSECONDS}, got {shorten(word)}")
    if stamp != round(stamp):
        raise ValueError(f"expected a stamp in whole nanoseconds, got {shorten(word)}: is it in seconds?")
    return round(stamp)


def _check_size(path: Path) -> None:
    """Refuse what cannot be a trajectory before its lines are parsed."""
    if path.exists() and not path.is_file():
        raise TrajectoryError(f"cannot read {path}: expected a file, got a {'folder' if path.is_dir() else 'device'}")
    count = 0
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            if b"\0" in chunk:
                raise _not_text(path)
            count += max(chunk.count(b"\n"), chunk.count(b"\r"))
            if count > MAX_LINES:
                raise TrajectoryError(f"{path}: expected at most {MAX_LINES:,} lines, got more: thin the file out")


def _not_text(path: Path) -> TrajectoryError:
    return TrajectoryError(f"{path}: expected lines of numbers in UTF-8, got a binary file or another encoding")


def _is_header(text: str) -> bool:
    words = text.split(",")
    return len(words) >= _MIN_CSV_COLUMNS and not any(map(_is_number, words))


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _decimal(word: str, unit: str) -> Decimal:
    try:
        value = _DECIMAL.create_decimal(word.strip())
    except DecimalException:
        raise ValueError(f"expected a stamp in {unit}, got {shorten(word)}") from None
    if not value.is_finite():
        raise ValueError(f"expected a stamp in {unit}, got {shorten(word)}")
    return value


def shorten(word: str) -> str:
    """The word in quotes, for a message of one line."""
    return repr(word if len(word) <= 40 else word[:37] + "...")
