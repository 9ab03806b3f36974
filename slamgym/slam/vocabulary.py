"""Bags of visual words for ORB-SLAM: training a vocabulary, writing it in DBoW2's text format, and finding the file.

A vocabulary is a tree of binary ORB descriptors. Each node is the bitwise majority of the training descriptors below
it, found by k-means in Hamming space (Galvez-Lopez and Tardos, Bags of Binary Words for Fast Place Recognition in Image
Sequences, T-RO 2012). The leaves are the words; a word is weighted by its inverse document frequency.
"""

import hashlib
import lzma
import os
import re
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import SlamError
from slamgym.types import FloatArray, IntArray

Descriptors = NDArray[np.uint8]
"""ORB descriptors (N, 32): 256 bits a row."""

PACKED = Path(__file__).with_name("vocabulary.txt.xz")
"""The vocabulary that comes with slamgym; `slamgym.slam.train_vocabulary` makes it."""

_KMEANS_ROUNDS = 10


@dataclass(frozen=True, slots=True, eq=False)
class Vocabulary:
    """A tree of M nodes without the root; node i has the id i + 1, the root is 0, and parents come before children.

    parent: int64 (M,). is_leaf: bool (M,). descriptors: uint8 (M, 32). weight: float64 (M,), 0 for inner nodes.
    """

    branching: int
    depth: int
    parent: IntArray
    is_leaf: NDArray[np.bool_]
    descriptors: Descriptors
    weight: FloatArray

    def to_text(self) -> str:
        """DBoW2's text format: branching, depth, L1 score, tf-idf; then one node a line.

        There is no newline at the end: DBoW2's reader would take it for one more node.
        """
        rows = zip(self.parent, self.is_leaf, self.descriptors, self.weight, strict=True)
        lines = [f"{p} {int(leaf)} {' '.join(map(str, d))} {w:.4g}" for p, leaf, d, w in rows]
        return "\n".join([f"{self.branching} {self.depth} 0 0", *lines])


def train(images: Sequence[Descriptors], branching: int = 6, depth: int = 6, seed: int = 0) -> Vocabulary:
    """Vocabulary from the descriptors of each training image; the same input gives the same tree.

    ORB-SLAM compares images by the nodes four levels above the leaves, so depth should not be less than 6.
    Raises SlamError when there are fewer descriptors than branches.
    """
    packed = [np.ascontiguousarray(d).view(np.uint64) for d in images if len(d)]
    words = np.concatenate(packed) if packed else np.empty((0, 4), np.uint64)
    if len(words) < branching:
        raise SlamError(f"vocabulary: expected at least {branching} descriptors, got {len(words)}; give more images")
    image_of = np.repeat(np.arange(len(packed)), [len(d) for d in packed])
    tree = _Tree(words, branching, depth, np.random.default_rng(seed))
    members = tree.grow()
    return Vocabulary(
        branching=branching,
        depth=depth,
        parent=np.array(tree.parent),
        is_leaf=np.array([m is not None for m in members]),
        descriptors=np.array(tree.centre).view(np.uint8).reshape(-1, 32),
        weight=np.array([_idf(image_of, m, len(packed)) for m in members]),
    )


def _idf(image_of: IntArray, members: IntArray | None, images: int) -> float:
    """Inverse document frequency, ln(images / images with this word); 0 for an inner node."""
    return 0.0 if members is None else float(np.log(images / len(np.unique(image_of[members]))))


@dataclass(slots=True)
class _Tree:
    """Grows breadth first, so that parents come before children."""

    words: NDArray[np.uint64]
    branching: int
    depth: int
    rng: np.random.Generator
    parent: list[int] = field(default_factory=list)
    centre: list[NDArray[np.uint64]] = field(default_factory=list)

    def grow(self) -> list[IntArray | None]:
        """Members of each node that is a leaf, None for inner nodes."""
        members: list[IntArray | None] = []
        level = [(0, np.arange(len(self.words)))]
        for height in range(self.depth, 0, -1):
            next_level = []
            for node, inside in level:
                for centre, child in self._split(inside):
                    self.parent.append(node)
                    self.centre.append(centre)
                    splits = height > 1 and self._can_split(child)
                    members.append(None if splits else child)
                    if splits:
                        next_level.append((len(self.parent), child))
            level = next_level
        return members

    def _can_split(self, members: IntArray) -> bool:
        return bool((self.words[members] != self.words[members[0]]).any())

    def _split(self, members: IntArray) -> list[tuple[NDArray[np.uint64], IntArray]]:
        words = self.words[members]
        centres = _seed_centres(words, self.branching, self.rng)
        labels = hamming(words, centres).argmin(axis=1)
        for _ in range(_KMEANS_ROUNDS):
            centres = np.array([_majority(words[labels == c]) for c in range(len(centres)) if (labels == c).any()])
            previous, labels = labels, hamming(words, centres).argmin(axis=1)
            if (labels == previous).all():
                break
        return [(centres[c], members[labels == c]) for c in range(len(centres)) if (labels == c).any()]


def hamming(a: NDArray[np.uint64], b: NDArray[np.uint64]) -> NDArray[np.int64]:
    """Number of differing bits (N, K) between descriptors (N, 4) and (K, 4)."""
    return np.stack([np.bitwise_count(a ^ row).sum(axis=1, dtype=np.int64) for row in b], axis=1)


def _seed_centres(words: NDArray[np.uint64], count: int, rng: np.random.Generator) -> NDArray[np.uint64]:
    """k-means++: each next centre is drawn by its squared distance to the nearest so far; fewer if words run out."""
    centres = [words[rng.integers(len(words))]]
    nearest = hamming(words, centres[0][None])[:, 0]
    while len(centres) < count and nearest.any():
        chance = nearest.astype(np.float64) ** 2
        centres.append(words[rng.choice(len(words), p=chance / chance.sum())])
        nearest = np.minimum(nearest, hamming(words, centres[-1][None])[:, 0])
    return np.array(centres)


def _majority(words: NDArray[np.uint64]) -> NDArray[np.uint64]:
    ones = np.unpackbits(words.view(np.uint8).reshape(len(words), 32), axis=1).sum(axis=0, dtype=np.int64)
    return np.packbits(2 * ones > len(words)).view(np.uint64)


def vocabulary_path(user_path: str | Path | None = None) -> Path:
    """Text file to load: the user's, or slamgym's own, unpacked once into the user's cache. Raises SlamError."""
    if user_path is None:
        return _unpacked(PACKED)
    path = Path(user_path).expanduser()
    if not path.is_file():
        raise SlamError(f"vocabulary: expected a file, got {path}; give a DBoW2 text file, or leave the option out")
    with path.open("rb") as file:
        first = file.readline(80)
    if not re.fullmatch(rb"\d+ \d+ [0-5] [0-5]\s*", first):
        raise SlamError(
            f"vocabulary: expected 'branching depth score weighting' in the first line of {path}, got {first[:40]!r}; "
            "give a DBoW2 text file such as ORBvoc.txt, unpacked"
        )
    return path


def vocabulary_hash(user_path: str | Path | None = None) -> str:
    """First 12 hex digits of the SHA-256 of the vocabulary text, to record with results. Raises SlamError."""
    with vocabulary_path(user_path).open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()[:12]


def _unpacked(packed: Path) -> Path:
    if not packed.is_file():
        raise SlamError(f"vocabulary: {packed.name} is missing from the installation; install slamgym again")
    raw = packed.read_bytes()
    name = f"vocabulary-{hashlib.sha256(raw).hexdigest()[:12]}.txt"
    for folder in _cache_folders():
        with suppress(PermissionError):
            if (folder / name).is_file():
                return folder / name
    text = lzma.decompress(raw)
    for folder in _cache_folders():
        try:
            return _write_atomically(folder / name, text)
        except OSError:  # a read-only or full home is no reason to stop
            continue
    raise SlamError(f"vocabulary: no folder to unpack it to; tried {', '.join(map(str, _cache_folders()))}")


def _cache_folders() -> list[Path]:
    home = os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()
    return [Path(home) / "slamgym", Path(tempfile.gettempdir()) / f"slamgym-{os.getuid()}"]


def _write_atomically(path: Path, content: bytes) -> Path:
    """Other processes see the whole file or none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        draft = Path(folder) / path.name
        draft.write_bytes(content)
        return draft.replace(path)
