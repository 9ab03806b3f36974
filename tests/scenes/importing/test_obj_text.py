import pytest

from slamgym.scenes.importing.obj_text import with_absolute_indices, without_options


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
