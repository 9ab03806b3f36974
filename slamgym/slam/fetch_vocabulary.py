"""The vocabulary that comes with ORB-SLAM2 and ORB-SLAM3, from where its authors publish it, into the user's cache."""

import os
import shutil
import tarfile
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from http.client import HTTPException
from pathlib import Path
from urllib.error import HTTPError, URLError

from slamgym.errors import OutputError, SlamError
from slamgym.files import check_free, draft, file_sha256
from slamgym.slam.vocabulary import cache_folders

MAX_ARCHIVE_BYTES = 100_000_000
MAX_TEXT_BYTES = 500_000_000
"""Bounds on what is taken from the network and unpacked: more than twice what is expected."""

_CHUNK_BYTES = 1 << 18


@dataclass(frozen=True, slots=True)
class Source:
    """A tar.gz archive that holds a vocabulary as the file `member`, and the SHA-256 of both in hex."""

    url: str
    archive_sha256: str
    text_sha256: str
    member: str = "ORBvoc.txt"


# 42,527,984 and 145,250,924 bytes. The hashes are those of two Git LFS pointers on GitHub: of the archive,
# Vocabulary/ORBvoc.txt.tar.gz in halajun/VDO_SLAM; of the text, Vocabulary/ORBvoc.txt in yanyan-li/PlanarSLAM.
ORBVOC = Source(
    url="https://github.com/raulmur/ORB_SLAM2/raw/master/Vocabulary/ORBvoc.txt.tar.gz",
    archive_sha256="ff2d0e82a69a8f4c5c002e3a0dff82a00e5872e1659fac1b996f41166b92693b",
    text_sha256="f8dd027f7a6cb88129821341194d7f2c75b77b3394257ddd0d2229863d1a3570",
)


def fetched_vocabulary(out: Path | None = None, source: Source = ORBVOC) -> Path | None:
    """The vocabulary where it is already: in the file `out`, or by default in the cache. None where it is not."""
    places = [folder / source.member for folder in cache_folders()] if out is None else [out]
    return next((path for path in places if _holds(path, source.text_sha256)), None)


def fetch_vocabulary(
    out: Path | None = None,
    source: Source = ORBVOC,
    timeout_s: float = 30.0,
    on_bytes: Callable[[int, int | None], None] | None = None,
) -> Path:
    """Download the vocabulary to `out`, by default into the cache, and return its path: whole and verified, or not.

    timeout_s: how long the server may be silent. on_bytes: called with the bytes that have come and, where the server
    tells, how many there are. Raises SlamError when it cannot be downloaded or is not what it should be, OutputError
    when `out` is something else already or cannot be written; neither leaves a file.
    """
    if out is not None:
        check_free(out, "file")
    path = _writable_cache() / source.member if out is None else out
    with draft(path) as text:
        archive = text.with_name(f"{text.name}.tar.gz")
        _download(source, archive, timeout_s, on_bytes)
        _unpack(source, archive, text)
    return path


def _holds(path: Path, sha256: str) -> bool:
    with suppress(OSError):
        return path.is_file() and file_sha256(path) == sha256
    return False


def _writable_cache() -> Path:
    folders = cache_folders()
    for folder in folders:
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            if os.access(folder, os.W_OK | os.X_OK):
                return folder
    raise OutputError(f"no folder for the vocabulary can be written, tried {', '.join(map(str, folders))}; give --out")


def _download(
    source: Source, archive: Path, timeout_s: float, on_bytes: Callable[[int, int | None], None] | None
) -> None:
    with archive.open("wb") as file:
        for chunk in _chunks(source, timeout_s, on_bytes):
            file.write(chunk)
    _verify(archive, "archive", source.archive_sha256, source)


def _chunks(source: Source, timeout_s: float, on_bytes: Callable[[int, int | None], None] | None) -> Iterator[bytes]:
    done, total = 0, None
    try:
        with urllib.request.urlopen(source.url, timeout=timeout_s) as response:
            length = response.headers.get("Content-Length")
            total = int(length) if length else None
            while chunk := response.read(_CHUNK_BYTES):
                done += len(chunk)
                if done > MAX_ARCHIVE_BYTES:
                    raise _failed(source, f"it is larger than {MAX_ARCHIVE_BYTES:,} bytes")
                if on_bytes is not None:
                    on_bytes(done, total)
                yield chunk
    except (OSError, HTTPException, ValueError) as error:
        raise _failed(source, _reason(error, timeout_s)) from None
    # Python's HTTP client says nothing when a connection ends too early.
    if total is not None and done < total:
        raise _failed(source, f"the connection ended after {done:,} of {total:,} bytes")


def _reason(error: Exception, timeout_s: float) -> str:
    cause = error.reason if isinstance(error, URLError) and not isinstance(error, HTTPError) else error
    if isinstance(cause, TimeoutError):
        return f"the server was silent for {timeout_s:g} s"
    return getattr(cause, "strerror", None) or str(cause)


def _unpack(source: Source, archive: Path, text: Path) -> None:
    """Only the one file, under a name of ours: no path in the archive is followed."""
    with tarfile.open(archive, "r:gz") as tar:
        member = next((m for m in tar if m.isreg() and m.name.removeprefix("./") == source.member), None)
        if member is None or member.size > MAX_TEXT_BYTES:
            raise _failed(source, f"expected {source.member} of at most {MAX_TEXT_BYTES:,} bytes in it, got none")
        content = tar.extractfile(member)
        assert content is not None  # since it is a regular file
        with content, text.open("wb") as file:
            shutil.copyfileobj(content, file)
    _verify(text, "text", source.text_sha256, source)


def _verify(path: Path, what: str, sha256: str, source: Source) -> None:
    found = file_sha256(path)
    if found != sha256:
        raise _failed(source, f"expected its {what} to have the SHA-256 {sha256}, got {found}")


def _failed(source: Source, reason: str) -> SlamError:
    packed = source.url.rpartition("/")[2]
    return SlamError(
        f"vocabulary: {source.url} cannot be used: {reason}; try again, or get {packed} by hand (from the folder "
        f"Vocabulary of github.com/UZ-SLAMLab/ORB_SLAM3), unpack it with tar -xf {packed}, and give "
        f"--slam-options vocabulary {source.member}"
    )
