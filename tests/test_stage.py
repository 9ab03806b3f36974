import gymnasium as gym
import numpy as np
import pytest

import slamgym.stage
from slamgym.errors import ConfigError, SceneError
from slamgym.params import DriveParams
from slamgym.robot import ROBOT_RADIUS
from slamgym.scenes.house import House, Material, Part
from slamgym.scenes.loader import SceneOptions
from slamgym.scenes.map_server import write_map
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.scenes.registry import SCENES
from slamgym.stage import load_stage


class Field:
    """A bare square floor; its file holds the side, metres."""

    Options = SceneOptions
    suffixes = (".field",)

    @staticmethod
    def load(source, options):
        side = float(source.read_text())
        corners = np.array([[0, 0, 0], [side, 0, 0], [side, side, 0], [0, side, 0]], np.float32)
        floor = Part("floor", Material("grass"), corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))
        return House(str(source), (floor,))


@pytest.fixture
def field(tmp_path, monkeypatch):
    """A function that writes a field of a side, metres, and gives the parameters of a drive there."""
    monkeypatch.setitem(SCENES, "field", f"{__name__}:Field")
    slamgym.stage._houses.clear()

    def params(side, name="one", **more):
        (tmp_path / f"{name}.field").write_text(f"{side:.3f}")
        return DriveParams(scene=str(tmp_path / f"{name}.field"), **{"lighting": "flat", "path_length_m": 3.0, **more})

    return params


def free_m2(stage):
    return np.count_nonzero(stage.free) * 0.05**2


def square_map(folder, side, origin=(0.0, 0.0)):
    """A map that is free over a square, in a frame of occupied cells."""
    cells = np.ones((round(side / 0.05) + 2,) * 2, bool)
    cells[1:-1, 1:-1] = False
    write_map(OccupancyGrid(cells, np.array(origin) - 0.05, 0.05), folder / "map.yaml")
    return folder / "map.yaml"


def test_the_robots_centre_keeps_its_radius_and_a_little_more_from_the_edge(field):
    inset = ROBOT_RADIUS + 0.05
    assert free_m2(load_stage(field(6.0))) == pytest.approx((6.0 - 2 * inset) ** 2, rel=0.05)


def test_a_house_stays_in_memory_until_two_others_were_used_later(field):
    one, two, three = (field(6.0 + k, str(k)) for k in range(3))
    house = load_stage(one).house
    load_stage(two)
    assert load_stage(one.model_copy(update={"speed": 1.0})).house is house
    load_stage(three)
    assert load_stage(one).house is house
    load_stage(two)
    load_stage(three)
    assert load_stage(one).house is not house


def test_lighting_and_options_make_another_house():
    flat = load_stage(DriveParams(scene="procedural:3", lighting="flat", scene_options={"size": "small"}))
    assert all(part.light is None or (part.light == 1.0).all() for part in flat.house.parts)
    lit = load_stage(DriveParams(scene="procedural:3", scene_options={"size": "small"}))
    assert all(part.light is not None for part in lit.house.parts)
    assert lit.versions == flat.versions
    other = load_stage(DriveParams(scene="procedural:3", lighting="flat"))
    assert other.house.rooms != flat.house.rooms
    assert other.versions != flat.versions


def test_a_drive_after_the_file_changed_is_in_the_new_house(field):
    env = gym.make("HomeRobot-v0", scene=field(6.0).scene, lighting="flat", camera="small")
    env.reset(seed=1)
    before = env.unwrapped.stage.house
    field(12.5)
    for seed in range(1, 4):
        obs, _ = env.reset(seed=seed)
        if obs["depth"].max() > 6.0 * np.sqrt(2):  # further than the old field reaches
            break
    assert obs["depth"].max() > 6.0 * np.sqrt(2)
    assert env.unwrapped.stage.house is not before
    env.close()


def test_a_given_map_takes_the_place_of_the_computed_grid_also_when_only_its_image_changes(field, tmp_path):
    params = field(6.0, occupancy_map=square_map(tmp_path, 4.0))
    first = load_stage(params)
    assert free_m2(first) == pytest.approx(3.5**2, rel=0.05)
    image = tmp_path / "map.pgm"
    data = image.read_bytes()
    image.write_bytes(data[: len(data) // 2] + bytes(len(data) - len(data) // 2))  # its lower half occupied
    second = load_stage(params)
    assert free_m2(second) < 0.6 * free_m2(first)
    assert second.house is first.house
    assert second.versions["house_sha256"] == first.versions["house_sha256"]
    assert second.versions["occupancy_map_sha256"] != first.versions["occupancy_map_sha256"]


def test_a_map_of_another_place_is_refused(field, tmp_path):
    params = field(6.0, occupancy_map=square_map(tmp_path, 4.0, origin=(100.07, 0.0)))
    with pytest.raises(SceneError, match=r"which reaches x -0\.1 to 6\.1.*got one that reaches x 100\.0 .* its origin"):
        load_stage(params)


def test_a_map_may_stand_in_where_the_house_has_no_room_of_its_own(field, tmp_path):
    with pytest.raises(SceneError, match="no room for the robot"):
        load_stage(field(0.6))
    assert free_m2(load_stage(field(0.6, occupancy_map=square_map(tmp_path, 4.0)))) > 10
    with pytest.raises(SceneError, match="no room for the robot"):
        load_stage(field(0.6))


def test_options_and_scene_are_checked_before_anything_is_loaded(tmp_path):
    with pytest.raises(ConfigError, match="did you mean 'clutter'"):
        DriveParams(scene_options={"cluter": 1}).scene_source()
    with pytest.raises(SceneError, match="unknown scene"):
        DriveParams(scene="kitchen").scene_source()
    with pytest.raises(ConfigError, match="which is not there"):
        DriveParams.checked({"occupancy_map": tmp_path / "other.yaml"})
