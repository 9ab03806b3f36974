import numpy as np
import pytest

from slamgym.errors import ConfigError
from slamgym.slam.vocabulary_file import read_vocabulary
from slamgym.slam.vocabulary_tree import hamming, train


@pytest.fixture(scope="module")
def images():
    """Descriptors of 12 images; image i shows the pattern i % 6, each bit flipped with a chance of 5 %."""
    rng = np.random.default_rng(1)
    patterns = rng.integers(0, 2, (6, 256), dtype=np.uint8)
    flips = rng.random((12, 50, 256)) < 0.05
    return [np.packbits(patterns[i % 6] ^ flips[i], axis=1) for i in range(12)], np.packbits(patterns, axis=1)


def test_written_tree_is_read_again(images, tmp_path):
    tree = train(images[0], branching=3, depth=4)
    text = tree.to_text()
    assert text.startswith("3 4 0 0\n")
    assert not text.endswith("\n")  # for DBoW2 that is one more node
    (tmp_path / "tree.txt").write_text(text)
    again = read_vocabulary(tmp_path / "tree.txt")  # which checks that it is a tree, and one of this shape
    assert (again.branching, again.depth, again.scoring, again.weighting) == (3, 4, "L1", "tf-idf")
    for name in ("parent", "is_leaf", "descriptors"):
        np.testing.assert_array_equal(getattr(again, name), getattr(tree, name))
    np.testing.assert_allclose(again.weight, tree.weight, rtol=5e-4)
    assert (again.weight[~again.is_leaf] == 0).all()
    assert (again.weight[again.is_leaf] > 0).any()


def test_depth_is_bounded(images):
    parent = train(images[0], branching=2, depth=3).parent
    depth = np.zeros(len(parent) + 1, int)
    for node, above in enumerate(parent, start=1):
        depth[node] = depth[above] + 1
    assert depth.max() == 3


def test_patterns_are_found(images):
    tree = train(images[0], branching=6, depth=1)
    assert len(tree.parent) == 6
    distance = hamming(tree.descriptors.view(np.uint64), images[1].view(np.uint64))
    assert (distance.min(axis=0) <= 3).all()  # the majority of 100 noisy copies is nearly the pattern
    # Each word is seen in 2 of 12 images.
    np.testing.assert_allclose(tree.weight, np.log(6))


def test_same_seed_same_tree(images):
    texts = [train(images[0], seed=seed).to_text() for seed in (3, 3, 4)]
    assert texts[0] == texts[1]
    assert texts[0] != texts[2]


@pytest.mark.parametrize("depth", [1, 6])
def test_progress_rises_to_one(images, depth):
    shares = []
    train(images[0], depth=depth, on_progress=shares.append)
    assert shares == sorted(shares)
    assert 0 < shares[0] < 1
    assert shares[-1] == 1


def test_equal_descriptors_do_not_split_for_ever():
    tree = train([np.zeros((50, 32), np.uint8), np.full((1, 32), 255, np.uint8)], branching=2, depth=6)
    assert len(tree.parent) == 2


def test_hamming_counts_bits():
    a = np.zeros((1, 32), np.uint8)
    b = np.zeros((2, 32), np.uint8)
    b[1, [0, 31]] = 0b101
    assert hamming(a.view(np.uint64), b.view(np.uint64)).tolist() == [[0, 4]]


def test_too_few_descriptors():
    with pytest.raises(ConfigError, match="expected at least 6 descriptors, got 0"):
        train([np.empty((0, 32), np.uint8)])


@pytest.mark.parametrize(("branching", "depth"), [(1, 6), (21, 6), (6, 0), (6, 11)])
def test_a_shape_that_orbslam_cannot_read(images, branching, depth):
    with pytest.raises(ConfigError, match=f"got {branching} and {depth}"):
        train(images[0], branching, depth)
