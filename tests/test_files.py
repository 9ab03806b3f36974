import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from slamgym.errors import OutputError
from slamgym.files import check_free, draft, file_sha256, recorded_hash, write_atomically


def test_a_file_appears_whole_when_the_block_ends(tmp_path):
    path = tmp_path / "deep" / "file.txt"
    for content in ("old", "new"):
        with draft(path) as place:
            place.write_text(content)
            place.with_name("besides").touch()
            assert not path.exists() or path.read_text() == "old"
        assert path.read_text() == content
        assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("exists", [False, True])
def test_a_folder_appears_whole_when_the_block_ends(tmp_path, exists):
    path = tmp_path / "folder"
    if exists:
        path.mkdir()
    with draft(path) as place:
        place.mkdir()
        (place / "file.txt").write_text("content")
        assert path.exists() == exists
    assert list(tmp_path.rglob("*")) == [path, path / "file.txt"]


@pytest.mark.parametrize(("files", "flushed"), [(3, {"folder", "0", "1", "2"}), (100, set())])
def test_what_is_not_very_much_is_on_the_disk_before_it_is_in_its_place(tmp_path, monkeypatch, files, flushed):
    seen, fsync = set(), os.fsync

    def note(number):
        assert not (tmp_path / "folder").exists()
        seen.add(Path(f"/proc/self/fd/{number}").readlink().name)
        fsync(number)

    monkeypatch.setattr("os.fsync", note)
    with draft(tmp_path / "folder") as place:
        place.mkdir()
        for name in range(files):
            (place / str(name)).touch()
    assert seen == flushed
    assert len(list((tmp_path / "folder").iterdir())) == files


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_a_block_that_fails_leaves_what_was_there(tmp_path, error):
    path = write_atomically(tmp_path / "file.txt", b"old")
    with pytest.raises(error), draft(path) as place:  # noqa: PT012
        place.write_text("new")
        raise error
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_text() == "old"


def test_links_are_followed(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "there" / "file.txt")
    write_atomically(tmp_path / "link", "content")
    assert (tmp_path / "there" / "file.txt").read_text() == "content"
    assert (tmp_path / "link").is_symlink()


def test_what_cannot_be_written_is_told_in_one_line(tmp_path):
    write_atomically(tmp_path / "file", "")
    with pytest.raises(OutputError, match=r"^cannot write .*/file/new: File exists; make room or name another$"):
        write_atomically(tmp_path / "file" / "new", "")
    with pytest.raises(OutputError, match=r"^cannot write .*: Is a directory; make room or name another$"):
        write_atomically(tmp_path, "")
    with (
        pytest.raises(OutputError, match=r"^cannot write .*/new: No such file .*; make"),
        draft(tmp_path / "new") as place,
    ):
        (place / "no folder").touch()
    with pytest.raises(OutputError, match=r"^cannot write .*/new: no reason; make room"), draft(tmp_path / "new"):
        raise OSError("no reason")  # as libraries do, without a number
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_free_is_what_is_new_or_empty(tmp_path):
    full, empty_file, empty_folder = tmp_path / "full", tmp_path / "file", tmp_path / "folder"
    full.write_text("mine")
    empty_file.touch()
    empty_folder.mkdir()
    for what, empty in (("file", empty_file), ("folder", empty_folder)):
        check_free(empty, what)
        check_free(tmp_path / "deep" / "below" / "new", what)
        for taken in {tmp_path, full, empty_file, empty_folder} - {empty}:
            with pytest.raises(OutputError, match=f"^expected a new or empty {what}, got {taken}; remove it or name"):
                check_free(taken, what)
        with pytest.raises(OutputError, match=f"^cannot write in {full}; name another folder"):
            check_free(full / "new", what)
        with pytest.raises(OutputError, match="File name too long"):
            check_free(tmp_path / ("x" * 300), what)
    assert len(list(tmp_path.rglob("*"))) == 3


def test_a_folder_that_cannot_be_replaced_is_not_free(tmp_path, monkeypatch):
    (tmp_path / "inside").mkdir()
    monkeypatch.chdir(tmp_path / "inside")
    for taken in (tmp_path / "inside", "/", "/proc"):  # where we are; mount points
        with pytest.raises(OutputError, match="expected a new or empty folder"):
            check_free(type(tmp_path)(taken), "folder")


def test_hashes(tmp_path):
    path = write_atomically(tmp_path / "file", "content")
    assert file_sha256(path) == hashlib.sha256(b"content").hexdigest()
    assert recorded_hash(path) == file_sha256(path)[:12]


def test_many_writers_of_one_file(tmp_path):
    program = (
        "import sys; from pathlib import Path; from slamgym.files import write_atomically\n"
        "for _ in range(100): write_atomically(Path(sys.argv[1]), sys.argv[2] * 100_000)"
    )
    path = tmp_path / "file"
    writers = [subprocess.Popen([sys.executable, "-c", program, str(path), letter]) for letter in "ab"]
    seen = set()
    while any(writer.poll() is None for writer in writers):
        if path.exists():
            seen.add(path.read_text())
    assert seen <= {"a" * 100_000, "b" * 100_000}
    assert [writer.returncode for writer in writers] == [0, 0]
    assert list(tmp_path.iterdir()) == [path]
