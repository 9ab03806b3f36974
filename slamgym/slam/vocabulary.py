"""The vocabulary that a run uses: the user's text file, or slamgym's own, unpacked once."""

import lzma
import os
import tempfile
from contextlib import suppress
from pathlib import Path

from slamgym.errors import OutputError, SlamError
from slamgym.files import recorded_hash, write_atomically
from slamgym.slam.vocabulary_file import read_header

PACKED = Path(__file__).with_name("vocabulary.txt.xz")
"""The vocabulary that comes with slamgym; `slamgym.slam.train_vocabulary` makes it."""


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
    return recorded_hash(vocabulary_path(user_path))


def _unpacked(packed: Path) -> Path:
    if not packed.is_file():
        raise SlamError(f"vocabulary: {packed.name} is missing from the installation; install slamgym again")
    name = f"vocabulary-{recorded_hash(packed)}.txt"
    for folder in cache_folders():
        with suppress(PermissionError):
            if (folder / name).is_file():
                return folder / name
    text = lzma.decompress(packed.read_bytes())
    for folder in cache_folders():
        with suppress(OutputError):  # a read-only or full home is no reason to stop
            return write_atomically(folder / name, text)
    raise SlamError(f"vocabulary: no folder to unpack it to; tried {', '.join(map(str, cache_folders()))}")


def cache_folders() -> list[Path]:
    """Where large files of slamgym go: the user's cache, or, where that cannot be written, a temporary folder."""
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    return [Path(home) / "slamgym", Path(tempfile.gettempdir()) / f"slamgym-{os.getuid()}"]
