from dataclasses import dataclass

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from slamgym.eval.episode import summarize_slam
from slamgym.eval.plots.drive_map import ESTIMATE, OTHER_MAPS, plot_map
from slamgym.eval.plots.style import LOST
from slamgym.types import BoolArray, FloatArray, SlamEvent


@dataclass(frozen=True)
class Grid:
    occupied: BoolArray
    origin_xy: FloatArray
    resolution_m: float


@pytest.fixture
def grid():
    occupied = np.zeros((160, 240), dtype=np.bool_)
    occupied[[0, -1]] = occupied[:, [0, -1]] = True
    occupied[100:130, 30:60] = True
    return Grid(occupied, np.array([-4.0, -2.0]), 0.05)


def has_colour(png, colour):
    pixels = matplotlib.image.imread(png)[..., :3]
    return bool((np.abs(pixels - to_rgb(colour)).max(axis=-1) < 0.02).any())


def draw(png, grid, record):
    true_xy = record.T_world_cam[:, :2, 3]
    plot_map(png, grid, true_xy + 0.05, record.T_world_cam, record, summarize_slam(record))
    assert matplotlib.image.imread(png).shape[0] > 300


def test_a_run_with_a_loss_and_two_maps(tmp_path, grid, make_record):
    record = make_record("." * 3 + "0" * 30 + "x" * 10 + "1" * 20, events={43: SlamEvent.NEW_MAP})
    draw(tmp_path / "map.png", grid, record)
    assert has_colour(tmp_path / "map.png", ESTIMATE)
    assert has_colour(tmp_path / "map.png", LOST)
    assert has_colour(tmp_path / "map.png", OTHER_MAPS[0])


def test_a_run_without_a_loss_shows_none(tmp_path, grid, make_record):
    draw(tmp_path / "map.png", grid, make_record("0" * 40))
    assert has_colour(tmp_path / "map.png", ESTIMATE)
    assert not has_colour(tmp_path / "map.png", LOST)


@pytest.mark.parametrize("online", [".", "....", "0", "0x", "00xxx"])
def test_runs_with_hardly_any_pose(tmp_path, grid, make_record, online):
    draw(tmp_path / "map.png", grid, make_record(online))


def test_a_crashed_run_shows_the_emitted_poses(tmp_path, grid, make_record):
    draw(tmp_path / "map.png", grid, make_record("0" * 40, final="." * 40, outcome="crashed"))
    assert has_colour(tmp_path / "map.png", ESTIMATE)


def test_a_drive_without_a_slam(tmp_path, grid, make_record):
    T_world_cam = make_record("0" * 40).T_world_cam
    plot_map(tmp_path / "map.png", grid, T_world_cam[:, :2, 3], T_world_cam, None, {})
    assert not has_colour(tmp_path / "map.png", ESTIMATE)


def test_no_global_state_of_pyplot_is_used(tmp_path, grid, make_record):
    import matplotlib.pyplot as plt

    draw(tmp_path / "map.png", grid, make_record("0" * 10))
    assert plt.get_fignums() == []
