import lzma
import os
import subprocess
import sys

import numpy as np
import pytest

from slamgym.errors import SlamError
from slamgym.slam import vocabulary
from slamgym.slam.train_vocabulary import image_descriptors
from slamgym.slam.vocabulary import PACKED, hamming, train, vocabulary_hash, vocabulary_path


@pytest.fixture(scope="module")
def images():
    """Descriptors of 12 images; image i shows the pattern i % 6, each bit flipped with a chance of 5 %."""
    rng = np.random.default_rng(1)
    patterns = rng.integers(0, 2, (6, 256), dtype=np.uint8)
    flips = rng.random((12, 50, 256)) < 0.05
    return [np.packbits(patterns[i % 6] ^ flips[i], axis=1) for i in range(12)], np.packbits(patterns, axis=1)


def read(text):
    """Branching, depth, parents, leaves, descriptors, weights, as DBoW2 reads them."""
    head, *lines = text.split("\n")
    rows = [line.split() for line in lines]
    parent, leaf = (np.array([int(row[i]) for row in rows]) for i in (0, 1))
    bits = np.array([row[2:34] for row in rows]).astype(np.uint8)
    return head, parent, leaf.astype(bool), bits, np.array([float(row[34]) for row in rows])


def test_text_is_a_tree_that_dbow2_can_read(images):
    head, parent, leaf, bits, weight = read(train(images[0], branching=3, depth=4).to_text())
    ids = np.arange(1, len(parent) + 1)
    assert head == "3 4 0 0"
    assert (parent < ids).all()  # the reader looks a parent up when it comes to the child
    assert set(parent) == {0, *ids[~leaf]}  # leaves have no children, all others some
    assert np.bincount(parent).max() <= 3
    assert bits.shape == (len(ids), 32)
    assert (weight[~leaf] == 0).all()
    assert (weight[leaf] > 0).any()


def test_depth_is_bounded(images):
    _, parent, *_ = read(train(images[0], branching=2, depth=3).to_text())
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


def test_equal_descriptors_do_not_split_for_ever():
    tree = train([np.zeros((50, 32), np.uint8), np.full((1, 32), 255, np.uint8)], branching=2, depth=6)
    assert len(tree.parent) == 2


def test_hamming_counts_bits():
    a = np.zeros((1, 32), np.uint8)
    b = np.zeros((2, 32), np.uint8)
    b[1, [0, 31]] = 0b101
    assert hamming(a.view(np.uint64), b.view(np.uint64)).tolist() == [[0, 4]]


def test_too_few_descriptors():
    with pytest.raises(SlamError, match="expected at least 6 descriptors, got 0"):
        train([np.empty((0, 32), np.uint8)])


def test_image_descriptors():
    noise = np.random.default_rng(0).integers(0, 256, (120, 160, 3), dtype=np.uint8)
    found = image_descriptors(noise, features=200)
    assert found.dtype == np.uint8
    assert found.shape[1] == 32
    assert 50 < len(found) <= 200
    assert image_descriptors(np.zeros((120, 160, 3), np.uint8)).shape == (0, 32)


def test_shipped_vocabulary_is_small_and_well_formed():
    assert PACKED.stat().st_size <= 2e6
    head, parent, leaf, *_ = read(lzma.decompress(PACKED.read_bytes()).decode())
    assert head == "6 6 0 0"
    assert leaf.sum() > 5000
    assert (parent <= np.arange(len(parent))).all()


def test_unpacked_once_into_the_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    path = vocabulary_path()
    assert path.parent == tmp_path / "slamgym"
    assert path.read_bytes() == lzma.decompress(PACKED.read_bytes())
    before = path.stat().st_mtime_ns
    assert vocabulary_path() == path
    assert path.stat().st_mtime_ns == before
    assert list(path.parent.iterdir()) == [path]  # no temporary file is left


def test_processes_that_unpack_at_the_same_time(tmp_path):
    program = "from slamgym.slam.vocabulary import vocabulary_hash; print(vocabulary_hash())"
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    command = [sys.executable, "-c", program]
    running = [subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) for _ in range(3)]
    hashes = {process.communicate(timeout=60)[0].strip() for process in running}
    assert hashes == {vocabulary_hash()}


def test_no_writable_home(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr(vocabulary.tempfile, "tempdir", str(tmp_path))
    assert vocabulary_path().parent.parent == tmp_path


def test_users_vocabulary(tmp_path):
    good = tmp_path / "ORBvoc.txt"
    good.write_text("10 6 0 0 \n0 0 " + "1 " * 32 + "0\n")
    assert vocabulary_path(good) == good
    packed = tmp_path / "ORBvoc.txt.tar.gz"
    packed.write_bytes(b"\x1f\x8b\x08\x00")
    with pytest.raises(SlamError, match="in the first line"):
        vocabulary_path(packed)
    with pytest.raises(SlamError, match="expected a file"):
        vocabulary_path(tmp_path / "missing.txt")
