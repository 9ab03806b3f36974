import json
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from slamgym.errors import OutputError, SceneError
from slamgym.scenes.export import write_glb
from slamgym.scenes.export.glb import srgb_to_linear
from slamgym.scenes.extras import Extras, read_extras
from slamgym.scenes.house import House
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
    assert srgb_to_linear([0.0, 0.04, 0.5, 1.0]) == pytest.approx([0.0, 0.04 / 12.92, 0.21404, 1.0], abs=1e-5)


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
    assert read_mesh(written, PlacedOptions(up="y")).rooms == ()


@pytest.mark.parametrize(
    "extras",
    [None, {}, {"slamgym": 3}, {"slamgym": {"rooms": [{"name": "x"}]}}, {"slamgym": {"lamps": [{"position": [1, 2]}]}}],
)
def test_other_extras_are_passed_over(extras):
    assert read_extras(extras) is None


def test_extras_that_are_no_numbers():
    bounds = dict.fromkeys(("x_min", "y_min", "x_max", "y_max"), float("nan"))
    assert read_extras({"slamgym": {"rooms": [{"name": "x", "kind": "y"} | bounds]}}) is None


def test_nothing_is_overwritten(house, tmp_path):
    (tmp_path / "house.glb").write_text("mine")
    with pytest.raises(OutputError, match="expected a new or empty file"):
        write_glb(house, tmp_path / "house.glb")
    assert (tmp_path / "house.glb").read_text() == "mine"


def test_a_house_without_faces(tmp_path):
    with pytest.raises(SceneError, match="house 'empty': expected faces to write, got none"):
        write_glb(House("empty", ()), tmp_path / "house.glb")
    assert not list(tmp_path.iterdir())
