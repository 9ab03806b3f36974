"""What is wrong with a dataset is told, with file and node; what can be used is used."""

import json

import pytest

from slamgym.errors import ConfigError, SceneError
from slamgym.scenes.suncg import Suncg, reader
from slamgym.scenes.suncg.house_file import MAX_NODES
from slamgym.scenes.suncg.reader import read_suncg

FLOOR = {"id": "0_1", "type": "Room", "modelId": "fr_0rm_1", "bbox": {"min": [0, 0, 0], "max": [4, 2.5, 3]}}
WEDGE = {"id": "0_2", "type": "Object", "modelId": "wedge"}
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def read(path, **options):
    return read_suncg(path, Suncg.Options.checked(options))


def told(house):
    return "\n".join(house.defects)


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ({"type": "Camera"}, "node 0_5: type: Input should be 'Room', 'Object', 'Ground' or 'Box', got 'Camera'"),
        ({}, "node 0_5: type: Field required"),
        (WEDGE | {"transform": IDENTITY[:15]}, "node 0_5: transform: Tuple should have at least 16 items"),
        (WEDGE | {"transform": [*IDENTITY[:15], "x"]}, "node 0_5: transform: Input should be a valid number"),
        (WEDGE | {"transform": [float("nan"), *IDENTITY[1:]]}, "node 0_5: transform: Input should be a finite number"),
        (WEDGE | {"transform": [1, 0, 0, 0.5, *IDENTITY[4:]]}, "The last row should be 0, 0, 0, 1"),
        (WEDGE | {"modelId": "gone"}, "node 0_5: object/gone/gone.obj: expected a file, got none"),
        (WEDGE | {"modelId": "../../../../etc"}, "leaves it"),
        (WEDGE | {"modelId": "a\nb"}, "node 0_5: modelId: String should match pattern"),
        ({"type": "Box", "dimensions": [1, 2]}, "node 0_5: dimensions: Tuple should have at least 3 items"),
        ({"type": "Box", "dimensions": [1, 1, 0.0]}, "faces without area left out, in 'box#0_5/"),
    ],
)
def test_a_bad_node_is_left_out_and_the_house_is_not(dataset, node, message):
    house = read(dataset([FLOOR, WEDGE, node | {"id": "0_5"}]))
    assert {part.name.split("/")[0] for part in house.parts} >= {"floor#0_1", "wall#0_1", "wedge#0_2"}
    assert not any(part.name.startswith("wedge#0_5") for part in house.parts)
    assert message in told(house)
    assert all(line.startswith("house.json: ") and "\n" not in line for line in house.defects)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"materials": "red"},
            "node 0_5: materials: Input should be a valid tuple, got 'red'; its materials is not used",
        ),
        ({"materials": [{"texture": "gone"}]}, "materials[0]: expected a file texture/gone.png or .jpg, got none"),
        ({"materials": [{"texture": "../../secret"}]}, "leaves it"),
        ({"materials": [{"texture": "http://127.0.0.1/red"}]}, "materials[0]: expected a file texture/http:"),
        ({"materials": [{"texture": "red\nmap_Kd x"}]}, "node 0_5: materials: String should match pattern"),
        ({"materials": [{"diffuse": "red"}]}, "materials[0]: expected a colour like #a0522d, got 'red'"),
        ({"isMirrored": 1}, "node 0_5: isMirrored: expected 0, as its transform does not mirror, got 1"),
        ({"bbox": [1, 2]}, "node 0_5: bbox: Input should be"),
    ],
)
def test_a_node_is_used_without_what_is_bad_in_it(dataset, change, message):
    house = read(dataset([FLOOR, WEDGE | {"id": "0_5"} | change]))
    assert len([part for part in house.parts if part.name.startswith("wedge#0_5/")]) == 2
    assert message in told(house)
    assert "0_5" in told(house)


def test_nodes_that_are_no_objects(dataset):
    house = read(dataset([FLOOR, "chair", 7, None]))
    assert len(house.defects) == 3
    assert "house.json: node 1: expected a JSON object, got 'chair'; it is left out" in house.defects


def test_a_room_without_a_box_has_that_of_its_floor(dataset):
    (room,) = read(dataset([FLOOR | {"bbox": None}])).rooms
    assert (room.x_min, room.y_min, room.x_max, room.y_max) == pytest.approx((0, -3, 4, 0))


@pytest.mark.parametrize("corner", [[0, 2.5, 3], [4, 2.5, 2e4]])
def test_a_room_that_no_house_has_is_none(dataset, corner):
    house = read(dataset([FLOOR | {"bbox": {"min": [0, 0, 0], "max": corner}}]))
    assert house.rooms == ()
    assert "node 0_1: bbox: expected sides, at most 10000 m from the origin, got 0 to " in told(house)


def test_missing_files_of_a_room_and_of_a_material(dataset):
    path = dataset([FLOOR, WEDGE])
    root = path.parents[2]
    (root / "room" / "h1" / "fr_0rm_1c.obj").unlink()
    (root / "texture" / "tiles.png").unlink()
    house = read(path)
    assert "node 0_1: room/h1/fr_0rm_1c.obj: expected a file, got none" in told(house)
    assert "node 0_2: object/wedge/wedge.obj: '../../texture/tiles.png' left out" in told(house)
    assert len(house.parts) == 4


def test_broken_files_of_a_model(dataset):
    path = dataset([FLOOR, WEDGE])
    root = path.parents[2]
    (root / "texture" / "tiles.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    assert "wedge.obj: '../../texture/tiles.png' left out" in told(read(path))
    (root / "object" / "wedge" / "wedge.obj").write_bytes(b"f 1 2 3\n")
    assert "node 0_2: object/wedge/wedge.obj: " in told(read(path))


@pytest.mark.parametrize("name", ["../../../secret.png", "/etc/passwd", "file:///etc/passwd", "http://127.0.0.1/x.png"])
def test_mtl_files_name_nothing_outside_the_data_root(dataset, tmp_path, name):
    path = dataset([FLOOR, WEDGE])
    (tmp_path / "secret.png").write_bytes((path.parents[2] / "texture" / "tiles.png").read_bytes())
    (path.parents[2] / "object" / "wedge" / "wedge.mtl").write_text(f"newmtl wood_0\nmap_Kd {name}\nnewmtl wood_1\n")
    house = read(path)
    assert all(part.material.texture is None for part in house.parts)
    assert "node 0_2: object/wedge/wedge.obj: " in told(house)


def test_an_object_300_km_away(dataset):
    far = WEDGE | {"id": "0_5", "transform": [*IDENTITY[:12], 3e5, 0, 0, 1]}
    house = read(dataset([FLOOR, WEDGE, far]))
    assert "far away from all others left out, in 'wedge#0_5/" in told(house)
    assert max(float(abs(part.vertices).max()) for part in house.parts) < 5.0


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"up": [0, 0, 0]}, "up and front at right angles"),
        ({"front": [0, 2, 0]}, "up and front at right angles"),
        ({"up": "y"}, "up: Input should be a valid tuple"),
        ({"scaleToMeters": 0}, "scaleToMeters: Input should be greater than 0, got 0"),
    ],
)
def test_a_bad_frame_falls_back_to_the_usual_one(dataset, entries, message):
    house = read(dataset([FLOOR], **entries))
    assert message in told(house)
    assert "up: (0, 1, 0), unit: 1 m, as the file has them" in house.assumptions or "up and front" in message
    assert max(part.vertices[:, 2].max() for part in house.parts) == pytest.approx(2.4)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "expected JSON"),
        (b'{"levels": [{"nodes": [', "expected JSON"),
        (b"\xff\xfe\x00", "expected JSON"),
        (b"[" * 100_000, "expected JSON"),
        (b"[]", "expected a JSON object, got a list of 0"),
        (b"{}", "expected a list of levels, got None"),
        (b'{"levels": []}', "expected level in a file that has some, got 0"),
        (b'{"levels": [{"nodes": []}]}', "expected level in a file that has some, got 0"),
        (b'{"version": "suncg@2", "levels": []}', "expected version 'suncg@1.0.0', got 'suncg@2'"),
        (b'{"levels": [{"nodes": [{"type": "Object"}]}]}', "expected triangles, got none that can be used"),
    ],
)
def test_files_that_are_no_house(dataset, content, message):
    path = dataset()
    path.write_bytes(content)
    with pytest.raises(SceneError) as caught:
        read(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unknown_levels_and_options(dataset):
    path = dataset(levels=[{"nodes": [WEDGE]}, {"nodes": [WEDGE]}])
    with pytest.raises(SceneError, match="expected level 0, 1, got 2; choose it by the scene option level"):
        read(path, level=2)
    with pytest.raises(ConfigError, match="unknown scene option 'storey'"):
        read(path, storey=1)
    with pytest.raises(ConfigError, match="unknown doors 'shut'"):
        read(path, doors="shut")


def test_a_file_that_is_not_in_a_dataset(dataset, tmp_path):
    elsewhere = tmp_path / "house.json"
    elsewhere.write_bytes(dataset().read_bytes())
    with pytest.raises(SceneError, match="expected ROOT/house/ID"):
        read(elsewhere)


def test_sizes_are_bounded(dataset, monkeypatch):
    with pytest.raises(SceneError, match=f"expected at most {MAX_NODES} nodes, got {MAX_NODES + 1}"):
        read(dataset([WEDGE] * (MAX_NODES + 1)))
    monkeypatch.setattr(reader, "MAX_TRIANGLES", 7)
    with pytest.raises(SceneError, match="expected at most 7 triangles, got more"):
        read(dataset([WEDGE, WEDGE], folder="b"))


def test_what_is_not_finite_in_the_json(dataset):
    path = dataset([FLOOR, WEDGE | {"transform": "HERE"}])
    path.write_text(path.read_text().replace('"HERE"', json.dumps(IDENTITY).replace("[1,", "[1e999,")))
    house = read(path)
    assert "node 0_2: transform: Input should be a finite number, got inf; it is left out" in told(house)
