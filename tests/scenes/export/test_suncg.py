import json
from dataclasses import replace

import numpy as np
import pytest

from slamgym.errors import OutputError, SceneError
from slamgym.scenes.export import write_suncg
from slamgym.scenes.house import House
from slamgym.scenes.registry import load_scene
from slamgym.scenes.suncg import SuncgOptions
from slamgym.scenes.suncg.reader import read_suncg


@pytest.fixture
def written(house, tmp_path):
    return write_suncg(house, tmp_path / "root")


def nodes(path):
    return json.loads(path.read_text())["levels"][0]["nodes"]


def test_the_layout(written, tmp_path):
    root = tmp_path / "root"
    assert written == root / "house" / "two_rooms" / "house.json"
    assert sorted(path.name for path in (root / "room" / "two_rooms").glob("*.obj")) == [
        "bathf.obj",
        "bathw.obj",
        "living_roomc.obj",
        "living_roomf.obj",
        "living_roomw.obj",
    ]
    assert sorted(path.name for path in (root / "object").iterdir()) == ["floor_lamp_1", "table_1", "wall_shelf_1"]
    assert [path.name for path in (root / "texture").iterdir()] == ["texture_0.png"]


def test_the_nodes(written):
    living_room = next(node for node in nodes(written) if node["modelId"] == "living_room")
    # y up: the world's y = 3 is z = -3.
    assert living_room["bbox"] == {"min": [0, 0, -3], "max": [4, 2.5, 0]}
    assert living_room["roomTypes"] == ["living_room"]
    assert {nodes(written)[i]["modelId"] for i in living_room["nodeIndices"]} == {"table_1", "wall_shelf_1"}
    bath = next(node for node in nodes(written) if node["modelId"] == "bath")
    assert [bath[f"hide{what}"] for what in ("Floor", "Walls", "Ceiling")] == [0, 0, 1]
    table = next(node for node in nodes(written) if node["modelId"] == "table_1")
    assert table["transform"][12:] == pytest.approx([1.5, 0.6, -1.5, 1])


def test_read_back_it_is_the_same_house(house, written, matched, seen):
    again = read_suncg(written, SuncgOptions())
    assert again.defects == ()
    ours, theirs = matched(house, again)
    for (a, face_a), (b, face_b) in zip(ours, theirs, strict=True):
        expected = seen(house, a, face_a)
        if house.parts[a].colour is not None:
            expected = expected * house.parts[a].colour.mean(axis=0)
        assert seen(again, b, face_b) == pytest.approx(expected, abs=1.0)
    assert [(room.name, room.kind) for room in again.rooms] == [("living_room", "living_room"), ("bath", "bathroom")]
    assert np.array([[r.x_min, r.y_min, r.x_max, r.y_max] for r in again.rooms]) == pytest.approx(
        np.array([[0, 0, 4, 3], [4, 0, 7, 3]])
    )
    pieces = {part.name.split("#")[0] for part in again.parts}
    assert pieces == {"floor", "wall", "ceiling", "wall_shelf_1", "table_1", "floor_lamp_1"}


def test_written_again_it_has_the_same_rooms(written, tmp_path):
    again = write_suncg(read_suncg(written, SuncgOptions()), tmp_path / "again")
    shape = [(node["type"], node.get("hideCeiling")) for node in nodes(written)]
    assert [(node["type"], node.get("hideCeiling")) for node in nodes(again)] == shape


@pytest.mark.parametrize(
    ("name", "is_shell"),
    [
        *((name, True) for name in ("wall", "Wall_3", "WALL.001", "wall 2", "wall-2", "wall_1_1", "wall#0_2", "wall2")),
        *(
            (name, False)
            for name in ("wall_shelf_2", "wall-clock", "wall clock 2", "wallpaper_1", "wall2_rug", "walls")
        ),
    ],
)
def test_only_a_number_may_follow_in_the_name_of_a_shell(house, tmp_path, name, is_shell):
    part = replace(house.parts[3], name=f"{name}/inner")
    path = write_suncg(replace(house, parts=(*house.parts[:2], part)), tmp_path / "root")
    assert [node["hideWalls"] for node in nodes(path) if node["type"] == "Room"] == [int(not is_shell), 1]
    assert any(node["type"] == "Object" for node in nodes(path)) is not is_shell


def test_a_procedural_house_round_trip(tmp_path, matched):
    house = load_scene("procedural:0")
    again = read_suncg(write_suncg(house, tmp_path / "root"), SuncgOptions())
    matched(house, again)
    assert again.defects == ()
    assert [(r.kind, r.x_min, r.y_max) for r in again.rooms] == [
        (r.kind, pytest.approx(r.x_min), pytest.approx(r.y_max)) for r in house.rooms
    ]
    textures = [{id(p.material.texture) for p in h.parts if p.material.texture is not None} for h in (house, again)]
    assert len(textures[0]) >= len(textures[1]) > 10


def test_names_that_files_cannot_have(house, tmp_path):
    part = house.parts[5]
    named = [type(part)(name, part.material, part.vertices, part.faces) for name in ("../a b/x", "..\\A_B/y", "é/z")]
    path = write_suncg(House("..", (*house.parts[:2], *named), house.rooms), tmp_path / "root")
    assert path.is_relative_to(tmp_path / "root")
    models = [path.name for path in (tmp_path / "root" / "object").iterdir()]
    assert len({model.lower() for model in models}) == len(models)
    assert len(read_suncg(path, SuncgOptions()).parts) == 5


def test_nothing_is_overwritten(house, tmp_path):
    (tmp_path / "root").mkdir()
    (tmp_path / "root" / "notes.txt").write_text("mine")
    with pytest.raises(OutputError, match="expected a new or empty folder"):
        write_suncg(house, tmp_path / "root")
    assert [path.name for path in tmp_path.rglob("*")] == ["root", "notes.txt"]


def test_a_house_without_faces(tmp_path):
    with pytest.raises(SceneError, match="house 'empty': expected faces to write, got none"):
        write_suncg(House("empty", ()), tmp_path / "root")
    assert not list(tmp_path.iterdir())
