"""Which files of a report's folder are ours, so that one written again leaves none of the old ones behind."""

import re
from collections.abc import Collection
from pathlib import Path

from slamgym.errors import OutputError
from slamgym.files import write_atomically

LIST = ".report_files"
"""Names what the report consists of, a line each."""

_OURS = re.compile(r"(figures|tables)/[\w.-]+\.(svg|png|csv|tex|md)")


def file_stem(name: str) -> str:
    """A figure's or table's name as that of a file in any file system."""
    return re.sub(r"[^\w.-]", "_", name)


def announce(folder: Path, files: Collection[str]) -> None:
    """Before `files` are written: they are ours, as those of the report before are."""
    _write_list(folder, {*files, *_listed(folder)})


def remove_others(folder: Path, files: Collection[str]) -> None:
    """After `files` were written: remove those of the report before. Raises OutputError."""
    for name in _listed(folder) - set(files):
        try:
            (folder / name).unlink(missing_ok=True)
        except OSError as error:
            raise OutputError(f"cannot remove {folder / name}: {error.strerror}; remove it yourself") from None
    _write_list(folder, files)


def _listed(folder: Path) -> set[str]:
    try:
        lines = (folder / LIST).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return set()
    # Whatever somebody wrote into the list, nothing else is ever removed.
    return {line for line in lines if _OURS.fullmatch(line)}


def _write_list(folder: Path, files: Collection[str]) -> None:
    write_atomically(folder / LIST, "".join(f"{name}\n" for name in sorted(files)))
