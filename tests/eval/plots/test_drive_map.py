from dataclasses import dataclass, replace

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

from slamgym.eval.episode import summarize_slam
from slamgym.eval.plots.drive_map import ESTIMATE, OTHER_MAPS, plot_map
from slamgym.eval.plots.style import LOST, TRUTH
from slamgym.eval.trajectories import Trajectory
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


def ink(png, colour):
    """How many pixels of the picture show the colour."""
    pixels = matplotlib.image.imread(png)[..., :3]
    return int((np.abs(pixels - to_rgb(colour)).max(axis=-1) < 0.02).sum())


def has_colour(png, colour):
    return ink(png, colour) > 0


def truth_of(record):
    return Trajectory(record.stamps_ns, record.T_world_cam)


def draw(png, grid, record):
    true_xy = record.T_world_cam[:, :2, 3]
    plot_map(png, grid, true_xy + 0.05, truth_of(record), record, summarize_slam(record))
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
    truth = truth_of(make_record("0" * 40))
    plot_map(tmp_path / "map.png", grid, truth.positions[:, :2], truth, None, {})
    assert not has_colour(tmp_path / "map.png", ESTIMATE)


def test_a_sequence_has_neither_grid_nor_plan(tmp_path, make_record):
    record = make_record("." * 3 + "0" * 30 + "x" * 10 + "1" * 20)
    plot_map(tmp_path / "map.png", None, None, truth_of(record), record, summarize_slam(record))
    assert all(has_colour(tmp_path / "map.png", colour) for colour in (ESTIMATE, LOST, OTHER_MAPS[0], TRUTH))


def test_each_policy_draws_its_maps_solid(tmp_path, make_record):
    record = make_record("0" * 30 + "x" + "1" * 28)
    for policy in ("largest", "each"):
        plot_map(tmp_path / f"{policy}.png", None, None, truth_of(record), record, summarize_slam(record, policy))
    dashed, solid = (ink(tmp_path / f"{policy}.png", OTHER_MAPS[0]) for policy in ("largest", "each"))
    assert solid > 1.2 * dashed


def test_without_a_truth_the_first_evaluated_map_is_drawn_as_it_is(tmp_path, make_record):
    record = make_record("0" * 30 + "x" * 10 + "1" * 20)
    record = replace(record, T_world_cam=np.full_like(record.T_world_cam, np.nan))
    plot_map(tmp_path / "map.png", None, None, None, record, summarize_slam(record, "each"))
    assert has_colour(tmp_path / "map.png", ESTIMATE)
    assert has_colour(tmp_path / "map.png", LOST)
    assert not has_colour(tmp_path / "map.png", OTHER_MAPS[0])
    lost = make_record("....")
    lost = replace(lost, T_world_cam=np.full_like(lost.T_world_cam, np.nan))
    plot_map(tmp_path / "lost.png", None, None, None, lost, summarize_slam(lost))


def test_the_truth_has_gaps_and_ends_with_the_frames(tmp_path, make_record):
    """Motion capture for twice as long as the camera, without the frames from 10 to 29, in three pictures."""
    whole, fed = truth_of(make_record("0" * 80)), make_record("." * 40)
    known = np.r_[0:10, 30:80]
    truths = [whole, Trajectory(whole.stamps_ns[known], whole.T[known]), truth_of(fed)]
    for i, truth in enumerate(truths):
        plot_map(tmp_path / f"{i}.png", None, None, truth, fed, summarize_slam(fed))
    as_long, with_hole, same = (ink(tmp_path / f"{i}.png", TRUTH) for i in range(3))
    assert as_long == same
    assert with_hole < 0.8 * same


def test_no_global_state_of_pyplot_is_used(tmp_path, grid, make_record):
    import matplotlib.pyplot as plt

    draw(tmp_path / "map.png", grid, make_record("0" * 10))
    assert plt.get_fignums() == []
