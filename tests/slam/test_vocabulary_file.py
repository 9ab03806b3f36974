import subprocess
from dataclasses import asdict

import numpy as np
import pytest

from slamgym.errors import SlamError
from slamgym.slam import vocabulary_file
from slamgym.slam.vocabulary_file import read_header, read_vocabulary, vocabulary_info

BYTES = " ".join(map(str, range(32)))
GOOD = [f"0 0 {BYTES}  0", f"0 1 {BYTES}  1.5", f"1 1 {BYTES}  9.69855", f"1 1 {BYTES}  0"]
"""The root's children are an inner node and a leaf; the inner node has two leaves. Line 2 is the first."""


def written(folder, lines, head="2 2  0 0", end="\n"):
    path = folder / "voc.txt"
    path.write_text("\n".join([head, *lines]) + end)
    return path


@pytest.mark.parametrize("end", ["\n", "", "\r\n"])
def test_values(tmp_path, end):
    tree = read_vocabulary(written(tmp_path, GOOD, end=end))
    assert (tree.branching, tree.depth, tree.scoring, tree.weighting) == (2, 2, "L1", "tf-idf")
    assert tree.parent.tolist() == [0, 0, 1, 1]
    assert tree.is_leaf.tolist() == [False, True, True, True]
    assert tree.weight.tolist() == [0, 1.5, 9.69855, 0]
    np.testing.assert_array_equal(tree.descriptors, np.tile(np.arange(32, dtype=np.uint8), (4, 1)))


@pytest.mark.parametrize(
    ("number", "line", "expected"),
    [
        (3, f"0 1 {BYTES}", "32 bytes and a weight, got b'0 1 0 1"),  # no weight
        (4, f"1 1 {BYTES} 0 0", "32 bytes and a weight"),
        (4, "", "32 bytes and a weight, got b'"),
        (5, f"1 1 {BYTES[:-2]}256 0", "32 bytes and a weight"),
        (5, f"1 1 {BYTES} heavy", "32 bytes and a weight"),
        (5, "1 1 " + " " * 400 + BYTES + " 0", "32 bytes and a weight"),
        (2, f"0 2 {BYTES} 0", "1 for a leaf or 0"),
        (3, f"-1 1 {BYTES} 0", "a parent that has come before"),
        (4, f"3 1 {BYTES} 0", "a parent that has come before"),
        (4, f"2 1 {BYTES} 0", "a parent that is no leaf"),
        (3, f"0 1 {BYTES} nan", "a weight of at least 0"),
        (5, f"1 1 {BYTES} -1", "a weight of at least 0"),
        (5, f"1 0 {BYTES} 0", "an inner node with children"),
    ],
)
@pytest.mark.parametrize("block", [20_000, 2])
def test_malformed_line_is_named(tmp_path, monkeypatch, number, line, expected, block):
    monkeypatch.setattr(vocabulary_file, "_BLOCK_LINES", block)
    lines = GOOD.copy()
    lines[number - 2] = line
    with pytest.raises(SlamError) as raised:
        read_vocabulary(written(tmp_path, lines))
    message = str(raised.value)
    assert f"voc.txt, line {number}: expected " in message
    assert expected in message
    assert "\n" not in message


def test_shape_is_held(tmp_path):
    with pytest.raises(SlamError, match="line 4: expected a parent with at most 2 children"):
        read_vocabulary(written(tmp_path, [*GOOD, GOOD[-1]]))
    with pytest.raises(SlamError, match="line 4: expected a node at most 1 levels below the root"):
        read_vocabulary(written(tmp_path, GOOD, head="2 1 0 0"))


def test_cut_off(tmp_path):
    path = written(tmp_path, GOOD)
    text = path.read_bytes()
    for size in range(len(text) - len(GOOD[-1]) - len(GOOD[-2]) - 2):  # as long as the inner node has no child
        path.write_bytes(text[:size])
        with pytest.raises(SlamError):
            read_vocabulary(path)


@pytest.mark.parametrize(
    "head", ["", "10 6 0", "10 6 0 0 0", "21 6 0 0", "10 11 0 0", "10 0 0 0", "10 6 6 0", "10 6 0 4", "a b c d"]
)
def test_header(tmp_path, head):
    path = written(tmp_path, GOOD, head=head)
    with pytest.raises(SlamError, match="in the first line"):
        read_header(path)


def test_nothing_to_read(tmp_path):
    with pytest.raises(SlamError, match="expected nodes below the first line"):
        read_vocabulary(written(tmp_path, [], end=""))
    with pytest.raises(SlamError, match=r"can be read, got .*missing\.txt \(No such file"):
        read_vocabulary(tmp_path / "missing.txt")
    with pytest.raises(SlamError, match="Is a directory"):
        read_vocabulary(tmp_path)


def test_a_file_without_line_ends_is_not_read_whole(tmp_path):
    path = tmp_path / "zeros.bin"
    with path.open("wb") as file:
        file.truncate(1 << 36)  # 64 GiB that take no room
    with pytest.raises(SlamError, match="in the first line"):
        read_vocabulary(path)
    with path.open("r+b") as file:
        file.write(b"2 2 0 0\n")
    with pytest.raises(SlamError, match="line 2: expected"):
        read_vocabulary(path)


def test_info(tmp_path):
    path = written(tmp_path, GOOD, head="2 2 1 3")
    sha256 = subprocess.run(["sha256sum", path], capture_output=True, text=True, check=True).stdout.split()[0]
    assert asdict(vocabulary_info(path)) == {
        "path": str(path),
        "branching": 2,
        "depth": 2,
        "nodes": 4,
        "words": 3,
        "scoring": "L2",
        "weighting": "binary",
        "bytes": path.stat().st_size,
        "sha256": sha256,
        "vocabulary_sha256": sha256[:12],
    }


def test_a_file_that_was_cut_off_is_not_even_given_to_a_slam(tmp_path):
    path = written(tmp_path, GOOD)
    assert read_header(path).branching == 2
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(SlamError, match=r"expected 35 columns in the last line, got .*cut off"):
        read_header(path)
