import struct
import zlib

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from slamgym.errors import OutputError, SceneError
from slamgym.scenes.map_server import read_map, write_map
from slamgym.scenes.occupancy import OccupancyGrid

DESCRIPTION = {"image": "m.pgm", "resolution": 0.1, "origin": [-1.0, 2.5, 0.0]}
PIXELS = np.array([[254, 0, 205], [254, 254, 0]], np.uint8)
FREE = np.array([[True, True, False], [True, False, False]])  # lowest y first
PGM = b"P5\n3 2\n255\n" + PIXELS.tobytes()


def make(folder, image=PGM, name="m.pgm", text=None, **changes):
    (folder / name).write_bytes(image)
    description = {**DESCRIPTION, "image": name, **changes}
    (folder / "m.yaml").write_text(yaml.safe_dump(description) if text is None else text)
    return folder / "m.yaml"


def test_the_files_are_those_of_map_server(tmp_path):
    grid = OccupancyGrid(~FREE, np.array([-1.0, 2.5]), 0.1)
    assert write_map(grid, tmp_path / "new" / "home.yaml") == tmp_path / "new" / "home.yaml"
    # Row 0 of the image is the one of the largest y.
    assert (tmp_path / "new" / "home.pgm").read_bytes() == b"P5\n3 2\n255\n" + bytes([254, 0, 0, 254, 254, 0])
    assert (tmp_path / "new" / "home.yaml").read_text() == (
        "image: home.pgm\nmode: trinary\nresolution: 0.1\norigin: [-1.0, 2.5, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["home.pgm", "home.yaml"]


@settings(max_examples=40, deadline=None)
@given(
    arrays(bool, st.tuples(st.integers(1, 30), st.integers(1, 30))),
    st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)),
    st.floats(1e-3, 1.0),
)
def test_what_is_written_is_read_to_the_last_bit(tmp_path_factory, occupied, origin, resolution_m):
    path = tmp_path_factory.mktemp("map") / "m.yaml"
    write_map(OccupancyGrid(occupied, np.array(origin), resolution_m), path)
    grid = read_map(path)
    assert np.array_equal(grid.occupied, occupied)
    assert np.array_equal(grid.origin_xy, origin)
    assert grid.resolution_m == resolution_m


def png(pixels):
    return cv2.imencode(".png", pixels)[1].tobytes()


TEXT = b"P2 # a comment\n# another\n3 2 # more\n255\n254 0 205\n254 254\n0\n"
SCALED = b"P5 3 2 100\n" + (PIXELS // 2.55).astype(np.uint8).tobytes()
WIDE = b"P5 3 2 65535\n" + (PIXELS.astype(">u2") * 257).tobytes()
COLOURED = np.stack([PIXELS] * 3, axis=-1)
BRIGHT = np.where(COLOURED == 205, np.uint8(254), COLOURED)
IMAGES = {
    "P5": PGM, "P2": TEXT, "P5 to 100": SCALED, "P5 of 16 bits": WIDE, "png": png(PIXELS), "coloured": png(COLOURED),
    "png of 16 bits": png(PIXELS.astype(np.uint16) * 257),
    "transparent where unknown": png(np.dstack([BRIGHT, (PIXELS != 205) * np.uint8(255)])),
}  # fmt: skip


@pytest.mark.parametrize("image", IMAGES.values(), ids=IMAGES)
def test_images_that_others_wrote(tmp_path, image):
    grid = read_map(make(tmp_path, image))
    assert np.array_equal(grid.occupied, ~FREE)
    assert np.array_equal(grid.origin_xy, (-1.0, 2.5))
    assert grid.resolution_m == 0.1
    assert np.array_equal(grid.cell_of((-0.85, 2.55)), (0, 1))


def test_keys_that_others_wrote(tmp_path):
    negated = b"P5 3 2 255\n" + (255 - PIXELS).tobytes()
    grid = read_map(make(tmp_path, negated, negate=1, mode="scale", cost_translation_table="x"))
    assert np.array_equal(grid.occupied, ~FREE)
    # p = 50/255 = 0.196 of a pixel of 205: free when that is asked for.
    assert read_map(make(tmp_path, free_thresh=0.25)).occupied.sum() == 2


BAD_YAML = {
    "no map": "- 1\n- 2\n", "no yaml": "image: [\n", "control": "image: \x01", "empty": "", "keys": "1: 2",
    "references": "a: &a [1, 2]\nimage: *a\nresolution: 0.1\norigin: [0, 0, 0]\n", "long": "#" * 20_000,
    "nested": "image: " + "[" * 1500, "date": "image: 2001-99-99", "binary": "image: !!binary x",
    "object": "image: !!python/object/apply:os.system [ls]",
}  # fmt: skip


@pytest.mark.parametrize("text", BAD_YAML.values(), ids=BAD_YAML)
def test_bad_yaml(tmp_path, text):
    refuse(make(tmp_path, text=text), "YAML|image: the value should be a valid string|Field required")


@pytest.mark.parametrize("bracket", "[{")
def test_nested_yaml_is_not_parsed(tmp_path, bracket, monkeypatch):
    monkeypatch.setattr(yaml, "scan", None)
    refuse(make(tmp_path, text="image: " + bracket * 2000), "at most 20 opening brackets, got 2000")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"resolution": 0}, "resolution: .*0.001, got 0"),
        ({"resolution": 1e-300}, "resolution: .*0.001, got 1e-300"),
        ({"resolution": 11}, "resolution: .*10, got 11"),
        ({"resolution": float("nan")}, "resolution: .*finite"),
        ({"origin": [0, 0, 0.1]}, "not turned, yaw 0, got yaw 0.1"),
        ({"origin": [0, 0]}, "origin"),
        ({"origin": [0, float("inf"), 0]}, "origin"),
        ({"origin": [0, -1e308, 0]}, r"origin: expected metres, up to 1000000, got 0.0, -1e\+308"),
        ({"free_thresh": 0.7}, "free_thresh: expected at most occupied_thresh, 0.65, got 0.7"),
        ({"mode": "raw"}, "unknown mode 'raw'"),
        ({"free_thresh": 2}, "free_thresh"),
        ({"image": "../m.pgm"}, "leaves it"),
        ({"image": "/etc/passwd"}, "leaves it"),
        ({"image": "http://x.org/m.pgm"}, "nothing is fetched"),
        ({"image": "none.pgm"}, "none.pgm"),
        ({"image": "."}, "Is a directory"),
    ],
)
def test_bad_descriptions(tmp_path, changes, words):
    folder = tmp_path / "inner"
    folder.mkdir()
    (tmp_path / "m.pgm").write_bytes(PGM)
    refuse(make(folder, **changes) if "image" not in changes else described(folder, changes), words)


def described(folder, changes):
    path = make(folder)
    path.write_text(yaml.safe_dump({**DESCRIPTION, **changes}))
    return path


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def png_of(width, height, *chunks):
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"".join([b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", header), *chunks])


ROWS = b"".join(b"\0" + row.tobytes() for row in PIXELS)
DATA, END = chunk(b"IDAT", zlib.compress(ROWS)), chunk(b"IEND", b"")


@pytest.mark.parametrize("chunks", [(DATA, END), (chunk(b"IDAT", zlib.compress(ROWS * 50)), END), (DATA, END, b"more")])
def test_more_data_than_an_image_needs_is_passed_over_in_silence(tmp_path, chunks, capfd):
    assert np.array_equal(read_map(make(tmp_path, png_of(3, 2, *chunks))).occupied, ~FREE)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (b"", "PGM"),
        (b"GIF89a", "PGM"),
        (PGM[:-1], "3 x 2 values up to 255, got fewer"),
        (b"P5 3 2 100\n" + PIXELS.tobytes(), "up to 100"),
        (b"P5 3 2 0\n" + bytes(6), "up to 0"),
        (b"P2 3 2 255 1 2 3", "got fewer"),
        (b"P2 3 2 255 1 2 3 4 x 6", "got fewer, or others"),
        (b"P2 3 2 255 1 2 3 4 -5 6", "got fewer, or others"),
        (b"P2 3 2 255 1 2 3 4 99999999999999999999 6", "got fewer, or others"),
        (b"P5 0 2 255\n", "1 to 25000000 pixels, got 0 x 2"),
        (b"P5 999999999 999999999 255\n", "got 999999999 x 999999999"),
        (png_of(1_000_000, 1_000_000), "got 1000000 x 1000000"),
        (png_of(3, 2), "cut off or damaged"),
        (png(PIXELS)[:-20], "cut off or damaged"),
        (png_of(3, 2, DATA), "cut off or damaged"),
        (png_of(3, 2, chunk(b"IDAT", zlib.compress(ROWS[:5])), END), "cut off or damaged"),
        (png_of(3, 2, png_of(9000, 11000)[8:], DATA, END), "damaged .two sizes, .3, 2. and .9000, 11000."),
        (png_of(3, 2, png_of(90000, 90000)[8:], DATA, END), "cut off or damaged"),
    ],
)
def test_bad_images(tmp_path, image, words, capfd):
    refuse(make(tmp_path, image), words)
    assert capfd.readouterr() == ("", "")


def refuse(path, words):
    with pytest.raises(SceneError, match=words) as caught:
        read_map(path)
    assert str(caught.value).startswith(f"map {path}: ")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 500


def test_a_map_that_is_not_there(tmp_path):
    refuse(tmp_path / "none.yaml", "none.yaml")
    refuse(tmp_path, "Is a directory")


def test_writing_needs_a_name_of_its_own(tmp_path):
    with pytest.raises(OutputError, match=r"end in \.yaml"):
        write_map(OccupancyGrid(~FREE, np.zeros(2), 0.1), tmp_path / "home.pgm")


@pytest.mark.parametrize(("xy", "resolution_m"), [((0.0, 0.0), 20.0), ((0.0, 1e9), 0.1), ((np.nan, 0.0), 0.1)])
def test_what_could_not_be_read_is_not_written(tmp_path, xy, resolution_m):
    with pytest.raises(OutputError, match="cannot write map"):
        write_map(OccupancyGrid(~FREE, np.array(xy), resolution_m), tmp_path / "home.yaml")
    assert list(tmp_path.iterdir()) == []


def test_damaged_files_are_read_or_refused(tmp_path):
    rng = np.random.default_rng(0)
    refused = 0
    for turn in range(150):
        path = make(tmp_path, list(IMAGES.values())[turn % len(IMAGES)])
        target = path if rng.random() < 0.5 else tmp_path / "m.pgm"
        content = bytearray(target.read_bytes())
        for _ in range(rng.integers(1, 6)):
            content[rng.integers(len(content))] = rng.integers(256)
        target.write_bytes(content[: rng.integers(1, 2 * len(content))])
        try:
            assert read_map(path).occupied.ndim == 2
        except SceneError as error:
            assert "\n" not in str(error)  # noqa: PT017
            refused += 1
    assert 50 < refused < 150
