"""What .obj and .mtl files may say and trimesh takes for something else."""

import re
from itertools import dropwhile

RELATIVE = re.compile(rb"^f[ \t].*-", re.MULTILINE)
OPTION = re.compile(r"-.*|on|off|[+.\d][+.\deE-]*")


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
