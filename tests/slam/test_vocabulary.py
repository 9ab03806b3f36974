import hashlib
import lzma
import os
import subprocess
import sys

import pytest

from slamgym.errors import SlamError
from slamgym.slam import vocabulary
from slamgym.slam.vocabulary import PACKED, vocabulary_hash, vocabulary_path
from slamgym.slam.vocabulary_file import read_vocabulary

NODE = " ".join(["1"] * 32)


def test_shipped_vocabulary_is_small_and_well_formed(tmp_path):
    assert PACKED.stat().st_size <= 2e6
    shipped = read_vocabulary(vocabulary_path())
    assert (shipped.branching, shipped.depth, shipped.scoring, shipped.weighting) == (6, 6, "L1", "tf-idf")
    assert shipped.is_leaf.sum() > 5000


def test_unpacked_once_into_the_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(vocabulary.tempfile, "tempdir", str(tmp_path))
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
    good.write_text(f"10 6  0 0\n0 1 {NODE}  0\n")  # ORB-SLAM2's own writer leaves two spaces
    assert vocabulary_path(good) == good
    assert vocabulary_hash(good) == hashlib.sha256(good.read_bytes()).hexdigest()[:12]
    packed = tmp_path / "ORBvoc.txt.tar.gz"
    packed.write_bytes(b"\x1f\x8b\x08\x00")
    with pytest.raises(SlamError, match="in the first line"):
        vocabulary_path(packed)
    with pytest.raises(SlamError, match="expected a file"):
        vocabulary_path(tmp_path / "missing.txt")
