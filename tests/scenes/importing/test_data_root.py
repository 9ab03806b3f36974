import os
from pathlib import Path

import pytest

from slamgym.errors import SceneError
from slamgym.scenes.importing.data_root import MAX_FILE_BYTES, DataRoot, read_plain
from slamgym.scenes.importing.obj_text import LIBRARIES
from slamgym.scenes.importing.resolver import RootResolver


@pytest.fixture
def root(tmp_path):
    folder = tmp_path / "root"
    (folder / "textures").mkdir(parents=True)
    (folder / "models").mkdir()
    (folder / "textures" / "oak wood.png").write_bytes(b"oak")
    (tmp_path / "secret").write_bytes(b"secret")
    (folder / "link").symlink_to(tmp_path / "secret")
    (folder / "inner").symlink_to("textures")
    (folder / "loop").symlink_to("loop")
    os.mkfifo(folder / "pipe")
    return DataRoot(folder)


@pytest.mark.parametrize(
    ("name", "base"),
    [
        ("textures/oak wood.png", ""),
        (" textures/oak wood.png ", ""),
        ("textures\\oak wood.png", ""),
        ("../textures/oak wood.png", "models"),
        ("models/../textures/./oak wood.png", ""),
        ("inner/oak wood.png", ""),
        ("oak wood.png", "textures"),
    ],
)
def test_files_inside_are_read(root, name, base):
    assert root.read(name, base) == b"oak"


def test_an_absolute_path_inside_is_read(root):
    assert root.read(str(root.folder / "textures" / "oak wood.png")) == b"oak"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("../secret", "leaves it"),
        ("..\\secret", "leaves it"),
        ("textures/../../secret", "leaves it"),
        ("/etc/passwd", "leaves it"),
        ("link", "leaves it"),
        ("file:///etc/passwd", "nothing is fetched"),
        ("http://localhost/oak.png", "nothing is fetched"),
        ("C:\\oak.png", "is not there"),
        ("loop", "loop"),
        ("pipe", "which is none"),
        ("textures", "a readable file"),
        ("", "a readable file"),
        ("missing.png", "No such file"),
        ("a\0b", "the name of a file"),
        ("x" * 5000, "the name of a file"),
        ("x" * 500, "too long"),
    ],
)
def test_nothing_else_is(root, name, message):
    with pytest.raises(SceneError, match=message) as told:
        root.read(name)
    assert len(str(told.value).splitlines()) == 1


def test_the_base_cannot_lead_out(root):
    with pytest.raises(SceneError, match="leaves it"):
        root.read("secret", "..")


def test_large_files_are_not_read(tmp_path):
    large = tmp_path / "large.bin"
    with large.open("wb") as file:
        file.truncate(MAX_FILE_BYTES + 1)  # sparse: takes no room
    with pytest.raises(SceneError, match=f"at most {MAX_FILE_BYTES} bytes"):
        read_plain(large)


def test_devices_are_not_read():
    with pytest.raises(SceneError, match="which is none"):
        DataRoot(Path("/")).read("/dev/zero")


def test_the_resolver_decodes_names_and_notes_failures(root):
    (root.folder / "textures" / "oak wood.bin").write_bytes(b"bin")
    resolver = RootResolver(root, "models", buffers=["../textures/oak%20wood.bin"])
    assert resolver.get("../textures/oak%20wood.bin") == b"bin"
    with pytest.raises(SceneError):
        resolver.get("../../secret")
    assert len(resolver.failures) == 1
    assert "'../../secret' left out" in resolver.failures[0]
    assert resolver.namespaced("deeper").base == "models/deeper"
    with pytest.raises(SceneError):
        resolver.write("x", b"")


def test_a_path_of_another_machine_is_looked_for_beside_the_file(root):
    resolver = RootResolver(root, "textures", libraries=["C:\\Users\\me\\oak wood.png", "D:/oak.mtl"])
    assert resolver.get(LIBRARIES) == b"oak\n"
    assert resolver.assumptions == [r"'C:\\Users\\me\\oak wood.png' of another machine: 'oak wood.png' is used for it"]
    assert "'D:/oak.mtl', which is not there; put it there" in resolver.failures[0]


def test_all_lists_of_materials_are_read(root):
    (root.folder / "a.mtl").write_bytes("newmtl h\u00f6lzern".encode("latin-1"))
    (root.folder / "b.mtl").write_bytes(b"newmtl b\0")
    resolver = RootResolver(root, libraries=["a.mtl", "b.mtl", "c.mtl"])
    assert resolver.get(LIBRARIES).decode().split("\n") == ["newmtl h\u00f6lzern", "", ""]
    assert ["binary" in resolver.failures[0], "No such file" in resolver.failures[1]] == [True, True]
