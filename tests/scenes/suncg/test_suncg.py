import numpy as np
import pytest

from slamgym.scenes.registry import load_scene
from slamgym.scenes.suncg import Suncg
from slamgym.scenes.suncg.reader import read_suncg

NODE = {"id": "0_2", "type": "Object", "valid": 1, "modelId": "wedge"}
CATEGORIES = "index,model_id,fine_grained_class,coarse_grained_class\n1,wedge,{},thing\n"


def read(path, **options):
    return read_suncg(path, Suncg.Options.checked(options))


def group(house, name):
    return [part for part in house.parts if part.name.startswith(f"{name}/")]


def corners(parts):
    """The places of vertices, without repetition, in order."""
    return np.unique(np.concatenate([part.vertices for part in parts]).round(4) + 0.0, axis=0).tolist()


def volume(parts):
    """Enclosed volume, positive when faces are counter-clockwise seen from outside (divergence theorem)."""
    triangles = np.concatenate([part.vertices[part.faces] for part in parts]).astype(np.float64)
    return np.einsum("fi,fi->", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])) / 6.0


def normal(part):
    a, b, c = part.vertices[part.faces[0]].astype(np.float64)
    across = np.cross(b - a, c - a)
    return (across / np.linalg.norm(across)).round(6) + 0.0


@pytest.fixture
def house(dataset):
    return read(dataset())


def test_corners_of_a_mirrored_turned_and_scaled_object(house):
    # (x, y, z) -> (2 z + 5, 2 y + 1, 2 x + 7), then (x, y, z) -> (x, -z, y - 0.1), as the room's floor is at 0.1.
    assert corners(group(house, "wedge#0_2")) == pytest.approx(
        np.array([[5, -9, 0.9], [5, -7, 0.9], [5, -7, 4.9], [11, -7, 0.9]]), abs=1e-4
    )
    # 1 * 2 * 3 / 6 * 2^3; the mirrored faces look outwards still.
    assert volume(group(house, "wedge#0_2")) == pytest.approx(8.0, abs=1e-4)


def test_room_without_its_ceiling(house):
    assert corners(group(house, "floor#0_1")) == [[0, -3, 0], [0, 0, 0], [4, -3, 0], [4, 0, 0]]
    assert normal(group(house, "floor#0_1")[0]).tolist() == [0, 0, 1]
    wall = group(house, "wall#0_1")
    assert corners(wall) == pytest.approx(np.array([[0, 0, 0], [0, 0, 2.4], [4, 0, 0], [4, 0, 2.4]]), abs=1e-4)
    assert normal(wall[0]).tolist() == [0, -1, 0]
    assert wall[0].material.colour == pytest.approx((0.5, 0.6, 0.7), abs=0.003)
    assert not group(house, "ceiling#0_1")


def test_ground_lies_where_the_file_has_it(house):
    assert corners(group(house, "ground#0_0")) == pytest.approx(
        np.array([[0, -3, -0.1], [0, 0, -0.1], [4, -3, -0.1], [4, 0, -0.1]]), abs=1e-4
    )


def test_box(house):
    box = group(house, "box#0_3")
    assert corners(box) == [[x, y, z] for x in (1.5, 2.5) for y in (0, 4) for z in (0, 2)]
    assert volume(box) == pytest.approx(8.0)
    colours = {tuple(normal(part)): round(part.material.colour[0] * 255) for part in box}
    # Materials in the order top, bottom, -x, +x, front, back; the front of the file is -y here.
    assert colours == {
        (0, 0, 1): 0x10,
        (0, 0, -1): 0x20,
        (-1, 0, 0): 0x30,
        (1, 0, 0): 0x40,
        (0, -1, 0): 0x50,
        (0, 1, 0): 0x60,
    }


def test_rooms_and_what_was_assumed(house):
    (room,) = house.rooms
    assert (room.name, room.kind) == ("fr_0rm_1", "living_room, kitchen")
    assert (room.x_min, room.y_min, room.x_max, room.y_max) == pytest.approx((0, -3, 4, 0))
    assert house.defects == ()
    assert "up: (0, 1, 0), unit: 1 m, as the file has them" in house.assumptions
    assert "floor: at 0.1 m, of the rooms" in house.assumptions


def test_part_of_a_model_without_overrides(house):
    textured, green = sorted(group(house, "wedge#0_2"), key=lambda part: part.material.texture is None)
    assert textured.material.texture.tolist() == [[[10, 20, 30], [40, 50, 60]], [[70, 80, 90], [100, 110, 120]]]
    assert textured.uv.tolist() == [[0.25, 0.25]] * len(textured.uv)
    assert green.material.colour == pytest.approx((0, 0.5, 0), abs=0.003)
    assert green.material.texture is None


def test_materials_of_a_node_replace_those_of_its_model(dataset):
    again = NODE | {"id": "0_3", "materials": [{"name": "x", "diffuse": "#80ff00"}, {"texture": "red"}]}
    house = read(dataset([NODE, again]))
    first, second = group(house, "wedge#0_3")
    tiled, red = sorted((first, second), key=lambda part: part.material.texture.mean())
    if tiled.material.texture[0, 0, 0] > 200:
        tiled, red = red, tiled
    assert tiled.material.colour == pytest.approx((0x80 / 255, 1, 0), abs=0.003)  # and the model's texture
    assert red.material.texture[0, 0] == pytest.approx([254, 0, 0], abs=3)  # a .jpg
    assert red.uv is not None  # the model has no texture there, but coordinates for one
    assert {part.material.colour for part in group(house, "wedge#0_2")} != {tiled.material.colour}


def test_equal_textures_are_one_array(dataset):
    house = read(dataset([NODE, NODE | {"id": "0_3", "materials": [{"diffuse": "#ffffff"}]}]))
    textures = [part.material.texture for part in house.parts if part.material.texture is not None]
    assert len(textures) == 2
    assert textures[0] is textures[1]


def test_other_unit_and_directions(dataset):
    metres = read(dataset())
    small = read(dataset(folder="b", scaleToMeters=0.01))
    assert small.parts[0].vertices * 100 == pytest.approx(metres.parts[0].vertices, abs=1e-4)
    # z up and -y to the front, as in the world: nothing turns.
    turned = read(dataset([NODE], folder="c", up=[0, 0, 2], front=[0, -1, 0]))
    assert corners(turned.parts) == [[0, 0, 0], [0, 0, 3], [0, 2, 0], [1, 0, 0]]


def test_a_level_stands_on_its_own_floor(dataset):
    upstairs = [{"id": "1_0", "type": "Box", "dimensions": [2, 2, 2], "transform": lifted(10)}]
    levels = [{"id": "0", "nodes": [NODE]}, {"id": "1", "nodes": upstairs}, {"id": "2", "valid": 0, "nodes": upstairs}]
    house = read(dataset(levels=levels), level=1)
    assert corners(house.parts) == [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 2)]
    assert "level: 1 of 0, 1, by the scene option level" in house.assumptions


def lifted(height):
    return [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, height, 0, 1]


@pytest.mark.parametrize(("state", "kept"), [(0, "wedge"), (1, "wedge_0")])
def test_state_chooses_the_form_of_a_model(dataset, state, kept):
    path = dataset([NODE | {"state": state}])
    folder = path.parents[2] / "object" / "wedge"
    (folder / "wedge.obj").rename(folder / f"{kept}.obj")
    assert len(read(path).parts) == 2


def test_doors_and_lamps_by_the_table_of_categories(dataset):
    box = {"id": "0_9", "type": "Box"}
    path = dataset([NODE, box])
    assert any(line.startswith("lamps and doors: not known") for line in read(path).assumptions)
    table = path.parents[2] / "metadata" / "ModelCategoryMapping.csv"
    table.parent.mkdir()
    table.write_text(CATEGORIES.format("door"))
    assert not group(house := read(path), "wedge#0_2")
    assert any(line.startswith("doors: 1 left out") for line in house.assumptions)
    assert group(read(path, doors="kept"), "wedge#0_2")
    table.write_text(CATEGORIES.format("table_lamp"))
    (lamp,) = read(path).lamps
    # The wedge is 1 x 3 x 2 m here, on the box's bottom level: its bulb is at three quarters of its height.
    assert lamp.position == pytest.approx((0.5, -1.5, 0.5 + 0.75 * 2))
    table.write_text("nothing,here\n1,2\n")
    assert any("expected the columns model_id and fine_grained_class" in line for line in read(path).defects)


def test_the_registry_loads_it_in_a_process_of_its_own(dataset):
    path = dataset()
    house = load_scene(str(path))
    assert house.name == str(path)
    assert corners(house.parts) == corners(read(path).parts)
