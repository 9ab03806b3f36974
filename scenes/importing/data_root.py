"""Files that a scene's file names, such as textures: read from inside one folder, and only plain files."""

import os
import re
import stat
from pathlib import Path

from slamgym.errors import SceneError

MAX_FILE_BYTES = 1 << 30
MAX_NAME_LENGTH = 1000
URL = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:")
DRIVE = re.compile(r"[A-Za-z]:")
UNDECODED = "\udc80-\udcff"
"""Bytes in the name of a file that is not in UTF-8, as Python has them."""


class DataRoot:
    """The folder that all files of a scene lie in. Nothing outside it is read, and nothing is fetched from a network.

    folder: any folder that exists.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def path_of(self, name: str, base: str = "") -> Path:
        """The place inside the root, links followed, of a file that another file names, there or not.

        name: as it is written in a file of the folder `base`, which is relative to the root; backslashes are slashes.
        Raises SceneError for a URL, for another machine's drive and for a place outside the root.
        """
        if len(name) > MAX_NAME_LENGTH or not re.sub(f"[{UNDECODED}]", "", name).isprintable():
            raise SceneError(f"expected the name of a file in {self.folder}, got {name[:60]!r}...; correct it")
        if DRIVE.match(name):
            raise SceneError(f"expected a file in {self.folder}, got {name!r}, which is not there; put it there")
        if URL.match(name):
            raise SceneError(
                f"expected a file in {self.folder}, got {name!r}; nothing is fetched, so put it there and name it"
            )
        try:
            path = (self.folder / base / name.strip().replace("\\", "/")).resolve()
        except (OSError, RuntimeError) as error:  # a loop of links
            raise SceneError(f"expected a file in {self.folder}, got {name!r}: {error}; correct it") from None
        if not path.is_relative_to(self.folder):
            raise SceneError(f"expected a file in {self.folder}, got {name!r}, which leaves it; put it there")
        return path

    def read(self, name: str, base: str = "") -> bytes:
        """The content of a file, see `path_of`; raises SceneError, also when it is missing, not plain or too large."""
        return read_plain(self.path_of(name, base))


def read_plain(path: Path) -> bytes:
    """The content of a plain file of at most MAX_FILE_BYTES; raises SceneError. Pipes are not waited for."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        with open(descriptor, "rb") as file:  # noqa: PTH123 - a Path cannot open a descriptor
            found = os.fstat(descriptor)
            if not stat.S_ISREG(found.st_mode):
                raise SceneError(f"expected a file, got {path}, which is none; name another")
            if found.st_size > MAX_FILE_BYTES:
                raise SceneError(
                    f"{path}: expected at most {MAX_FILE_BYTES} bytes, got {found.st_size}; split or simplify it"
                )
            return file.read(MAX_FILE_BYTES)
    except OSError as error:
        raise SceneError(f"{path}: expected a readable file, got: {error.strerror or error}; put it there") from None
