"""What .obj and .mtl files may say and trimesh takes for something else."""

import codecs
import re
from contextlib import suppress
from itertools import dropwhile

from slamgym.errors import SceneError

ENCODINGS = ("utf-8", "cp1252", "latin-1")
"""Tried in this order; the last takes any bytes."""
LIBRARIES = "libraries.mtl"
"""What an .obj file names after `prepared`, in place of all its .mtl files."""
MAX_LINE = 1_000_000
LIBRARY = re.compile(rb"^[ \t]*mtllib[ \t]+(.+?)[ \t]*$", re.MULTILINE)
BETWEEN_LIBRARIES = re.compile(rb"(?<=\.mtl)[ \t]+", re.IGNORECASE)
RELATIVE = re.compile(rb"^f[ \t].*-", re.MULTILINE)
OPTION = re.compile(r"-.*|on|off|[+.\d][+.\deE-]*")


def as_utf8(data: bytes, suffix: str = ".obj") -> bytes:
    """The text of a file, whatever 8-bit encoding it has; raises SceneError for a binary file."""
    if b"\0" in data:
        raise SceneError(f"expected text, got a binary file; is it really an {suffix}?")
    data = data.removeprefix(codecs.BOM_UTF8)
    for encoding in ENCODINGS:
        with suppress(UnicodeDecodeError):
            return data.decode(encoding).encode()
    raise AssertionError(f"{ENCODINGS[-1]} decodes anything")


def prepared(data: bytes) -> tuple[bytes, list[str]]:
    """An .obj file as trimesh reads it rightly, and the names of its .mtl files, which are LIBRARIES there.

    Raises SceneError for what is no text or has a line of more than 1 MB, and ValueError for bad indices.
    """
    data = as_utf8(data).replace(b"\r\n", b"\n").replace(b"\\\n", b"")
    check_lines(data)
    names = [name.decode() for line in LIBRARY.findall(data) for name in BETWEEN_LIBRARIES.split(line)]
    # trimesh takes the first mention only.
    return f"mtllib {LIBRARIES}\n".encode() + with_absolute_indices(data), list(dict.fromkeys(names))


def check_lines(data: bytes) -> None:
    """Raise SceneError for a line of more than 1 MB: a face with very many corners takes very long."""
    start = 0
    while len(data) - start > MAX_LINE:
        end = data.rfind(b"\n", start, start + MAX_LINE + 1)
        if end < 0:
            raise SceneError(f"expected lines of at most {MAX_LINE} bytes, got a longer one; export it again")
        start = end + 1


def with_absolute_indices(data: bytes) -> bytes:
    """The .obj file with faces that count from the start of the file.

    Negative indices count back from the face; trimesh counts them back from the end. Raises ValueError for those that
    are no numbers.
    """
    if not RELATIVE.search(data):
        return data
    counts = {b"v": 0, b"vt": 0, b"vn": 0}
    lines = data.split(b"\n")
    for i, line in enumerate(lines):
        kind = line.split(maxsplit=1)[:1]
        if kind and kind[0] in counts:
            counts[kind[0]] += 1
        elif kind == [b"f"] and b"-" in line:
            lines[i] = b" ".join([b"f", *(_absolute(corner, list(counts.values())) for corner in line.split()[1:])])
    return b"\n".join(lines)


def without_options(name: str) -> str:
    """The file's name of a map in an .mtl file, which options such as "-s 2 2 1" may precede.

    >>> without_options("-s 2 2 1 oak wood.png")
    'oak wood.png'
    """
    return " ".join(dropwhile(OPTION.fullmatch, name.split())) if name.startswith("-") else name


def _absolute(corner: bytes, counts: list[int]) -> bytes:
    """A face's corner, as b"-1/-1", whose indices count from 1; counts: of what came before the face."""
    indices = corner.split(b"/")
    return b"/".join(
        str(int(index) + count + 1).encode() if index.startswith(b"-") else index
        for index, count in zip(indices, counts, strict=False)
    )
