import json
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from slamgym.errors import OutputError, SceneError
from slamgym.scenes.export import write_glb
from slamgym.scenes.extras import Extras, read_extras
from slamgym.scenes.house import House, Material
from slamgym.scenes.importing.placed_options import PlacedOptions
from slamgym.scenes.mesh import read_mesh


@pytest.fixture
def written(house, tmp_path):
    return write_glb(house, tmp_path / "house.glb")


def tree(path):
    data = path.read_bytes()
    return json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])


def test_the_container(written):
    data = written.read_bytes()
    assert data[:8] == b"glTF\2\0\0\0"
    assert int.from_bytes(data[8:12], "little") == len(data)
    assert len(data) % 4 == 0
    views = tree(written)["bufferViews"]
    assert all(view["byteOffset"] % 4 == 0 for view in views)
    assert views[-1]["byteOffset"] + views[-1]["byteLength"] <= tree(written)["buffers"][0]["byteLength"]


def test_another_reader_sees_y_up_and_the_textures_pixels(written):
    scene = trimesh.load_scene(written)
    assert scene.bounds == pytest.approx(np.array([[0, 0, -3], [7, 2.5, 0]]))
    floor = next(mesh for name, mesh in scene.geometry.items() if name.startswith("floor_1"))
    assert floor.face_normals == pytest.approx(np.array([[0, 1, 0], [0, 1, 0]]))
    # The corner at the origin has the uv of the lower left pixel, u over two tiles and v over three.
    corner = int(np.abs(floor.vertices).sum(axis=1).argmin())
    assert floor.visual.uv[corner] == pytest.approx([0, 0])
    assert np.asarray(floor.visual.material.baseColorTexture)[1, 0].tolist() == [70, 80, 90]


def test_colours_are_linear_in_gltf(written):
    white = next(item for item in tree(written)["materials"] if item["name"] == "paint: white")
    # IEC 61966-2-1: ((0.9 + 0.055) / 1.055)^2.4, and so on.
    assert white["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx([0.78741, 0.69207, 0.03310, 1], abs=1e-4)


def test_what_is_lit_is_marked_as_unlit(written):
    unlit = [item["name"] for item in tree(written)["materials"] if "extensions" in item]
    assert unlit == ["tiles"]  # the table's, whose light is baked
    assert sum(item["name"] == "tiles" for item in tree(written)["materials"]) == 2
    assert tree(written)["extensionsUsed"] == ["KHR_materials_unlit"]
    assert len(tree(written)["images"]) == 1


def test_what_shines_by_itself_does_so_when_read_back(written):
    again = read_mesh(written, PlacedOptions())
    shining = [part for part in again.parts if part.light is not None]
    assert [part.vertices[0, 2] for part in shining] == [pytest.approx(0.7)]  # the table's top
    assert shining[0].material.texture is not None


@pytest.mark.parametrize("colour", [(1.0, 0.95, 0.86), (0.9, 0.5, 0.2), (0.4, 0.4, 0.4), (0.05, 0.0, 0.0)])
def test_a_bulb_keeps_its_colour_and_its_light(house, tmp_path, colour):
    bulb = replace(house.parts[5], material=Material("bulb", colour), light=np.ones((4, 3), np.float32))
    again = read_mesh(write_glb(replace(house, parts=(*house.parts, bulb)), tmp_path / "bulb.glb"), PlacedOptions())
    (copy,) = (part for part in again.parts if part.material.name == "bulb")
    assert copy.material.colour == pytest.approx(colour, abs=0.02)
    assert (copy.light == 1.0).all()


def test_only_what_shines_by_itself_is_emissive(house, tmp_path):
    light = np.ones((4, 3), np.float32)
    path = write_glb(replace(house, parts=(*house.parts, replace(house.parts[5], light=light))), tmp_path / "some.glb")
    emissive = [item for item in tree(path)["materials"] if "emissiveFactor" in item]
    assert [item["name"] for item in emissive] == ["paint: white", "tiles"]
    for item in emissive:
        look = item["pbrMetallicRoughness"]
        assert item["emissiveFactor"] == look["baseColorFactor"][:3]
        assert item.get("emissiveTexture") == look.get("baseColorTexture")
    baked = replace(house, parts=tuple(replace(part, light=light) for part in house.parts))
    path = write_glb(baked, tmp_path / "baked.glb")
    assert not any("emissiveFactor" in item for item in tree(path)["materials"])
    assert all("extensions" in item for item in tree(path)["materials"])


def test_what_is_not_solid_stays_so(house, tmp_path):
    # Of the table only the drawer, and all of the lamp.
    soft = tuple(replace(p, solid=p.name not in ("table_1/drawer", "floor_lamp_1/shade")) for p in house.parts)
    again = read_mesh(write_glb(replace(house, parts=soft), tmp_path / "soft.glb"), PlacedOptions())
    heights = sorted(float(part.vertices[0, 2]) for part in again.parts if not part.solid)
    assert heights == pytest.approx([0.6, 1.6])
    assert len(again.parts) == len(house.parts)


def test_baked_light_is_light_again(house, tmp_path):
    lit = tuple(replace(part, light=np.full((len(part.vertices), 3), 0.5, np.float32)) for part in house.parts)
    again = read_mesh(write_glb(replace(house, parts=lit), tmp_path / "lit.glb"), PlacedOptions())
    assert all(part.colour is None for part in again.parts)
    floor = next(part for part in again.parts if part.name.startswith("floor_1"))
    assert floor.light == pytest.approx(0.5, abs=0.02)


def test_read_back_it_is_the_same_house(house, written, matched, seen):
    again = read_mesh(written, PlacedOptions())
    assert again.defects == ()
    ours, theirs = matched(house, again)
    for (a, face_a), (b, face_b) in zip(ours, theirs, strict=True):
        part, copy = house.parts[a], again.parts[b]
        assert seen(again, b, face_b) == pytest.approx(seen(house, a, face_a), abs=2.0)
        factor = (
            np.ones((4, 3)) * (1 if part.light is None else part.light) * (1 if part.colour is None else part.colour)
        )
        corners = np.ones((len(copy.vertices), 3)) if copy.colour is None else copy.colour
        expected = np.minimum(factor, 1.0)[part.faces[face_a]].mean(axis=0)
        assert corners[copy.faces[face_b]].mean(axis=0) == pytest.approx(expected, abs=0.02)


def test_rooms_lamps_and_windows_are_in_the_extras(house, written):
    extras = read_extras(trimesh.load_scene(written).metadata)
    assert extras == Extras(house.rooms, house.lamps, house.windows, False)
    again = read_mesh(written, PlacedOptions())
    assert (again.rooms, again.lamps, again.windows) == (house.rooms, house.lamps, house.windows)


def test_options_that_say_how_the_file_lies_change_nothing(house, written):
    for options in (PlacedOptions(up="y"), PlacedOptions(unit="m", floor=0.0)):
        again = read_mesh(written, options)
        assert (again.rooms, again.lamps) == (house.rooms, house.lamps)
        assert not any("not used" in line for line in again.assumptions)
    for options in (PlacedOptions(up="z", floor=0.0), PlacedOptions(unit=2.0), PlacedOptions(up="y", floor=1.0)):
        again = read_mesh(written, options)
        assert (again.rooms, again.lamps, again.windows) == ((), (), ())
        assert again.assumptions[-1].startswith("rooms, lamps and windows of the file: not used, as up, unit or floor")


@pytest.mark.parametrize("extras", [None, {}, 3, {"other": 3}])
def test_other_extras_are_passed_over(extras):
    assert read_extras(extras) is None


ROOM = {"name": "x", "kind": "y", "x_min": 0, "y_min": 0, "x_max": 1, "y_max": 1}
LAMP = {"position": [0, 0, 2]}
WINDOW = {"centre": [0, 0, 1], "half_u": [1, 0, 0], "half_v": [0, 0, 1]}


@pytest.mark.parametrize(
    ("extras", "message"),
    [
        (3, "slamgym: Input should be an object, got '3'"),
        ({"rooms": [{"name": "x"}]}, "rooms.0.kind: Field required"),
        ({"lamps": [{"position": [1, 2]}]}, "lamps.0.position.2: Field required"),
        ({"rooms": [ROOM | {"x_max": float("nan")}]}, "slamgym: expected numbers"),
        ({"rooms": [ROOM | {"x_max": 2e4}]}, "room 'x': expected sides, at most 10000 m from the origin"),
        ({"rooms": [ROOM | {"y_min": 1}]}, "room 'x': expected sides"),
        ({"lamps": [LAMP] * 1001}, "at most 1000 lamps, got 1001"),
        ({"lamps": [{"position": [0, -2e4, 0]}]}, "coordinates from -10000 to 10000"),
        ({"lamps": [LAMP | {"intensity": -1}]}, "intensities from 0 to 1000"),
        ({"lamps": [LAMP | {"radius": 11}]}, "radii from 0 to 10"),
        ({"lamps": [LAMP | {"colour": [0, 0, 11]}]}, "colours from 0 to 10"),
        ({"windows": [WINDOW | {"half_v": [0, 0, 1e5]}]}, "coordinates from -10000"),
        ({"windows": [WINDOW | {"intensity": 1e4}]}, "intensities from 0"),
    ],
)
def test_extras_that_no_house_has(extras, message):
    with pytest.raises(SceneError) as told:
        read_extras({"slamgym": extras})
    assert message in str(told.value)


def test_extras_that_are_not_used_are_told(house, tmp_path):
    dark = replace(house, lamps=(replace(house.lamps[0], intensity=1e9),))
    again = read_mesh(write_glb(dark, tmp_path / "dark.glb"), PlacedOptions())
    assert (again.rooms, again.lamps) == ((), ())
    assert "dark.glb: extras: lamps and windows: expected intensities from 0 to 1000, got others" in again.defects[0]


def test_nothing_is_overwritten(house, tmp_path):
    (tmp_path / "house.glb").write_text("mine")
    with pytest.raises(OutputError, match="expected a new or empty file"):
        write_glb(house, tmp_path / "house.glb")
    assert (tmp_path / "house.glb").read_text() == "mine"


def test_a_house_without_faces(tmp_path):
    with pytest.raises(SceneError, match="house 'empty': expected faces to write, got none"):
        write_glb(House("empty", ()), tmp_path / "house.glb")
    assert not list(tmp_path.iterdir())
