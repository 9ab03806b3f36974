"""The vocabulary that a run uses: the user's text file, or slamgym's own, unpacked once."""

import hashlib
import lzma
import os
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from slamgym.errors import OutputError, SlamError
from slamgym.files import write_atomically
from slamgym.slam.vocabulary_file import read_header, read_vocabulary

PACKED = Path(__file__).with_name("vocabulary.txt.xz")
"""The vocabulary that comes with slamgym; `slamgym.slam.train_vocabulary` makes it."""

RECORDED_DIGITS = 12
"""So much of the SHA-256 of its vocabulary is recorded with a result."""


@dataclass(frozen=True, slots=True)
class VocabularyInfo:
    """What is in a vocabulary file. nodes: without the root. words: the leaves."""

    path: str
    branching: int
    depth: int
    nodes: int
    words: int
    scoring: str
    weighting: str
    bytes: int
    sha256: str
    vocabulary_sha256: str
    """The digits of the SHA-256 that results record."""


def vocabulary_info(path: Path) -> VocabularyInfo:
    """Read and check the whole file. Raises SlamError that names the first bad line."""
    vocabulary = read_vocabulary(path)
    sha256 = file_sha256(path)
    return VocabularyInfo(
        path=str(path),
        branching=vocabulary.branching,
        depth=vocabulary.depth,
        nodes=len(vocabulary.parent),
        words=int(vocabulary.is_leaf.sum()),
        scoring=vocabulary.scoring,
        weighting=vocabulary.weighting,
        bytes=path.stat().st_size,
        sha256=sha256,
        vocabulary_sha256=sha256[:RECORDED_DIGITS],
    )


def vocabulary_path(user_path: str | Path | None = None) -> Path:
    """Text file to load: the user's, or slamgym's own, unpacked once into the user's cache. Raises SlamError."""
    if user_path is None:
        return _unpacked(PACKED)
    path = Path(user_path).expanduser()
    if not path.is_file():
        raise SlamError(f"vocabulary: expected a file, got {path}; give a DBoW2 text file, or leave the option out")
    read_header(path)
    return path


def vocabulary_hash(user_path: str | Path | None = None) -> str:
    """First 12 hex digits of the SHA-256 of the vocabulary text, to record with results. Raises SlamError."""
    return file_sha256(vocabulary_path(user_path))[:RECORDED_DIGITS]


def file_sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _unpacked(packed: Path) -> Path:
    if not packed.is_file():
        raise SlamError(f"vocabulary: {packed.name} is missing from the installation; install slamgym again")
    raw = packed.read_bytes()
    name = f"vocabulary-{hashlib.sha256(raw).hexdigest()[:12]}.txt"
    for folder in cache_folders():
        with suppress(PermissionError):
            if (folder / name).is_file():
                return folder / name
    text = lzma.decompress(raw)
    for folder in cache_folders():
        try:
            return write_atomically(folder / name, text)
        except OSError:  # a read-only or full home is no reason to stop
            continue
    raise SlamError(f"vocabulary: no folder to unpack it to; tried {', '.join(map(str, cache_folders()))}")


def cache_folders() -> list[Path]:
    """Where large files of slamgym go: the user's cache, or, where that cannot be written, a temporary folder."""
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    return [Path(home) / "slamgym", Path(tempfile.gettempdir()) / f"slamgym-{os.getuid()}"]


def check_new_file(path: Path) -> None:
    """Raise OutputError unless a file can be written at `path` without losing another; an empty one may be there."""
    path = path.resolve()
    with suppress(PermissionError):
        if path.exists() and (not path.is_file() or path.stat().st_size > 0):
            raise OutputError(f"vocabulary: expected a new or empty file, got {path}; remove it or name another")
    above = next(folder for folder in path.parents if os.access(folder, os.F_OK))
    if not above.is_dir() or not os.access(above, os.W_OK | os.X_OK):
        raise OutputError(f"vocabulary: cannot write in {above}; name another folder, or change its permissions")
