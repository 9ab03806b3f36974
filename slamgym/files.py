"""Files and folders that are there whole or not at all."""

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from pathlib import Path
from typing import Literal

from slamgym.errors import OutputError

_RECORDED_DIGITS = 12
_MOST_FLUSHED = 64


def check_free(path: Path, what: Literal["file", "folder"]) -> None:
    """Raise OutputError unless `draft` can put a file or folder at `path` and no other is lost: where there is none, or
    an empty one. To be asked before hours of work.
    """
    path = path.resolve()
    with _told(path):
        taken = path.exists() and not _is_empty(path, what)
        if taken or path.is_mount() or Path.cwd().is_relative_to(path):
            raise OutputError(f"expected a new or empty {what}, got {path}; remove it or name another")
        above = next(folder for folder in path.parents if folder.exists())
    if not above.is_dir() or not os.access(above, os.W_OK | os.X_OK):
        raise OutputError(f"cannot write in {above}; name another folder, or change its permissions")


@contextmanager
def draft(path: Path) -> Iterator[Path]:
    """Where the block writes a file, or makes a folder: beside `path`, moved there when the block ends well, else gone.

    It is alone in a folder of its own: what the block puts there besides is gone in either case. Others see what was at
    `path` before or all of the new, after a power cut, too, unless the folder holds very many files; links are
    followed, missing folders above are made. An OSError, of the block too, becomes an OutputError.
    """
    path = path.resolve()
    with _told(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as folder:
            place = Path(folder) / path.name
            yield place
            _flush(place)
            place.replace(path)


def write_atomically(path: Path, content: bytes | str) -> Path:
    """Write a file, text as UTF-8, by a `draft`, and return its path; raises OutputError."""
    with draft(path) as place:
        place.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def file_sha256(path: Path) -> str:
    """64 hex digits. Raises OSError."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def recorded_hash(path: Path) -> str:
    """So much of the file's SHA-256 as is recorded with a result: the first 12 hex digits. Raises OSError."""
    return short_hash(file_sha256(path))


def short_hash(sha256: str) -> str:
    """So much of a SHA-256 in hex as is recorded with a result."""
    return sha256[:_RECORDED_DIGITS]


def _flush(place: Path) -> None:
    """Have the disk hold what was written before it holds the new name. Of thousands of images that would take longer
    than to write them.
    """
    written = [place, *islice(place.rglob("*"), _MOST_FLUSHED)]
    if len(written) > _MOST_FLUSHED:
        return
    for path in written:
        number = os.open(path, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}; make room or name another") from None


def _is_empty(path: Path, what: Literal["file", "folder"]) -> bool:
    if what == "file":
        return path.is_file() and path.stat().st_size == 0
    return path.is_dir() and not any(path.iterdir())
