"""DBoW2's text format for trees of binary ORB descriptors, as ORB-SLAM reads it.

First `branching depth scoring weighting`, then one node a line: `parent is_leaf`, the 32 bytes of its descriptor, its
weight. The first node has the id 1, the root is 0 and has no line. Numbers are separated by any number of spaces:
ORB-SLAM2's own writer leaves two of them here and there.
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import SlamError
from slamgym.files import file_sha256, recorded_hash
from slamgym.types import BoolArray, FloatArray, IntArray

Descriptors = NDArray[np.uint8]
"""ORB descriptors (N, 32): 256 bits a row."""

SCORINGS = ("L1", "L2", "chi-square", "Kullback-Leibler", "Bhattacharyya", "dot product")
WEIGHTINGS = ("tf-idf", "tf", "idf", "binary")
"""By DBoW2's numbers. ORB-SLAM uses L1 and tf-idf."""

MAX_BRANCHING, MAX_DEPTH = 20, 10
"""What ORB-SLAM's reader accepts."""

_NODE_COLUMNS = 2 + 32 + 1
_LONGEST_LINE = 400  # bytes; a node needs about 140, and a file without line ends must not fill the memory
_BLOCK_LINES = 20_000
_NODE = np.dtype([("parent", np.int64), ("is_leaf", np.int64), ("descriptor", np.uint8, (32,)), ("weight", np.float64)])


class Header(NamedTuple):
    """The first line; scoring and weighting are DBoW2's numbers."""

    branching: int
    depth: int
    scoring: int
    weighting: int


@dataclass(frozen=True, slots=True, eq=False)
class Vocabulary:
    """A tree of M nodes without the root; node i has the id i + 1, the root is 0, and parents come before children.

    parent: int64 (M,). is_leaf: bool (M,). descriptors: uint8 (M, 32). weight: float64 (M,), 0 for inner nodes.
    scoring, weighting: words of SCORINGS and WEIGHTINGS. The leaves are the visual words.
    """

    branching: int
    depth: int
    parent: IntArray
    is_leaf: BoolArray
    descriptors: Descriptors
    weight: FloatArray
    scoring: str = "L1"
    weighting: str = "tf-idf"

    def to_text(self) -> str:
        """The text format. There is no newline at the end: DBoW2's reader would take it for one more node."""
        rows = zip(self.parent, self.is_leaf, self.descriptors, self.weight, strict=True)
        lines = [f"{p} {int(leaf)} {' '.join(map(str, d))} {w:.4g}" for p, leaf, d, w in rows]
        names = f"{SCORINGS.index(self.scoring)} {WEIGHTINGS.index(self.weighting)}"
        return "\n".join([f"{self.branching} {self.depth} {names}", *lines])


def read_header(path: Path) -> Header:
    """Raises SlamError unless the file begins and ends as DBoW2's text format does; the tree is not looked at."""
    with _opened(path) as file:
        header = _parse_header(file.readline(_LONGEST_LINE), path)
        file.seek(-min(_LONGEST_LINE, path.stat().st_size), os.SEEK_END)
        last = (file.read().splitlines() or [b""])[-1]
    if len(last.split()) != _NODE_COLUMNS:
        raise SlamError(
            f"vocabulary: {path}: expected {_NODE_COLUMNS} columns in the last line, got {len(last.split())}: "
            "was the file cut off? Get it again"
        )
    return header


def read_vocabulary(path: Path) -> Vocabulary:
    """The whole tree, checked: about two seconds and 200 MB of memory for ORB-SLAM's own vocabulary of a million nodes.

    Raises SlamError that names the first bad line.
    """
    with _opened(path) as file:
        header = _parse_header(file.readline(_LONGEST_LINE), path)
        blocks = list(_blocks(file, path))
    if not blocks:
        raise SlamError(f"vocabulary: {path}: expected nodes below the first line, got none; get the file again")
    nodes = np.concatenate(blocks)
    for bad, expected in _faults(nodes, header):
        if bad.any():
            raise _malformed(path, int(bad.argmax()) + 2, expected)
    return Vocabulary(
        branching=header.branching,
        depth=header.depth,
        parent=nodes["parent"],
        is_leaf=nodes["is_leaf"].astype(np.bool_),
        descriptors=nodes["descriptor"],
        weight=nodes["weight"],
        scoring=SCORINGS[header.scoring],
        weighting=WEIGHTINGS[header.weighting],
    )


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
    return VocabularyInfo(
        path=str(path),
        branching=vocabulary.branching,
        depth=vocabulary.depth,
        nodes=len(vocabulary.parent),
        words=int(vocabulary.is_leaf.sum()),
        scoring=vocabulary.scoring,
        weighting=vocabulary.weighting,
        bytes=path.stat().st_size,
        sha256=file_sha256(path),
        vocabulary_sha256=recorded_hash(path),
    )


def _opened(path: Path) -> IO[bytes]:
    try:
        return path.open("rb")
    except OSError as error:
        raise SlamError(
            f"vocabulary: expected a DBoW2 text file that can be read, got {path} ({error.strerror})"
        ) from None


def _parse_header(line: bytes, path: Path) -> Header:
    try:
        header = Header(*map(int, line.split()))
    except (ValueError, TypeError):
        header = Header(-1, -1, -1, -1)
    limits = (range(2, MAX_BRANCHING + 1), range(1, MAX_DEPTH + 1), range(len(SCORINGS)), range(len(WEIGHTINGS)))
    if not all(value in limit for value, limit in zip(header, limits, strict=True)):
        raise SlamError(
            f"vocabulary: expected 'branching depth score weighting' in the first line of {path}, got {line[:40]!r}; "
            "give a DBoW2 text file such as ORBvoc.txt, unpacked"
        )
    return header


def _blocks(file: IO[bytes], path: Path) -> Iterator[NDArray[Any]]:
    lines = iter(lambda: file.readline(_LONGEST_LINE), b"")
    for first in count(2, _BLOCK_LINES):
        block = list(islice(lines, _BLOCK_LINES))
        if not block:
            return
        nodes = _nodes(block)
        if nodes is None:
            bad = next(k for k, line in enumerate(block) if _nodes([line]) is None)
            raise _malformed(path, first + bad, f"'parent is_leaf', 32 bytes and a weight, got {block[bad][:60]!r}")
        yield nodes


def _nodes(lines: list[bytes]) -> NDArray[Any] | None:
    """One node a line, or None when a line is not one; NumPy would pass over empty lines."""
    if any(line.isspace() for line in lines):
        return None
    try:
        return np.loadtxt(lines, dtype=_NODE, comments=None, ndmin=1)
    except ValueError:
        return None


def _faults(nodes: NDArray[Any], header: Header) -> Iterator[tuple[BoolArray, str]]:
    """Which nodes (M,) are bad, and what was expected of them; to be stopped at the first that are."""
    ids = np.arange(1, len(nodes) + 1)
    parent, is_leaf, weight = nodes["parent"], nodes["is_leaf"], nodes["weight"]
    yield (is_leaf != 0) & (is_leaf != 1), "1 for a leaf or 0 for an inner node as the second number"
    yield (parent < 0) | (parent >= ids), "a parent that has come before"
    yield ~np.isfinite(weight) | (weight < 0), "a weight of at least 0"
    leaf = np.concatenate([[False], is_leaf == 1])
    yield leaf[parent], "a parent that is no leaf"
    children = np.bincount(parent, minlength=len(leaf))
    yield children[parent] > header.branching, f"a parent with at most {header.branching} children"
    yield (children[1:] == 0) & ~leaf[1:], "an inner node with children (is the end of the file missing?)"
    yield _deeper(parent, header.depth), f"a node at most {header.depth} levels below the root"


def _deeper(parent: IntArray, depth: int) -> BoolArray:
    above = np.concatenate([[0], parent])
    ancestor = parent
    for _ in range(depth - 1):
        ancestor = above[ancestor]
    return np.not_equal(ancestor, 0)


def _malformed(path: Path, line: int, expected: str) -> SlamError:
    return SlamError(f"vocabulary: {path}, line {line}: expected {expected}; get or train the file again")
