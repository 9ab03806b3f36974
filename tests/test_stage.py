import numpy as np
import pytest

from slamgym.errors import ConfigError, SceneError
from slamgym.params import DriveParams
from slamgym.scenes.map_server import write_map
from slamgym.scenes.occupancy import OccupancyGrid
from slamgym.stage import load_stage


def test_the_same_parameters_share_one_stage_and_others_do_not():
    params = DriveParams(scene="procedural:3", lighting="flat", scene_options={"size": "small"})
    stage = load_stage(params)
    assert (
        load_stage(DriveParams(scene="procedural:3", lighting="flat", scene_options={"size": "small"}, speed=1.0))
        is stage
    )
    assert load_stage(DriveParams(scene="procedural:3", lighting="flat")).house.rooms != stage.house.rooms
    assert all(part.light is None or (part.light == 1.0).all() for part in stage.house.parts)


def test_a_given_map_takes_the_place_of_the_computed_grid(tmp_path):
    occupied = np.ones((60, 80), bool)
    occupied[5:-5, 5:-5] = False
    write_map(OccupancyGrid(occupied, np.array([1.0, 2.0]), 0.05), tmp_path / "map.yaml")
    given = DriveParams(lighting="flat", occupancy_map=tmp_path / "map.yaml")
    stage = load_stage(given)
    assert np.array_equal(stage.grid.occupied, occupied)
    assert np.allclose(stage.grid.origin_xy, (1.0, 2.0))
    with pytest.raises(ConfigError, match="which is not there"):
        DriveParams.checked({"occupancy_map": tmp_path / "other.yaml"})


def test_options_and_scene_are_checked_before_anything_is_loaded():
    with pytest.raises(ConfigError, match="did you mean 'clutter'"):
        DriveParams(scene_options={"cluter": 1}).scene_source()
    with pytest.raises(SceneError, match="unknown scene"):
        DriveParams(scene="kitchen").scene_source()
