"""Zip archives from anywhere: what is read of them is bounded before it is unpacked."""

import struct
import zipfile
import zlib
from pathlib import Path
from stat import S_ISREG

from slamgym.errors import SceneError

MAX_DIRECTORY_BYTES = 8_000_000
MAX_ENTRY_BYTES = 32_000_000
_TAIL_BYTES = 22 + 65_535
"""A zip file's last record, with the longest comment."""
_BROKEN = (zipfile.BadZipFile, zlib.error, struct.error, OSError, EOFError, RuntimeError, ValueError)
"""What zipfile raises for archives that are broken, encrypted or packed in a way that it does not know."""


def open_archive(path: Path) -> zipfile.ZipFile:
    """The zip file at `path`, to be closed; raises SceneError for anything else. Pipes and devices are not opened."""
    try:
        if not S_ISREG(path.stat().st_mode):
            raise SceneError(f"{path}: expected a file, got something else; leave it out")
        if (directory := _directory_bytes(path)) > MAX_DIRECTORY_BYTES:
            raise SceneError(
                f"{path}: expected a zip file with at most {MAX_DIRECTORY_BYTES} bytes of directory, got {directory}; "
                "divide it"
            )
        return zipfile.ZipFile(path)
    except _BROKEN as error:
        raise SceneError(f"{path}: expected a zip file, got {_line(error)}; install it again") from None


def read_entry(archive: zipfile.ZipFile, name: str, limit: int = MAX_ENTRY_BYTES) -> bytes:
    """An entry's bytes, at most `limit`; raises SceneError where it is missing, broken, too large or packed oddly."""
    where = f"{archive.filename}: {name[:200]!r}"
    try:
        entry = archive.getinfo(name)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED) or entry.file_size > limit:
            raise SceneError(
                f"{where}: expected at most {limit} bytes, deflated, got {entry.file_size} by method "
                f"{entry.compress_type}; pack it again"
            )
        return archive.read(entry)
    except KeyError:
        raise SceneError(f"{where}: expected an entry of the archive, which is not there; add it") from None
    except _BROKEN as error:
        raise SceneError(f"{where}: expected a readable entry, got {_line(error)}; pack it again") from None


def _directory_bytes(path: Path) -> int:
    """Size of the list of entries, which zipfile reads whole; that of a 64-bit archive counts as 4 GiB."""
    size = path.stat().st_size
    with path.open("rb") as file:
        file.seek(max(size - _TAIL_BYTES, 0))
        tail = file.read(_TAIL_BYTES)
    end = tail.rfind(b"PK\x05\x06")
    if b"PK\x06\x07" in tail:
        return 1 << 32
    return int(struct.unpack_from("<L", tail, end + 12)[0]) if end >= 0 else 0


def _line(error: Exception) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]
