import pytest

from slamgym.errors import SceneError
from slamgym.scenes.importing.obj_text import (
    LIBRARIES,
    MAX_LINE,
    as_utf8,
    prepared,
    with_absolute_indices,
    without_options,
)


def test_negative_indices_count_back_from_the_face():
    text = b"v 0 0 0\nv 1 0 0\nvt 0 0\nv 1 1 0\nf -3/-1 -2/1 -1/-1\nv 5 -1 0\nf -1 1 2\nf 1//-1 2 3"
    expected = b"v 0 0 0\nv 1 0 0\nvt 0 0\nv 1 1 0\nf 1/1 2/1 3/1\nv 5 -1 0\nf 4 1 2\nf 1//0 2 3"
    assert with_absolute_indices(text) == expected


def test_other_files_stay_as_they_are():
    text = b"v -1 -1 0\nv 0 0 -1e-3\nf 1 2 3\n"
    assert with_absolute_indices(text) is text


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("oak wood.png", "oak wood.png"),
        ("-s 2 2 1 -o 0.5 -1e-3 0 oak wood.png", "oak wood.png"),
        ("-clamp on textures/2.png", "textures/2.png"),
        ("-bm .png", ".png"),
        ("-s 1 1 1", ""),
    ],
)
def test_options_before_a_name(name, file):
    assert without_options(name) == file


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "latin-1"])
def test_text_in_any_encoding_becomes_utf8(encoding):
    assert as_utf8("usemtl h\u00f6lzern".encode(encoding)).decode() == "usemtl h\u00f6lzern"


def test_what_windows_adds_to_latin_1():
    assert as_utf8(b"\x80 \x93oak\x94").decode() == "\u20ac \u201coak\u201d"
    assert as_utf8(b"\x81\xe4").decode() == "\x81\u00e4"  # 0x81 is no letter there


def test_a_binary_file_is_no_text():
    with pytest.raises(SceneError, match=r"expected text, got a binary file; is it really an .obj\?"):
        as_utf8(b"v 0 0 0\0")


def test_all_lists_of_materials_are_found():
    text = b"# mtllib old.mtl\r\nmtllib a.mtl\r\nv 0 0 0\n mtllib my room.mtl c.MTL d.mtl \nmtllib a.mtl\n"
    data, names = prepared(text)
    assert names == ["a.mtl", "my room.mtl", "c.MTL", "d.mtl"]
    assert data.startswith(f"mtllib {LIBRARIES}\n".encode())
    assert data.endswith(b"mtllib a.mtl\n")
    assert prepared(b"v 0 0 0")[1] == []


def test_lines_are_bounded():
    assert prepared(b"#" * MAX_LINE + b"\n#" * 3)[1] == []
    for long in (b"v 0 0 0\n" + b"#" * (MAX_LINE + 1), b"#" * (MAX_LINE + 1) + b"\n", b"f 1\\\n" * MAX_LINE):
        with pytest.raises(SceneError, match="lines of at most 1000000 bytes"):
            prepared(long)
