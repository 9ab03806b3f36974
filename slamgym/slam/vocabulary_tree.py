"""Training a vocabulary for ORB-SLAM: clusters of clusters of binary descriptors.

Each node is the bitwise majority of the training descriptors below it, found by k-means in Hamming space (Galvez-Lopez
and Tardos, Bags of Binary Words for Fast Place Recognition in Image Sequences, T-RO 2012). The leaves are the words; a
word is weighted by its inverse document frequency.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from slamgym.errors import ConfigError
from slamgym.slam.vocabulary_file import MAX_BRANCHING, MAX_DEPTH, Descriptors, Vocabulary
from slamgym.types import IntArray

_KMEANS_ROUNDS = 10


def check_shape(branching: int, depth: int) -> None:
    """Raise ConfigError unless ORB-SLAM can read a tree of this shape."""
    if not (2 <= branching <= MAX_BRANCHING and 1 <= depth <= MAX_DEPTH):
        raise ConfigError(
            f"vocabulary: expected a branching of 2 to {MAX_BRANCHING} and a depth of 1 to {MAX_DEPTH}, "
            f"got {branching} and {depth}; ORB-SLAM reads no other"
        )


def train(
    images: Sequence[Descriptors],
    branching: int = 6,
    depth: int = 6,
    seed: int = 0,
    on_progress: Callable[[float], None] | None = None,
) -> Vocabulary:
    """Vocabulary from the descriptors of each training image; the same input gives the same tree.

    ORB-SLAM compares images by the nodes four levels above the leaves, so depth should not be less than 6.
    on_progress: called now and then with the share of the work that is done, 1 at the end.
    Raises ConfigError for a shape that ORB-SLAM cannot read, or fewer descriptors than branches.
    """
    check_shape(branching, depth)
    packed = [np.ascontiguousarray(d).view(np.uint64) for d in images if len(d)]
    words = np.concatenate(packed) if packed else np.empty((0, 4), np.uint64)
    if len(words) < branching:
        raise ConfigError(f"vocabulary: expected at least {branching} descriptors, got {len(words)}; give more images")
    image_of = np.repeat(np.arange(len(packed)), [len(d) for d in packed])
    tree = _Tree(words, branching, depth, np.random.default_rng(seed), on_progress)
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
    on_progress: Callable[[float], None] | None
    parent: list[int] = field(default_factory=list)
    centre: list[NDArray[np.uint64]] = field(default_factory=list)
    settled: int = 0
    """Descriptors that have found their place, counted once a level."""

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
                    self._tell(len(child) * (1 if splits else height))
                    if splits:
                        next_level.append((len(self.parent), child))
            level = next_level
        return members

    def _tell(self, settled: int) -> None:
        self.settled += settled
        if self.on_progress is not None:
            self.on_progress(self.settled / (self.depth * len(self.words)))

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
